"""map_log: a map and a trajectory from logs, as people call it."""

import math
import sys

import numpy as np
import pytest
import rosbag
import rospy
from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from nav_msgs.msg import Odometry
from PIL import Image
from rooms import crooked
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Header
from test_mapper import drive, world_of
from tf2_msgs.msg import TFMessage

from rumba_localisation.logs import trajectory
from rumba_localisation.ros import map_log
from rumba_localisation.ros.conversions import pose_message
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps import map_file

START = Pose(0.6, 1.2, 0.0)
CORNERS = [(2.0, 1.3), (2.2, 2.6), (1.0, 2.6), (0.6, 1.2), (3.4, 1.2)]


class Recorder:
    """Stands for a mapper, and keeps what a robot measured."""

    def __init__(self, world):
        """Look at a world."""
        self._world, self.told = world, []

    def observe(self, odometry, _):
        """Keep it."""
        world = self._world
        self.told.append((world.time, odometry, world.scan('rumba'), world.robots['rumba'].pose))


@pytest.fixture(scope='module', name='drive_told')
def _drive_told():
    """What a robot measured on a drive: times, poses by odometry, ranges and true poses."""
    world = world_of(crooked(0.02), START)
    recorder = Recorder(world)
    for _ in drive(world, recorder, CORNERS):
        pass
    return recorder.told


def run(monkeypatch, *arguments):
    """Call the program."""
    monkeypatch.setattr(sys, 'argv', ['map_log', *map(str, arguments)])
    map_log.main()


def check(folder, name, told):
    """Whether map, picture and trajectory are there, and right."""
    plan = map_file.load(str(folder / f'{name}.yaml'))
    assert plan.free.sum() * plan.resolution ** 2 == pytest.approx(crooked(0.02).free.sum() * 0.02 ** 2, rel=0.15)
    found = trajectory.load(str(folder / f'{name}.tum'))
    errors = trajectory.compared(found, [(time, true) for time, _, _, true in told])
    assert errors.poses > 0.9 * len(told) and errors.absolute < 0.02
    colours = Image.open(folder / f'{name}_path.png').convert('RGB').getcolors(100_000)
    assert map_log.OURS in [colour for _, colour in colours]


def test_a_log_of_carmen_with_a_reference(tmp_path, monkeypatch, capsys, drive_told):
    lines = []
    for time, odometry, ranges, _ in drive_told:
        ahead = [f'{each:.3f}' if math.isfinite(each) else '81.9' for each in ranges[90:270]]
        pose = ' '.join(f'{part:.6f}' for part in odometry)
        lines.append(f'FLASER 180 {" ".join(ahead)} {pose} {pose} {time:.3f} host {time:.3f}\n')
    (tmp_path / 'home.log').write_text(''.join(lines))
    trajectory.save(str(tmp_path / 'true.tum'), [(time, true) for time, _, _, true in drive_told])
    run(monkeypatch, tmp_path / 'home.log', '--reference', tmp_path / 'true.tum')
    said = capsys.readouterr().out.splitlines()
    assert said[0].startswith(f'{len(drive_told)} scans of ')
    assert said[0].endswith(' 0 of them while the robot was lost')
    assert said[1].startswith(f'against the reference, {len(drive_told)} poses: RMS 0.0')
    check(tmp_path, 'home', drive_told)


def test_a_bag_with_a_laser_that_is_turned_and_off_the_centre(tmp_path, monkeypatch, drive_told):
    turned = Quaternion(0.0, 0.0, 1.0, 0.0)  # the ranges of the recording begin behind: at angle 0 of this laser
    link = TransformStamped(Header(frame_id='base_link'), 'eye', Transform(Vector3(0.0, 0.0, 0.2), turned))
    with rosbag.Bag(str(tmp_path / 'home.bag'), 'w') as bag:
        bag.write('/tf_static', TFMessage([link]), rospy.Time(1))
        for time, odometry, ranges, _ in drive_told:
            stamp = rospy.Time.from_sec(time + 1.0)
            odom = Odometry(header=Header(stamp=stamp))
            odom.pose.pose = pose_message(*odometry)
            bag.write('/odometry', odom, stamp)
            bag.write('/lidar', LaserScan(
                header=Header(stamp=stamp, frame_id='eye'), angle_min=0.0, angle_increment=2.0 * math.pi / len(ranges),
                range_min=0.12, range_max=8.0, ranges=np.where(np.isfinite(ranges), ranges, 0.0).tolist()), stamp)
    run(monkeypatch, tmp_path / 'home.bag', '--scan', '/lidar', '--odom', '/odometry', '--output', tmp_path / 'flat')
    check(tmp_path, 'flat', [(time + 1.0, *rest) for time, *rest in drive_told])


@pytest.mark.parametrize('name, text, reason', [
    ('none.log', None, 'map_log: .*none.log: there is no such file'),
    ('empty.log', '# nothing\n', 'map_log: .*empty.log: has no scan'),
    ('odd.log', 'FLASER 3 1 2\n', r"map_log: .*odd.log, line 1: 'FLASER 3 1 2' \.\.\.: "),
    ('odd.bag', 'no bag', 'map_log: .*odd.bag: cannot be read: ')])
def test_a_log_that_cannot_be_used_ends_with_one_line(tmp_path, monkeypatch, name, text, reason):
    if text is not None:
        (tmp_path / name).write_text(text)
    with pytest.raises(SystemExit, match=reason) as caught:
        run(monkeypatch, tmp_path / name)
    assert '\n' not in str(caught.value)


def test_a_bag_without_the_topics_tells_which_it_has(tmp_path, monkeypatch):
    with rosbag.Bag(str(tmp_path / 'a.bag'), 'w') as bag:
        bag.write('/other', Odometry(), rospy.Time(1))
    with pytest.raises(SystemExit, match='a.bag: has no topic /scan; it has /other'):
        run(monkeypatch, tmp_path / 'a.bag')


@pytest.mark.parametrize('value', ['-1', 'nan', 'far'])
def test_a_length_that_is_none_is_refused(monkeypatch, capsys, value):
    with pytest.raises(SystemExit) as caught:
        run(monkeypatch, 'a.log', f'--delta={value}')
    assert caught.value.code == 2 and '--delta' in capsys.readouterr().err
