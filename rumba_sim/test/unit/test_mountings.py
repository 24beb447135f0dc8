"""How a laser is mounted, by messages of tf."""

import math

import pytest
from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

from rumba_sim.model.settings.mounting import CENTRE, Mounting
from rumba_sim.ros.common.mountings import Mountings


def turned(roll=0.0, pitch=0.0, yaw=0.0):
    """A rotation about x, then y, then z, as a quaternion."""
    (sr, cr), (sp, cp), (sy, cy) = ((math.sin(0.5 * angle), math.cos(0.5 * angle)) for angle in (roll, pitch, yaw))
    return Quaternion(sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy,
                      cr * cp * cy + sr * sp * sy)


def link(parent, child, x=0.0, y=0.0, z=0.0, rotation=Quaternion(0.0, 0.0, 0.0, 1.0)):
    """A transform."""
    return TransformStamped(Header(frame_id=parent), child, Transform(Vector3(x, y, z), rotation))


def mounted(*links, frame='laser'):
    """What is known of a frame after a message."""
    known = Mountings('base_link')
    known.take(TFMessage(list(links)))
    return known.of(LaserScan(header=Header(frame_id=frame)))


@pytest.mark.parametrize('rotation, yaw, upside_down', [
    (turned(), 0.0, False), (turned(yaw=0.7), 0.7, False), (turned(yaw=math.pi), math.pi, False),
    (turned(roll=math.pi), 0.0, True), (turned(roll=math.pi, yaw=0.5), 0.5, True),
    (turned(pitch=math.pi), math.pi, True), (turned(roll=0.05, yaw=-1.0), -1.0, False)])
def test_a_level_laser_is_mounted_as_its_transform_says(rotation, yaw, upside_down):
    found = mounted(link('base_link', 'laser', 0.1, -0.05, 0.2, rotation))
    assert found[:2] == pytest.approx((0.1, -0.05)) and found.upside_down is upside_down
    assert math.cos(found.yaw - yaw) == pytest.approx(1.0, abs=1e-4)


def test_transforms_lead_from_frame_to_frame_and_slashes_do_not_count():
    found = mounted(link('/base_link', '/plate', 0.1, 0.0, 0.1, turned(yaw=0.5 * math.pi)),
                    link('plate', 'tower', 0.2, 0.0, 0.0), link('tower', 'laser', 0.0, 0.0, 0.1, turned(yaw=0.5)))
    assert found == pytest.approx(Mounting(0.1, 0.2, 0.5 * math.pi + 0.5, False))


@pytest.mark.parametrize('frame', ['', 'base_link', '/base_link'])
def test_a_laser_in_the_frame_of_the_robot_is_in_its_centre(frame):
    assert mounted(frame=frame) == CENTRE


def test_a_laser_in_the_centre_is_exactly_there():
    assert mounted(link('base_link', 'laser', 0.0, 0.0, 0.07)) == CENTRE


@pytest.mark.parametrize('links, reason', [
    ([], 'neither /tf_static nor /tf leads from base_link to laser'),
    ([link('plate', 'laser')], 'neither /tf_static nor /tf leads from base_link to laser'),
    ([link('laser', 'base_link')], 'neither /tf_static nor /tf leads from base_link to laser'),
    ([link('plate', 'laser'), link('laser', 'plate')], 'neither /tf_static nor /tf leads from base_link to laser'),
    ([link('base_link', 'laser', math.nan)], 'neither /tf_static nor /tf leads from base_link to laser'),
    ([link('base_link', 'laser', 1e9)], 'neither /tf_static nor /tf leads from base_link to laser'),
    ([link('base_link', 'laser', rotation=Quaternion(0.0, 0.0, 0.0, 0.0))],
     'neither /tf_static nor /tf leads from base_link to laser'),
    ([link('base_link', 'laser', rotation=turned(pitch=0.5))],
     'by tf, laser is tilted against base_link: it must be level, or upside down')])
def test_where_nothing_tells_how_it_is_mounted_the_reason_is_told(links, reason):
    known, scan = Mountings('base_link'), LaserScan(header=Header(frame_id='laser'))
    known.take(TFMessage(links))
    assert known.of(scan) is None and known.fault(scan) == reason


def test_the_newest_transform_counts():
    known, scan = Mountings('base_link'), LaserScan(header=Header(frame_id='laser'))
    for x in (0.1, 0.2):
        known.take(TFMessage([link('base_link', 'laser', x)]))
        assert known.of(scan) == Mounting(x, 0.0, 0.0, False)
