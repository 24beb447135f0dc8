"""own_robot.launch has a robot clean that shares no code with Rumba: it judges by itself what was swept."""

import sys
import tempfile

from foreign_robots import FAKES, ForeignRobotTest
from tiers import thorough

ARGUMENTS = (f'robot:={FAKES / "fake_robot.yaml"}', 'scan:=/front/laser', 'odom:=/base/odometry',
             'cmd_vel:=/base/velocity')


class OwnRobotTest(ForeignRobotTest):
    """A robot with nothing but odometry, a scan and a velocity command."""

    def _swept(self, room, *arguments):
        self.start('fake_robot', 'own_robot.launch', *ARGUMENTS, *arguments, room=room)
        return self.wait_for_end()

    def test_it_maps_and_cleans_a_chamber_from_nothing(self):
        share, message = self._swept('chamber')
        self.assertGreaterEqual(share, 0.95, message)
        self.assertRegex(message, '9[5-9].* % swept')

    @thorough
    def test_it_maps_and_cleans_a_furnished_room_from_nothing(self):
        share, message = self._swept('furnished')
        self.assertGreaterEqual(share, 0.95, message)

    @thorough
    def test_it_finds_itself_on_a_map_and_cleans_a_furnished_room(self):
        sys.path.append(str(FAKES))
        import fake_robot
        with tempfile.TemporaryDirectory() as folder:
            fake_robot.draw(fake_robot.ROOMS['furnished'], f'{folder}/room')
            share, message = self._swept('furnished', f'map:={folder}/room.yaml')
        self.assertGreaterEqual(share, 0.97, message)
