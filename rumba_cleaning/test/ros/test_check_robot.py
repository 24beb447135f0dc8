"""check_robot names each fault of a robot, and none of one that is sound, as an owner sees it."""

import functools
import re
import subprocess
import unittest

import programs
import rospy
from fakes import FILE, Fake
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Odometry
from simulators import TIMEOUT, folder_of, lookup, wait
from tiers import thorough

ARGUMENTS = '_scan:=/front/laser', '_odom:=/base/odometry', '_cmd_vel:=/base/velocity', '_drive:=true'
MISSING = 'neither /tf_static nor /tf leads from chassis to'
FAULTS = {  # name of the fault of the fake robot -> the line about it
    'silent scan': 'nothing came on /front/laser, although /fake_robot publishes it',
    'silent odometry': 'nothing came on /base/odometry, although /fake_robot publishes it',
    'wrong frame': f'/front/laser is in the frame lidar: {MISSING} lidar: ',
    'no tf': f'/front/laser is in the frame front_laser: {MISSING} front_laser: ',
    'turned laser': 'the laser is turned by 90 degrees against what tf says',
    'laser upside down': 'the laser is upside down against what tf says',
    'mirrored odometry': '/base/odometry: odometry turns the other way than commanded',
    'odometry stands': '/base/odometry: odometry does not move although the robot is commanded to',
    'old scan': '/front/laser has stamps 3.0 s before the clock of this computer',
    'old odometry': '/base/odometry has stamps 9.0 s before the clock of this computer',
    'other odom frame': '/base/odometry is in the frame odom, and the file says wheels',
    'millimetres': r'/front/laser has ranges of \d+ m: must be metres, not millimetres',
    'slow scan': '/front/laser comes at 1.0 Hz: must be 3 Hz or more',
    'no watchdog': 'the robot drove on for a second after the last /base/velocity: its driver must stop the motors',
    'no quaternion': '/base/odometry has numbers that make no pose'}
EVERYDAY = 'turned laser', 'wrong frame', 'no watchdog'


class CheckRobotTest(unittest.TestCase):
    """One fake robot after another."""

    def _fake(self, fault='', haste=10):
        """A robot; if nobody drives it, it waits for nobody: with a haste of 1, a busy machine can follow."""
        fake = Fake(self, f'_fault:={fault}', '_room:=chamber', f'_haste:={haste}')
        wait(self, functools.partial(_serves, fake), 'the fake robot')
        return fake

    def _check(self, *arguments, file=FILE):
        """Exit code, the lines that tell what is wrong, and all that is printed."""
        if rospy.has_param('/check_robot'):
            rospy.delete_param('/check_robot')
        done = programs.run('rumba_cleaning', 'check_robot', f'_own_robot:={file}', *(arguments or ARGUMENTS),
                            timeout=TIMEOUT, stdout=subprocess.PIPE, universal_newlines=True)
        return done.returncode, re.findall('(?m)^wrong: (.*)$', done.stdout), done.stdout

    def _names(self, fault):
        self._fake(fault)
        code, wrong, printed = self._check()
        self.assertEqual(code, 1, printed)
        self.assertEqual(len(wrong), 1, printed)
        self.assertRegex(wrong[0], FAULTS[fault])

    def test_a_sound_robot_has_no_faults_and_its_topics_are_in_the_table(self):
        self._fake()
        code, wrong, printed = self._check()
        self.assertEqual((code, wrong), (0, []), printed)
        self.assertRegex(printed, r'(?m)^scan +needed +/front/laser +(9|10)\.\d Hz +/fake_robot$')
        self.assertRegex(printed, r'(?m)^velocity command +needed +/base/velocity +taken +/fake_robot$')
        self.assertRegex(printed, r'(?m)^bumper +optional +/bumper +nothing +nobody$')

    def test_it_tells_what_to_remap_and_who_else_drives(self):
        self._fake(haste=1)
        other = rospy.Publisher('/base/velocity', Twist, queue_size=1)
        self.addCleanup(other.unregister)
        _, wrong, printed = self._check('_seconds:=2')
        self.assertEqual(wrong, [
            'nothing came on /scan: no node publishes it: give scan:=/front/laser',
            'nothing came on /odom: no node publishes it: give odom:=/base/odometry',
            'no node takes /cmd_vel: give cmd_vel:=/base/velocity'], printed)
        _, wrong, printed = self._check('_seconds:=2', *ARGUMENTS[:3])
        self.assertEqual(len(wrong), 1, printed)
        self.assertIn(f'{rospy.get_name()} publishes /base/velocity too: the robot would obey both', wrong[0])
        self.assertIn('note: the robot stood still', printed)

    def test_it_names_types_and_places_that_do_not_go_together(self):
        self._fake(haste=1)
        other = rospy.Publisher('/odom', PoseStamped, queue_size=1)
        self.addCleanup(other.unregister)
        folder = folder_of(self, {'robot.yaml': FILE.read_bytes() + b'laser: {yaw: 1.5}\n'})
        _, wrong, printed = self._check('_seconds:=2', '_scan:=/front/laser', '_odom:=/odom',
                                        '_cmd_vel:=/base/velocity', file=f'{folder}/robot.yaml')
        self.assertEqual(len(wrong), 2, printed)
        self.assertIn('the file has the laser at (0, 0) m, 86 degrees, and tf at (0.05, 0) m, 0 degrees', wrong[0])
        self.assertIn(f'/odom has type {PoseStamped._type}: must be {Odometry._type}: give odom:=/base/odometry',
                      wrong[1])


def _names(fault):
    def test(self):
        self._names(fault)
    return test if fault in EVERYDAY else thorough(test)


for each in FAULTS:
    setattr(CheckRobotTest, f'test_it_names_{each.replace(" ", "_")}_and_nothing_else', _names(each))


def _serves(fake):
    """Whether a fake robot has begun."""
    assert fake.process.poll() is None
    return lookup('/fake_robot/get_loggers')
