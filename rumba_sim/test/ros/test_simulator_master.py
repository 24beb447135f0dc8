#!/usr/bin/env python3
"""Simulators and the master: one at a time, whoever starts when; and a master that is restarted."""

import re
import signal
import subprocess
import unittest

import programs
import rospy
import rostest
from simulators import LOOK_PERIOD, TIMEOUT, Master, folder_of, wait
from tiers import thorough

ROUNDS = 3
READY = 'tuning/set_parameters'
TOGETHER = """#!/usr/bin/env python3
import sys
from rumba_sim.ros.simulator import simulator
print('ready', flush=True)
sys.stdin.read()
simulator.main()
"""


class OwnMaster(Master):
    """A separate master, and programs at it."""

    def begin(self, path, *arguments):
        """A program at this master."""
        process = programs.start_script(path, *arguments, env=self.environment, stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        self._test.addCleanup(process.stdout.close)
        self._test.addCleanup(process.stdin.close)
        self._test.addCleanup(process.wait)
        self._test.addCleanup(process.kill)
        return process

    def simulator(self, *arguments):
        """A simulator at this master, perhaps not ready yet."""
        return self.begin(programs.executable('rumba_sim', 'simulator'), '_map:=studio', *arguments)

    def call(self, *command):
        """What a command of ROS prints."""
        return subprocess.run(command, env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              universal_newlines=True, timeout=TIMEOUT, check=False).stdout


class SimulatorMasterTest(unittest.TestCase):
    """Each test has a master of its own."""

    def assert_one_survives(self, arguments, message):
        """Start simulators at the same moment: one runs, the others say in one line why they do not."""
        master = OwnMaster(self).start()
        together = folder_of(self, {'together': TOGETHER.encode()}) / 'together'
        for _ in range(ROUNDS):
            processes = [master.begin(together, '_map:=studio', *each) for each in arguments]
            for process in processes:
                self.assertEqual(process.stdout.readline(), 'ready\n')
            for process in processes:
                process.stdin.close()
            wait(self, lambda: [process.poll() for process in processes].count(None) <= 1)  # noqa: B023
            told = {process: process.stdout.read() for process in processes if process.poll() is not None}
            self.assertEqual(len(told), len(processes) - 1, list(told.values()))
            for process, text in told.items():
                self.assertEqual(process.returncode, 2, text)
                self.assertRegex(text, message)
            [running] = set(processes) - set(told)
            master.wait_for('/static_map')
            self.assertIsNone(running.poll())
            wait(self, lambda: 'reserv' not in str(master.api.getSystemState()), 'the end of the reservation',
                 LOOK_PERIOD)
            running.terminate()
            self.assertEqual(running.wait(TIMEOUT), 0)

    @thorough
    def test_of_simulators_that_start_at_one_moment_in_two_namespaces_one_survives(self):
        self.assert_one_survives(
            [['__ns:=/one'], ['__ns:=/two'], ['__ns:=/three']],
            r'^simulator: another (simulator starts at the same moment: only one of them can|node already serves '
            r'/static_map: end .*)\n$')

    def test_of_simulators_of_one_name_that_start_at_one_moment_one_survives(self):
        self.assert_one_survives(
            [[], [], []],
            r'^simulator: (another node /simulator starts at the same moment: only one of them can|a node /simulator '
            r'is already running: end it first)\n$')

    def test_after_a_restart_of_the_master_all_nodes_are_there_again(self):
        master = OwnMaster(self).start()
        master.simulator('_speed:=10')
        listener = master.begin(programs.executable('rumba_sim', 'battery_status_listener'))
        master.wait_for(f'/simulator/{READY}')
        self.assertIn('battery', listener.stdout.readline())
        before = master.api.getSystemState()
        tick = self.tick(master)
        master.restart()
        wait(self, lambda: as_sets(master.api.getSystemState()) == as_sets(before), f'{before} again', LOOK_PERIOD)
        wait(self, lambda: master.api.hasParam('/simulator/tuning/speed'), 'the parameters of the tuning')
        self.assertEqual(master.api.getParam('/simulator/settings/speed'), 10.0)
        self.assertTrue(master.api.getParam('/use_sim_time'))
        self.assertGreater(self.tick(master), tick)
        self.assertIn('success: True', master.call('rosservice', 'call', '/simulator/pause'))
        second = master.simulator('__name:=second')
        self.assertRegex(second.communicate(timeout=TIMEOUT)[0], '^simulator: another node already serves /static_map')

    def tick(self, master):
        """The number of the tick, by a new subscriber."""
        told = master.call('rostopic', 'echo', '-n1', '/simulator/state/tick')
        return int(re.search(r'^(\d+)$', told, re.MULTILINE).group(1))

    def test_a_simulator_that_finds_another_at_the_new_master_ends_with_one_line(self):
        master = OwnMaster(self).start()
        old = master.simulator('__name:=old')
        master.wait_for(f'/old/{READY}')
        old.send_signal(signal.SIGSTOP)
        master.restart()
        new = master.simulator('__name:=new')
        master.wait_for(f'/new/{READY}')
        old.send_signal(signal.SIGCONT)
        told = old.communicate(timeout=TIMEOUT)[0]
        self.assertIn('the master was restarted, and this node ends: another node already serves /static_map: ', told)
        self.assertEqual(old.returncode, 0)
        self.assertIsNone(new.poll())
        self.assertIn('width: ', master.call('rosservice', 'call', '/static_map'))


def as_sets(state):
    """Publishers, subscribers and services at a master, regardless of their order."""
    return [{name: set(nodes) for name, nodes in kind} for kind in state]


if __name__ == '__main__':
    rospy.init_node('test_simulator_master')
    rostest.rosrun('rumba_sim', 'simulator_master', SimulatorMasterTest)
