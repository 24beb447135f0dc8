"""Make a map and a trajectory from a log of a laser, and judge them.

`rosrun rumba_localisation map_log FILE` reads a log of CARMEN (ODOM, FLASER, ROBOTLASER1; perhaps packed by gzip), or
a bag. It writes, beside the log or where --output says,
  NAME.yaml, NAME.png   the map, as map_server reads it
  NAME_path.png         the map with the trajectory on it (orange), and the reference (blue)
  NAME.tum              the trajectory, as `evo` reads it: stamp x y z qx qy qz qw
and tells how far the trajectory is from a reference, if there is one.
"""

import argparse
import math
import os
import sys
import time
from typing import Iterator, List, Optional, Sequence, Tuple

import numpy as np
from PIL import Image, ImageDraw
from tqdm import tqdm

from rumba_localisation.logs import carmen, trajectory
from rumba_localisation.logs.entry import Entry, LogError
from rumba_localisation.mapping.grids import saving
from rumba_localisation.mapping.mapper import Mapper
from rumba_localisation.mapping.mapper_config import MapperConfig
from rumba_localisation.scan import Reading
from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, FloorPlan

WHITE, GREY, BLACK = 255, 190, 0
OURS, TRUE = (230, 110, 0), (40, 90, 220)


def main() -> None:
    """Run the program; it ends with 2 if it is used the wrong way, and with 1 if the log cannot be read."""
    arguments = _parsed()
    try:
        _run(arguments)
    except (LogError, MapError) as error:
        sys.exit(f'map_log: {error}')


def _parsed() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog='map_log', description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add('log', metavar='FILE', help='the log')
    add('--output', metavar='PATH', help='path of what is written, without an ending')
    add('--reference', metavar='FILE', help='a trajectory in the format of TUM, to judge by')
    add('--corrected', action='store_true',
        help='the poses of the CARMEN log were corrected, as by gmapping: judge by them')
    add('--scan', default='/scan', help='topic of the scans of a bag; default %(default)s')
    add('--odom', default='/odom', help='topic of the odometry of a bag; default %(default)s')
    add('--base-frame', default='base_link', help='frame of the robot in a bag; default %(default)s')
    for name, text in (('laser-min-range', 'shorter ranges are ignored'), ('laser-max-range', 'longer ranges have no '
                       'echo'), ('max-urange', 'a beam without an echo is free up to here'),
                       ('sigma', 'standard deviation of the laser; by default it is estimated'),
                       ('delta', 'side of a cell of the map')):
        add(f'--{name}', type=_length, default=0.0, metavar='M', help=f'{text} [m]')
    return parser.parse_args()


def _length(text: str) -> float:
    length = float(text)
    if not 0.0 <= length < math.inf:
        raise argparse.ArgumentTypeError(f'{text}: must be a length, 0 or more')
    return length


def _run(arguments: argparse.Namespace) -> None:
    name = arguments.output or os.path.splitext(arguments.log[:-3] if arguments.log.endswith('.gz') else
                                                arguments.log)[0]
    begun, lost = time.process_time(), 0
    mapper: Optional[Mapper] = None
    found: List[Tuple[float, Pose]] = []
    true: List[Tuple[float, Pose]] = []
    for entry in _entries(arguments):
        if mapper is None:
            start = entry.reference or Pose(0.0, 0.0, 0.0)
            mapper = Mapper(start, MapperConfig(sigma=arguments.sigma, delta=arguments.delta))
        mapper.observe(entry.odometry, entry.scan)
        lost += mapper.is_lost
        found.append((entry.stamp, mapper.pose(entry.odometry)))
        if entry.reference is not None:
            true.append((entry.stamp, entry.reference))
    if mapper is None:
        raise LogError(f'{arguments.log}: has no scan')
    spent = time.process_time() - begun
    if arguments.reference:
        true = trajectory.load(arguments.reference)
    plan = mapper.plan(os.path.basename(name))
    saving.save(f'{name}.yaml', plan)
    trajectory.save(f'{name}.tum', found)
    _draw(f'{name}_path.png', plan, [pose for _, pose in found], [pose for _, pose in true])
    _tell(name, found, true, lost, spent)


def _entries(arguments: argparse.Namespace) -> Iterator[Entry]:
    """The entries of the log, with a bar that shows how far it is."""
    reading = Reading(arguments.laser_min_range, arguments.laser_max_range, arguments.max_urange)
    if not os.path.isfile(arguments.log):
        raise LogError(f'{arguments.log}: there is no such file')
    if arguments.log.endswith('.bag'):
        from rumba_localisation.ros import bag_log  # with rosbag, it takes a while to import
        with tqdm(unit=' messages', disable=None) as bar:
            yield from bag_log.entries(arguments.log, arguments.scan, arguments.odom, arguments.base_frame, reading,
                                       bar.update)
    else:
        with tqdm(total=os.path.getsize(arguments.log), unit='B', unit_scale=True, disable=None) as bar:
            yield from carmen.entries(arguments.log, arguments.corrected, reading, bar.update)


def _draw(path: str, plan: FloorPlan, ours: List[Pose], true: List[Pose]) -> None:
    """Paint the map with the ways."""
    pixels = np.full(plan.occupancy.shape, GREY, np.uint8)
    pixels[plan.occupancy == FREE] = WHITE
    pixels[plan.occupancy == OCCUPIED] = BLACK
    image = Image.fromarray(pixels[::-1]).convert('RGB')
    draw = ImageDraw.Draw(image)
    for way, colour in ((true, TRUE), (ours, OURS)):
        points = [((pose.x - plan.origin[0]) / plan.resolution,
                   plan.rows - (pose.y - plan.origin[1]) / plan.resolution) for pose in way]
        if len(points) > 1:
            draw.line(points, colour)
    try:
        image.save(path)
    except OSError as error:
        raise LogError(f'{path}: cannot be written: {error.strerror}') from error


def _tell(name: str, found: Sequence[Tuple[float, Pose]], true: Sequence[Tuple[float, Pose]], lost: int,
          spent: float) -> None:
    length = found[-1][0] - found[0][0]
    print(f'{len(found)} scans of {length:.0f} s in {spent:.1f} s of CPU time, {lost} of them while the robot was lost')
    if true:
        errors = trajectory.compared(found, true)
        print(f'against the reference, {errors.poses} poses: RMS {errors.absolute:.3f} m, aligned '
              f'{errors.aligned:.3f} m, at most {errors.largest:.3f} m; over 1 m of way {errors.relative:.3f} m and '
              f'{errors.turn:.4f} rad')
    print(f'wrote {name}.yaml, {name}.png, {name}_path.png and {name}.tum')
