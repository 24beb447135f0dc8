#!/usr/bin/env python3
"""A simulator that was killed goes on from its file, bit for bit; a file that does not fit is refused and kept."""

import os
import subprocess
import unittest

import programs
import rospy
import rostest
from geometry_msgs.msg import Pose2D
from simulators import ROOM, TIMEOUT, Heard, Simulator, folder_of, forget_parameters, wait

from rumba_sim.model.common.config import updated
from rumba_sim.model.maps import map_file
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation import world_state
from rumba_sim.model.simulation.world import World

MINUTE = 3000  # [ticks]
DRAIN = '_battery/drain:=20'


class SimulatorSavedTest(unittest.TestCase):
    """Each test has a folder and simulators of its own, in a small room."""

    def setUp(self):
        self.folder = folder_of(self, ROOM)
        self.path = self.folder / 'state'
        self.arguments = [f'_map:={self.folder / "room.yaml"}', '_speed:=10', DRAIN, '_robots:=2', '_seed:=5']

    def simulator(self, *arguments):
        """A simulator that saves its world."""
        return Simulator(self, *self.arguments, f'_state:={self.path}', *arguments)

    def saved(self):
        """The state in the file, and the ticks."""
        return world_state.read(str(self.path))

    def test_after_a_kill_it_goes_on_from_the_last_minute_as_if_it_had_never_ended(self):
        simulator = self.simulator()
        simulator.pause()
        simulator.does('spawn', 'guest', Pose2D(0.5, 1.5, 1.0))
        simulator.does('kill', 'rumba')
        simulator.step(2 * MINUTE - simulator.ticks + 17)
        state, ticks = self.saved()
        self.assertEqual(ticks, 2 * MINUTE)
        self.assertEqual([member.name for member in state.members], ['rumba2', 'guest'])
        simulator.kill()
        config = updated(RobotConfig(), {'battery': {'drain': 20}}, 'test')
        expected = World.restored(state, map_file.load(str(self.folder / 'room.yaml')), config, 50, 5)
        again = self.simulator()
        Heard(self, '/guest/odom').find()
        again.pause()
        self.assertGreater(again.ticks, 2 * MINUTE)
        again.step(4 * MINUTE - again.ticks)
        state, ticks = self.saved()
        expected.step(ticks - 2 * MINUTE)
        self.assertEqual((ticks, state.digest), (4 * MINUTE, expected.digest()))
        self.assertLess(expected.robots['guest'].battery.percentage, 95)

    def test_at_its_end_it_saves_too_and_a_reset_leaves_the_time(self):
        simulator = self.simulator()
        simulator.pause()
        simulator.step(100)
        simulator.does('reset')
        simulator.step(3)
        simulator.end()
        state, ticks = self.saved()
        self.assertEqual((ticks, state.tick), (simulator.ticks, 3))
        again = self.simulator()
        again.pause()
        self.assertGreater(again.ticks, simulator.ticks)
        self.assertEqual([path.name for path in self.folder.iterdir() if 'state' in path.name], ['state'])

    def assert_refused(self, message, *arguments):
        """Start a simulator that must print one line, which matches a pattern, and end."""
        forget_parameters()
        before = self.path.read_bytes() if self.path.is_file() else None
        done = programs.run('rumba_sim', 'simulator', *self.arguments, f'_state:={self.path}', *arguments,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, timeout=TIMEOUT)
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertRegex(done.stdout.splitlines()[-1], f'^simulator: {self.path}: {message}$')
        self.assertEqual(self.path.read_bytes() if self.path.is_file() else None, before)

    def test_a_file_that_does_not_fit_is_refused_in_one_line_and_kept(self):
        simulator = self.simulator()
        simulator.end()
        ending = ': start with what it was saved with, or give state another file'
        self.assert_refused('was saved with seed 5, which is 6 now' + ending, '_seed:=6')
        self.assert_refused('was saved with battery/drain 20.0, which is 30.0 now' + ending, '_battery/drain:=30')
        self.assert_refused("was saved on another map, '.*room.yaml', or the map has changed since" + ending,
                            '_map:=studio')
        whole = self.path.read_bytes()
        self.path.write_bytes(whole[:len(whole) // 2])
        self.assert_refused('is no saved world, or is damaged: .*')
        self.path.unlink()
        os.mkfifo(self.path)
        self.assert_refused('is a named pipe: must be a regular file')
        self.path.unlink()
        self.path = self.folder / 'none' / 'state'
        self.assert_refused('cannot save the world: No such file or directory')

    def test_if_saving_fails_later_it_says_so_and_the_world_goes_on(self):
        simulator = self.simulator()
        simulator.pause()
        log = Heard(self, '/rosout')
        self.path.unlink()
        self.path.mkdir()
        simulator.step(MINUTE)
        log.find(lambda message: message.msg == f'{self.path}: cannot save the world: Is a directory; what was saved '
                                                'before is still there')
        simulator.does('resume')
        wait(self, Heard(self, '/rumba/odom').messages.__len__, 'odometry')
        self.assertEqual([path.name for path in self.folder.iterdir() if 'state' in path.name], ['state'])


if __name__ == '__main__':
    rospy.init_node('test_simulator_saved')
    rostest.rosrun('rumba_sim', 'simulator_saved', SimulatorSavedTest)
