#!/usr/bin/env python3
"""A simulator that cannot start says why in one line, with exit code 2, and does no harm."""

import os
import signal
import subprocess
import tempfile
import unittest

import rospy
import rostest
from simulators import TIMEOUT, Heard, Master, Simulator, forget_parameters, lookup

UNIQUE = r"^simulator: a node /simulator is here already: end it first\n$"
MAP = r'^simulator: /static_map is served already: end the other simulator, or map_server, or give this one a master '
ROOM = b"""image: room.pgm
resolution: 0.05
origin: [0, 0, 0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""


def write(folder, name, content):
    """Make a file; returns its path."""
    path = os.path.join(folder, name)
    with open(path, 'wb') as file:
        file.write(content)
    return path


class SimulatorBadStartTest(unittest.TestCase):
    """Simulators that do not start, and those that were there before."""

    def assert_refused(self, message, *arguments):
        """What a user sees, of a node that is started and refuses."""
        done = subprocess.run(['rosrun', 'rumba_sim', 'simulator', *arguments], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True, timeout=TIMEOUT, check=False)
        self.assertEqual((done.returncode, done.stdout), (2, ''), done.stderr)
        self.assertRegex(done.stderr, message)
        self.assertEqual(done.stderr.count('\n'), 1)

    def test_bad_input_gets_one_line_and_exit_code_2_and_is_forgotten(self):
        forget_parameters()
        where = '^simulator: parameter of /simulator: '
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path, room = write(folder.name, 'bad.yaml', b'battery:\n  drian: 2\n'), write(folder.name, 'room.yaml', ROOM)
        write(folder.name, 'room.pgm', b'P5 20 20 255\n' + 400 * b'\xff')
        for message, *arguments in (
                ("^simulator: there is no map 'moon': give the path of a map_server YAML file, or one of apartment, ",
                 '_map:=moon'),
                (r'^simulator: /no/where\.yaml: No such file or directory\n$', '_map:=/no/where.yaml'),
                (where + r"sped is unknown: did you mean 'speed'\?\n$", '_sped:=2'),
                (where + r"battery/drian is unknown: did you mean 'drain'\?\n$", '_battery/drian:=2'),
                (where + r"battery is 5: must be a mapping of ", '_battery:=5'),
                (where + r"speed is 'fast': must be 0 to 1000000\n$", '_speed:=fast'),
                (where + r'robots is -1: must be 0 to 1000\n$', '_robots:=-1'),
                (where + r'drive/max_speed is nan: must be ', '_drive/max_speed:=.nan'),
                (where + r'rates/scan is 15: must divide step_rate, 50: one of 0, 1, 2, 5, 10, 25, 50\n$',
                 '_rates/scan:=15'),
                (rf"^simulator: {path}: battery/drian is unknown: did you mean 'drain'\?\n$", f'_config:={path}'),
                (r'^simulator: /no/such\.yaml: No such file or directory\n$', '_config:=/no/such.yaml'),
                (rf'^simulator: {room}: no room for another robot\n$', '_robots:=20', f'_map:={room}'),
                (r"^simulator: unknown argument 'studio': ", 'studio'),
                (r'^simulator: map:= remaps a topic: for the parameter write _map:=\n$', 'map:=studio')):
            with self.subTest(arguments):
                self.assert_refused(message, *arguments)
                self.assertFalse(any(value != {} for value in rospy.get_param('/simulator', {}).values()))
        self.assertFalse(rospy.has_param('/use_sim_time'))

    def test_a_second_simulator_is_refused_and_the_first_goes_on_unharmed(self):
        simulator = Simulator(self, '_map:=field', '_speed:=0')
        parameters = rospy.get_param('/simulator')
        self.assert_refused(UNIQUE, '_map:=studio')
        self.assertEqual(rospy.get_param('/simulator'), parameters)
        self.assert_refused(MAP, '__name:=other', '_map:=studio')
        self.assert_refused(MAP, '__ns:=/other')
        odom = Heard(self, '/rumba/odom')
        begin = odom.fresh().header.stamp
        odom.find(lambda message: (message.header.stamp - begin).to_sec() > 1.0)
        self.assertTrue(rospy.get_param('/use_sim_time'))
        simulator.does('pause')
        self.assertIsNone(simulator.process.poll())

    def test_what_a_killed_simulator_left_at_the_master_is_in_nobody_s_way(self):
        killed = Simulator(self, '_map:=field')
        killed.process.send_signal(signal.SIGKILL)
        self.assertEqual(killed.process.wait(TIMEOUT), -signal.SIGKILL)
        self.assertTrue(lookup('/simulator/tuning/set_parameters'))
        Simulator(self, '_map:=field')
        odom = Heard(self, '/rumba/odom')
        odom.find()

    def start_without_master(self, master):
        """A simulator, and the line that it prints."""
        process = subprocess.Popen(['rosrun', 'rumba_sim', 'simulator', '_map:=field'], stderr=subprocess.PIPE,
                                   universal_newlines=True, env={**os.environ, 'ROS_MASTER_URI': master.uri})
        self.addCleanup(process.communicate)
        self.addCleanup(process.terminate)
        self.assertEqual(process.stderr.readline(),
                         f'simulator: no roscore answers at {master.uri} yet: waiting for it\n')
        return process

    def test_without_a_master_it_says_so_and_goes_on_when_there_is_one(self):
        master = Master(self)
        impatient = self.start_without_master(master)
        impatient.send_signal(signal.SIGINT)
        self.assertEqual(impatient.communicate(timeout=TIMEOUT), (None, ''))
        self.start_without_master(master)
        master.start()
        master.wait_for('/simulator/tuning/set_parameters')


if __name__ == '__main__':
    rospy.init_node('test_simulator_bad_start')
    rostest.rosrun('rumba_sim', 'simulator_bad_start', SimulatorBadStartTest)
