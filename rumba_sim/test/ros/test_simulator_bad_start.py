#!/usr/bin/env python3
"""A simulator that cannot start prints the reason in one line, ends with exit code 2, and changes nothing."""

import os
import signal
import subprocess
import unittest

import programs
import rospy
import rostest
from simulators import ROOM, TIMEOUT, Heard, Master, Simulator, folder_of, forget_parameters, lookup

UNIQUE = r"^simulator: a node /simulator is already running: end it first\n$"
MAP = r'^simulator: another node already serves /static_map: end the other simulator or map_server, or give '


class SimulatorBadStartTest(unittest.TestCase):
    """Simulators that do not start, and those that run already."""

    def assert_refused(self, message, *arguments):
        """Start a node that must print one line, which matches a pattern, and end."""
        done = programs.run('rumba_sim', 'simulator', *arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            universal_newlines=True, timeout=TIMEOUT)
        self.assertEqual((done.returncode, done.stdout), (2, ''), done.stderr)
        self.assertRegex(done.stderr, message)
        self.assertEqual(done.stderr.count('\n'), 1)

    def test_bad_input_ends_the_node_with_one_line_and_exit_code_2_and_leaves_no_parameter(self):
        forget_parameters()
        where = '^simulator: parameter of /simulator: '
        folder = folder_of(self, {
            **ROOM, 'bad.yaml': b'battery:\n  drian: 2\n', 'leg.yaml': b'leg: {pose: [1, 1], radus: 0.1, height: 1}\n',
            'dock.yaml': b'leg: {pose: [2.9, 2.8], radius: 0.1, height: 1}\n'})
        room = folder / 'room.yaml'
        path, leg, dock = (folder / f'{name}.yaml' for name in ('bad', 'leg', 'dock'))
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
                (where + r"config is \['a'\]: must be text\n$", '_config:=[a]'),
                (where + r'config is 5: must be text\n$', '_config:=5'),
                (where + r'speed is 0\.0005: must be 0, or 0\.001 to 1000000\n$', '_speed:=0.0005'),
                (r"^simulator: _seed:='9{23}': cannot be a parameter: int exceeds XML-RPC limits\n$",
                 f'_seed:={23 * "9"}'),
                (rf'^simulator: {room}: no room for another robot\n$', '_robots:=20', f'_map:={room}'),
                (r'^simulator: /no/things\.yaml: No such file or directory\n$', '_obstacles:=/no/things.yaml'),
                (rf"^simulator: {leg}: leg/radus is unknown: did you mean 'radius'\?\n$", f'_obstacles:={leg}'),
                (r"^simulator: 'leg' stands at the dock, \(3\.0[78], 2\.84\) m: no robot fits there\n$",
                 f'_obstacles:={dock}', '_map:=studio'),
                (r"^simulator: unknown argument 'studio': ", 'studio'),
                (r"^simulator: cannot start: \[Errno 20\] Not a directory: '/dev/null/x'\n$", '__log:=/dev/null/x'),
                (r'^simulator: map:= remaps a topic: for the parameter write _map:=\n$', 'map:=studio')):
            self.assert_refused(message, *arguments)
            self.assertFalse(any(value != {} for value in rospy.get_param('/simulator', {}).values()))
        self.assertFalse(rospy.has_param('/use_sim_time'))

    def test_parameters_that_are_no_mapping_are_refused_and_stay(self):
        rospy.set_param('/simulator', 'text')
        self.addCleanup(rospy.delete_param, '/simulator')
        self.assert_refused("^simulator: parameter /simulator is 'text': must be a mapping of drive, ")
        self.assertEqual(rospy.get_param('/simulator'), 'text')

    def test_a_log_folder_that_is_full_is_one_line_and_the_simulator_runs(self):
        """A limit on the size of files has the same effect as a full disk; rosrun itself may write a cache.

        Semaphores are files of 32 bytes: numba before 0.49 warns if there is no space for one.
        """
        forget_parameters()
        folder = folder_of(self, {})
        process = subprocess.Popen(
            ['rosrun', '--prefix', 'prlimit --fsize=64', 'rumba_sim', 'simulator', '_map:=field', '_speed:=10'],
            stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, universal_newlines=True,
            env={**os.environ, 'ROS_LOG_DIR': str(folder)})
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        odom = Heard(self, '/rumba/odom')
        odom.find(lambda message: message.header.stamp.to_sec() > 5.0)
        process.terminate()
        told = process.communicate(timeout=TIMEOUT)[1]
        self.assertRegex(told, rf'^simulator: cannot write the log {folder}/simulator.*\.log: .*File too large; the '
                               r'node goes on without it\n$')
        self.assertEqual(process.returncode, 0)

    def test_a_second_simulator_refuses_to_start_and_the_first_continues(self):
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

    def test_a_simulator_starts_although_the_master_still_knows_one_that_was_killed(self):
        killed = Simulator(self, '_map:=field')
        killed.process.send_signal(signal.SIGKILL)
        self.assertEqual(killed.process.wait(TIMEOUT), -signal.SIGKILL)
        self.assertTrue(lookup('/simulator/tuning/set_parameters'))
        Simulator(self, '_map:=field')
        odom = Heard(self, '/rumba/odom')
        odom.find()

    def start_without_master(self, master):
        """Start a simulator, and check the line that it prints."""
        process = programs.start('rumba_sim', 'simulator', '_map:=field', stderr=subprocess.PIPE,
                                 universal_newlines=True, env={**os.environ, 'ROS_MASTER_URI': master.uri})
        self.addCleanup(process.communicate)
        self.addCleanup(process.terminate)
        self.assertEqual(process.stderr.readline(),
                         f'simulator: no roscore answers at {master.uri} yet: waiting for it\n')
        return process

    def test_without_a_master_it_says_so_and_waits_for_one(self):
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
