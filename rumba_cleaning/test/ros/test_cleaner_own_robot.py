"""The cleaner of a robot that is not ours says what is missing, and never that a robot is gone that talks."""

import pathlib
import unittest

import fake_robot
from cleaners import Cleaner
from fakes import FILE, REMAPPED, Fake
from simulators import Heard, folder_of

from rumba_msg.msg import MissionStatus


class CleanerOwnRobotTest(unittest.TestCase):
    """A cleaner with a map, and nobody who tells where the robot is."""

    def setUp(self):
        folder = pathlib.Path(folder_of(self, {}))
        fake_robot.draw(fake_robot.ROOMS['chamber'], folder / 'room')
        self.statuses = Heard(self, '/rumba/mission_status', MissionStatus, waits=False)
        self.map = folder / 'room.yaml'

    def _end_of_mission(self):
        Cleaner(self, f'_own_robot:={FILE}', f'_map:={self.map}', '_autostart:=true', *REMAPPED)
        return self.statuses.find(lambda status: status.state == MissionStatus.IDLE and 'waits' not in status.message)

    def test_without_a_localisation_it_says_so(self):
        Fake(self, '_room:=chamber')
        self.assertEqual(self._end_of_mission().message,
                         'no pose: tf has no map -> wheels -> chassis: no localiser or mapper publishes it')

    def test_without_odometry_it_names_the_topic(self):
        self.assertEqual(self._end_of_mission().message, 'no odometry: no node publishes /base/odometry')

    def test_if_the_odometry_falls_silent_it_names_the_node_that_is_still_there(self):
        Fake(self, '_room:=chamber', '_fault:=silent odometry')
        self.assertEqual(self._end_of_mission().message,
                         'no odometry: nothing came on /base/odometry, although a node publishes it')

    def test_an_odometry_without_stamps_is_named(self):
        Fake(self, '_room:=chamber', '_fault:=no stamps')
        self.assertEqual(self._end_of_mission().message, 'no odometry: the stamps of /base/odometry stay the same')
