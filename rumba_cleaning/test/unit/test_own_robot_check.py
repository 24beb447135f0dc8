"""`check_robot` names what is missing or wrong in the messages that it heard."""

import numpy as np
import pytest

from rumba_cleaning.own_robot.agreement import STANDS, TURNS_BACK
from rumba_cleaning.own_robot.check import ODOMETRY, SCAN, TWIST, report, table
from rumba_cleaning.own_robot.heard import Heard, OdometryHeard, ScanHeard, Topic, View
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.mounting import CENTRE, Mounting
from rumba_sim.model.settings.own_robot import FramesConfig, OwnRobot
from rumba_sim.model.settings.robot_config import RobotConfig

OWN = OwnRobot(RobotConfig(), FramesConfig(), None)
SEEN = ScanHeard('laser', (0.1, 0.0), np.array([1.0, np.inf, 2.0]), CENTRE, CENTRE, '')
DRIVEN = OdometryHeard('odom', 'base_link', (0.0,), True, '', True, True)
POINTS = np.array([(1.0, 0.0), (1.0, 0.5), (0.0, 2.0)])
SOUND = Heard(
    10.0, Topic('/scan', (SCAN,), ('/lidar',), (), 10.0), Topic('/odom', (ODOMETRY,), ('/base',), (), 50.0),
    Topic('/cmd_vel', (TWIST,), (), ('/base',)), {'bumper': Topic('/bumper')}, SEEN, DRIVEN,
    [View(Pose(0.0, 0.0, 0.0), POINTS)] * 2, {}, (), '', False)


def wrong(**changes):
    """What is wrong with a sound robot of which something else was heard."""
    return [fault for row in report(SOUND._replace(**changes), OWN).rows for fault in row.faults]


def test_a_sound_robot_can_be_used():
    found = report(SOUND, OWN)
    assert found.is_fit
    assert table(found)[-1] == 'the robot can be used'
    assert table(found)[2].split() == ['odometry', 'needed', '/odom', '50.0', 'Hz', '/base']


@pytest.mark.parametrize('changes, said', [
    ({'scan': Topic('/scan'), 'scan_heard': None}, 'nothing came on /scan: no node publishes it'),
    ({'scan': SOUND.scan._replace(rate=0.0), 'scan_heard': None},
     'nothing came on /scan, although /lidar publishes it'),
    ({'scan': SOUND.scan._replace(kinds=('sensor_msgs/PointCloud2',)), 'scan_heard': None},
     f'/scan has type sensor_msgs/PointCloud2: must be {SCAN}'),
    ({'scan': SOUND.scan._replace(rate=1.5)}, '/scan comes at 1.5 Hz: must be 3 Hz or more'),
    ({'odom': SOUND.odom._replace(publishers=('/a', '/b'))}, '/a and /b publish /odom: must be one node'),
    ({'scan_heard': SEEN._replace(ages=(-2.0,))}, '/scan has stamps 2.0 s after the clock of this computer'),
    ({'clock_fault': 'no /clock'}, 'no /clock'),
    ({'scan_heard': SEEN._replace(ranges=np.array([np.inf, 0.0, np.nan]))}, '/scan has no range above 0'),
    ({'scan_heard': SEEN._replace(ranges=np.array([900.0, 1100.0]))}, 'must be metres, not millimetres'),
    ({'scan_heard': SEEN._replace(mounting=None, by_tf=None, fault='no way')},
     '/scan is in the frame laser: no way: have your robot publish that, or write laser'),
    ({'scan_heard': SEEN._replace(by_tf=Mounting(0.2, 0.0, 0.0, False))},
     'the file has the laser at (0, 0) m, 0 degrees, and tf at (0.2, 0) m, 0 degrees'),
    ({'odometry_heard': DRIVEN._replace(frame='wheels')},
     '/odom is in the frame wheels, and the file says odom: write frames: {odom: wheels}'),
    ({'odometry_heard': DRIVEN._replace(child='base', is_linked=False)}, 'write frames: {base: base}'),
    ({'odometry_heard': DRIVEN._replace(is_valid=False)}, '/odom has numbers that make no pose'),
    ({'odometry_heard': DRIVEN._replace(contradiction=TURNS_BACK)}, f'/odom: {TURNS_BACK}'),
    ({'odometry_heard': DRIVEN._replace(contradiction=STANDS)}, f'/odom: {STANDS}'),
    ({'views': [SOUND.views[0], View(SOUND.views[0].pose, POINTS + 0.3)]},
     '/odom: odometry does not move although the scan does'),
    ({'mode': 1, 'optional': {'mode': Topic('/create/mode')}},
     'the robot is in passive mode and obeys nobody: it docks, charges or sleeps: have it obey with rostopic pub -1 '
     '/create/undock std_msgs/Empty'),
    ({'optional': {'mode': Topic('/mode', ('std_msgs/String',))}},
     '/mode has type std_msgs/String: ignored, since it must be one of create_msgs/Mode, ca_msgs/Mode'),
    ({'runs_on': True}, 'the robot drove on for a second after the last /cmd_vel'),
    ({'cmd_vel': Topic('/cmd_vel')}, 'no node takes /cmd_vel'),
    ({'cmd_vel': SOUND.cmd_vel._replace(kinds=('geometry_msgs/TwistStamped',))},
     f'/cmd_vel has type geometry_msgs/TwistStamped: must be {TWIST}'),
    ({'cmd_vel': SOUND.cmd_vel._replace(publishers=('/joy', '/move_base'))},
     '/joy and /move_base publish /cmd_vel too: the robot would obey both'),
    ({'optional': {'bumper': Topic('/bumper', ('std_msgs/Bool',), ('/base',), (), 5.0)}},
     '/bumper has type std_msgs/Bool: ignored, since it must be one of rumba_msg/Bumper')])
def test_each_fault_is_named_alone(changes, said):
    found = wrong(**changes)
    assert len(set(found)) == 1
    assert said in found[0]


def test_topics_that_may_be_meant_are_proposed():
    others = {SCAN: ('/base_scan',), ODOMETRY: ('/wheels',), TWIST: ('/mobile_base/velocity',)}
    found = wrong(others=others, scan=Topic('/scan'), odom=Topic('/odom'), cmd_vel=Topic('/cmd_vel'), scan_heard=None,
                  odometry_heard=None)
    assert [fault.rsplit(' ', 1)[1] for fault in found] == [
        'scan:=/base_scan', 'odom:=/wheels', 'cmd_vel:=/mobile_base/velocity']


def test_what_was_not_tested_and_who_tells_the_pose_already_is_noted():
    notes = report(SOUND._replace(map_odom=('/amcl',)), OWN).remarks
    assert notes[0] == '/amcl publishes map -> odom: end it, or give localisation:=none'
    assert notes[1].startswith('the robot stood still: ')
    turned = [View(Pose(0.0, 0.0, angle), POINTS) for angle in (0.0, 0.5)]
    assert 'whether the laser looks ahead was not tested' in report(SOUND._replace(views=turned), OWN).remarks[0]


def test_a_wrong_optional_input_does_not_make_a_robot_unfit():
    found = report(SOUND._replace(optional={'bumper': Topic('/bumper', ('std_msgs/Bool',))}), OWN)
    assert found.is_fit
