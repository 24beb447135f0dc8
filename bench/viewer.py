"""What the window costs: pictures alone, and the node beside a mission; without a display (Qt's platform offscreen).

The map is the apartment. The first part draws whole pictures as fast as one core can. The node draws when something
has changed, 30 times a second while the robot moves.
"""

import os
import statistics
import time

os.environ['QT_QPA_PLATFORM'] = 'offscreen'

import xmlrpc.client  # noqa: E402

import numpy as np  # noqa: E402
import rosgraph  # noqa: E402
from common import figures, ros_session  # noqa: E402
from PyQt5.QtGui import QImage, QPainter  # noqa: E402
from PyQt5.QtWidgets import QApplication  # noqa: E402

from rumba_sim.model.common.geometry import Pose  # noqa: E402
from rumba_sim.model.maps import map_file  # noqa: E402
from rumba_sim.model.settings.robot_config import RobotConfig  # noqa: E402
from rumba_sim.ros.participants.maps import map_path  # noqa: E402
from rumba_viewer.painting.paint_scene import ScenePainter  # noqa: E402
from rumba_viewer.scene.dock_field import docks  # noqa: E402
from rumba_viewer.scene.snapshot import Grid, MapFeatures, Path, Robot, Snapshot  # noqa: E402
from rumba_viewer.scene.theme import LIGHT  # noqa: E402
from rumba_viewer.scene.view_transform import ViewTransform  # noqa: E402

MAP = 'apartment'
SIZES = ((860, 660), (1640, 1080))  # [pixels] of the floor in a window of the default size and on a full screen
POINTS = 10_000  # of the path, which is 200 m long
PICTURES = 30.0  # wanted in a second, at least
SHARE = 25.0  # [%] of a core, wanted at most
WARM, SECONDS, RUNS = 8.0, 8.0, 3  # [s]


def main():
    """Measure and print."""
    application = QApplication([])
    figures.heading(f'The window: the map {MAP}, a laser of 360 beams, a path of {POINTS} points')
    for size in SIZES:
        alone(*size)
    del application
    with ros_session.master():
        for speed in (1, 10):
            beside_a_mission(speed)


def snapshot(step, number):
    """A function that makes snapshots of a robot with its laser on, one after another along its path.

    Args:
        step: returns the index of the next point of the path.
        number: identifies the coverage; a painter paints it again if it changes.
    """
    plan = map_file.load(map_path(MAP))
    features = MapFeatures(docks(plan, RobotConfig()), plan.carpet, plan.cliff, True)
    grid = Grid(plan.occupancy, plan.resolution, *plan.origin, 0)
    swept = Grid(np.where(plan.free, 100, -1).astype(np.int8), plan.resolution, *plan.origin, number)
    angles = np.linspace(-np.pi, np.pi, 360)
    beams = 2.0 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    turns = np.linspace(0.0, 60.0, POINTS)
    path = np.stack([4.0 + 0.05 * turns * np.cos(turns), 3.0 + 0.04 * turns * np.sin(turns)], axis=1)
    planned = path[::-1]

    def now():
        point = path[step()]
        return Snapshot(grid, coverage=swept, features=features, robots=(
            Robot('rumba', Pose(*point, 0.0), beams=point + beams, path=Path(path, 0), planned=planned),))
    return now


def alone(width, height):
    """Pictures in a CPU second, if only the robot moves, and if everything is new."""
    image = QImage(width, height, QImage.Format_RGB32)
    steps = iter(range(10 ** 9))
    now = snapshot(lambda: next(steps) % POINTS, 1)
    view = ViewTransform.fitted(now().plan.box, width, height)
    kept = ScenePainter()

    def paint(scene):
        painter = QPainter(image)
        scene.paint(painter, now(), view, LIGHT)
        painter.end()
    paint(kept)
    figures.row(f'{width} x {height}: pictures in a CPU second, only the robot moves',
                figures.per_cpu_second(lambda: paint(kept), 1), at_least=PICTURES)
    figures.row('  pictures in a CPU second, everything is new, as after zooming',
                figures.per_cpu_second(lambda: paint(ScenePainter()), 1))


def beside_a_mission(speed):
    """The share of a core that the node uses while the robot cleans: the median."""
    with ros_session.fresh_parameters(), ros_session.process(
            ['roslaunch', 'rumba_launch', 'demo.launch', f'speed:={speed}', 'gui:=false', 'drain:=1']), \
            ros_session.process(['rosrun', 'rumba_viewer', 'viewer', '_laser:=true']):
        pid = ros_session.wait_until(pid_of_viewer)
        time.sleep(WARM)
        shares = []
        for _ in range(RUNS):
            begin, before = time.monotonic(), figures.cpu_seconds(pid)
            time.sleep(SECONDS)
            shares.append(100.0 * (figures.cpu_seconds(pid) - before) / (time.monotonic() - begin))
        figures.row(f'a mission at speed {speed}, laser shown: share of a core [%]', statistics.median(shares),
                    below=SHARE)
        figures.row('  resident memory [MB]', figures.resident_megabytes(pid))


def pid_of_viewer():
    """Process id of the node; None before it has started."""
    try:
        return xmlrpc.client.ServerProxy(rosgraph.Master('/bench').lookupNode('/viewer')).getPid('/bench')[2]
    except (rosgraph.MasterException, OSError):
        return None


if __name__ == '__main__':
    main()
