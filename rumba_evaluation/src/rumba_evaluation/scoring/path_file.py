"""Reads paths from text: CSV with a header, or the trajectory format of the TUM RGB-D benchmark.

CSV: the first line names the columns: x and y [m], and, if they are known, t [s] and theta [rad]. Empty lines and lines
that begin with # are left out. TUM: `timestamp tx ty tz qx qy qz qw` in each line, with spaces between the numbers; of
the quaternion the heading counts (J. Sturm et al., A Benchmark for the Evaluation of RGB-D SLAM Systems, IROS 2012).
"""

import os
import re
from typing import Callable, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from rumba_evaluation.scoring.drawn_path import MOST_POSES, DrawnPath, PathError, drawn_path
from rumba_sim.model.common.config import nearest
from rumba_sim.model.common.errors import quoted
from rumba_sim.model.common.geometry import yaw
from rumba_sim.model.common.regular_file import opened
from rumba_sim.model.kernel import Array

MOST_BYTES = 100_000_000
LONGEST_LINE = 1000  # [bytes]
COLUMNS = ('t', 'x', 'y', 'theta')
TUM = 'timestamp tx ty tz qx qy qz qw'
UNIT = (0.9, 1.1)  # length of a quaternion: files have few digits
BAG = b'#ROSBAG V'  # how a bag begins

ReadBag = Callable[[str, str], DrawnPath]  # from the path of a bag, and a topic, which may be empty


class _Row(NamedTuple):
    """One pose, as read."""

    line: int
    t: Optional[float]
    x: float
    y: float
    theta: Optional[float]


def read(path: str, topic: str = '', read_bag: Optional[ReadBag] = None) -> DrawnPath:
    """Read a path from a file of any of the formats.

    Args:
        path: of the file.
        topic: of nav_msgs/Path in a bag; empty: the only one.
        read_bag: reads bags; None where there is no ROS.

    Raises:
        PathError: the file cannot be used; the message names it and the line.
    """
    if _is_bag(path):
        if read_bag is None:
            raise PathError(f'{path}: is a bag, and to read bags needs ROS: run `rosrun rumba_evaluation evaluate`, or '
                            'write the poses as CSV, x,y in the first line')
        return read_bag(path, topic)
    if topic:
        raise PathError(f'{path}: is not a bag: only with one, --topic has a meaning')
    lines = list(_lines(path))
    if not lines:
        raise PathError(f'{path}: is empty: must be CSV (x,y in the first line), TUM ({TUM}) or a bag')
    rows = _csv(path, lines) if ',' in lines[0][1] or path.endswith('.csv') else _tum(path, lines)
    return drawn_path(path, [f'line {row.line}' for row in rows],
                      np.array([(row.x, row.y) for row in rows], np.float64).reshape(-1, 2),
                      _column([row.theta for row in rows]), _column([row.t for row in rows]))


def _is_bag(path: str) -> bool:
    with opened(path, PathError) as file:
        if os.fstat(file.fileno()).st_size > MOST_BYTES and file.read(len(BAG)) != BAG:
            raise PathError(f'{path}: is larger than {MOST_BYTES // 1_000_000} MB: leave poses out')
        file.seek(0)
        return file.read(len(BAG)) == BAG


def _lines(path: str) -> Iterator[Tuple[int, str]]:
    """Numbers and texts of the lines that are neither empty nor comments."""
    with opened(path, PathError) as file:
        found = 0
        number = 0
        while True:
            data = file.readline(LONGEST_LINE + 1)
            if not data:
                return
            number += 1
            if len(data) > LONGEST_LINE:
                raise PathError(f'{path}, line {number}: is longer than {LONGEST_LINE} characters: must be a pose')
            try:
                text = data.decode('utf-8-sig' if number == 1 else 'utf-8').strip()
            except UnicodeDecodeError:
                raise PathError(f'{path}, line {number}: is not text: must be CSV, TUM or a bag') from None
            if text and not text.startswith('#'):
                found += 1
                if found > MOST_POSES + 1:
                    raise PathError(f'{path}, line {number}: has more than {MOST_POSES} poses: leave some out')
                yield number, text


def _column(values: Sequence[Optional[float]]) -> Optional[Array]:
    return None if None in values else np.array(values, np.float64)


# --- CSV ----------------------------------------------------------------------------------------------------------

def _csv(path: str, lines: List[Tuple[int, str]]) -> List[_Row]:
    (first, header), *rest = lines
    names = [name.strip().strip('"') for name in header.split(',')]
    for name in names:
        if name not in COLUMNS:
            hint = ('must name the columns, as in x,y or t,x,y,theta' if _is_number(name)
                    else nearest(name, list(COLUMNS)))
            raise PathError(f'{path}, line {first}: column {quoted(name)} is unknown: {hint}')
        if names.count(name) > 1:
            raise PathError(f'{path}, line {first}: column {name} appears twice')
    for name in ('x', 'y'):
        if name not in names:
            raise PathError(f'{path}, line {first}: column {name} is missing: must be as in x,y or t,x,y,theta')
    rows = []
    for number, text in rest:
        parts = text.split(',')
        if len(parts) != len(names):
            raise PathError(f'{path}, line {number}: has {len(parts)} values: must have {len(names)}, '
                            + ','.join(names))
        values: Dict[str, float] = {name: _number(path, number, name, part) for name, part in zip(names, parts)}
        rows.append(_Row(number, values.get('t'), values['x'], values['y'], values.get('theta')))
    return rows


def _is_number(text: str) -> bool:
    return re.fullmatch(r'[-+0-9.eE]+', text) is not None


def _number(path: str, line: int, name: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise PathError(f'{path}, line {line}: {name} is {quoted(text.strip())}: must be a number') from None
    if not abs(value) < 1e300:  # false for NaN too
        raise PathError(f'{path}, line {line}: {name} is {text.strip()}: must be a finite number')
    return value


# --- TUM ----------------------------------------------------------------------------------------------------------

def _tum(path: str, lines: List[Tuple[int, str]]) -> List[_Row]:
    names = TUM.split()
    rows = []
    for number, text in lines:
        parts = text.split()
        if len(parts) != len(names):
            raise PathError(f'{path}, line {number}: has {len(parts)} value{"s" * (len(parts) != 1)}: must be TUM, '
                            f'{TUM}, or CSV with x,y in the first line')
        t, x, y, _, *quaternion = [_number(path, number, name, part) for name, part in zip(names, parts)]
        length = float(np.linalg.norm(quaternion))
        if not UNIT[0] <= length <= UNIT[1]:
            raise PathError(f'{path}, line {number}: the quaternion has length {length:g}: must have length 1')
        rows.append(_Row(number, t, x, y, yaw(*quaternion)))
    return rows
