"""Reads logs of CARMEN, as of the Radish collection: lines of ODOM, FLASER and ROBOTLASER1.

Montemerlo, Roy, Thrun: CARMEN, Perspectives on Standardization in Mobile Robot Programming (2003); the fields are those
of its logger. A log that gmapping has corrected has the corrected poses in FLASER, and lines of ODOM from pose to pose.
"""

import gzip
import io
import math
from typing import IO, Callable, Iterator, List, Optional

import numpy as np

from rumba_localisation.logs.entry import Entry, LogError
from rumba_localisation.scan import Reading, Scan, scan_of
from rumba_sim.model.common.geometry import Pose, compose, inverse
from rumba_sim.model.kernel import Array
from rumba_sim.model.settings.mounting import Mounting

FULL = math.pi  # [rad] that a FLASER of 180 or 181, or 360 or 361 beams covers
NOTHING = 80.0  # [m] from which on a SICK LMS, of which such logs are, tells that there is no echo
OFFSET = 'robot_frontlaser_offset'


def entries(path: str, is_corrected: bool, reading: Reading, advance: Callable[[int], None]) -> Iterator[Entry]:
    """The scans of a log, one after the other.

    Args:
        path: of the log; gzip may have packed it.
        is_corrected: whether its poses were corrected: they are the reference then, and ODOM is the odometry.
        reading: how ranges are taken.
        advance: called with the bytes of the file that were read since the last call.

    Raises:
        LogError: the file cannot be read, or a line makes no sense.
    """
    try:
        with open(path, 'rb') as file:
            yield from _entries(path, file, is_corrected, reading, advance)
    except (OSError, EOFError, UnicodeDecodeError) as error:
        raise LogError(f'{path}: cannot be read: {getattr(error, "strerror", None) or error}') from error


def _entries(path: str, file: IO[bytes], is_corrected: bool, reading: Reading,
             advance: Callable[[int], None]) -> Iterator[Entry]:
    packed = file.read(2) == b'\x1f\x8b'
    file.seek(0)
    lines = io.TextIOWrapper(gzip.GzipFile(fileobj=file) if packed else file, 'ascii', 'replace')  # type: ignore
    log, read = _Log(is_corrected, reading), 0
    for number, line in enumerate(lines, 1):
        try:
            found = log.take(line.split())
        except (ValueError, IndexError) as error:
            raise LogError(f'{path}, line {number}: {line[:40].strip()!r} ...: {error}') from error
        if found is not None:
            at = file.tell()
            advance(at - read)
            read = at
            yield found


class _Log:
    """What the lines so far tell."""

    def __init__(self, is_corrected: bool, reading: Reading) -> None:
        self._is_corrected, self._reading = is_corrected, reading
        self._offset = 0.0  # [m] of the laser ahead of the centre
        self._begun: Optional[Pose] = None  # first and last ODOM since the last scan
        self._last: Optional[Pose] = None
        self._odometry = Pose(0.0, 0.0, 0.0)

    def take(self, words: List[str]) -> Optional[Entry]:
        """Take a line; returns what it tells of a scan.

        Raises:
            ValueError, IndexError: it makes no sense.
        """
        if words[:1] == ['ODOM']:
            self._last = _pose(words[1:4])
            self._begun = self._begun or self._last
        elif words[:2] == ['PARAM', OFFSET]:
            self._offset = float(words[2])
        elif words[:1] == ['FLASER']:
            return self._scan(words)
        elif words[:1] == ['ROBOTLASER1']:
            return self._robot_laser(words)
        return None

    def _scan(self, words: List[str]) -> Entry:
        """FLASER count ranges x y theta odom_x odom_y odom_theta time host logger_time."""
        count = int(words[1])
        rest = words[2 + count:]
        step = FULL / (count if count % 2 == 0 else count - 1)
        scan = scan_of(_ranges(words[2:2 + count]), -0.5 * FULL, step, NOTHING, 0.0, self._mounting, self._reading)
        return self._entry(float(rest[6]), _pose(rest[3:6]), scan, _pose(rest[0:3]))

    def _robot_laser(self, words: List[str]) -> Entry:
        """ROBOTLASER1 type start field step range_max accuracy mode count ranges count remissions laser robot time."""
        start, step, range_max, count = float(words[2]), float(words[4]), float(words[5]), int(words[8])
        rest = words[9 + count:]
        rest = rest[1 + int(rest[0]):]
        scan = scan_of(_ranges(words[9:9 + count]), start, step, range_max, 0.0, self._mounting, self._reading)
        return self._entry(float(rest[11]), _pose(rest[3:6]), scan, _pose(rest[3:6]))

    @property
    def _mounting(self) -> Mounting:
        return Mounting(0.0 if self._is_corrected else self._offset)  # gmapping tells poses of the laser

    def _entry(self, stamp: float, odometry: Pose, scan: Scan, reference: Pose) -> Entry:
        if not self._is_corrected:
            return Entry(stamp, odometry, scan, None)
        if self._begun is not None and self._last is not None:
            self._odometry = compose(self._odometry, compose(inverse(self._begun), self._last))
        self._begun = self._last = None
        return Entry(stamp, self._odometry, scan, reference)


def _ranges(words: List[str]) -> Array:
    return np.array(words, np.float32)


def _pose(words: List[str]) -> Pose:
    x, y, theta = map(float, words)
    if not all(map(math.isfinite, (x, y, theta))):
        raise ValueError(f'{" ".join(words)} is no pose')
    return Pose(x, y, theta)
