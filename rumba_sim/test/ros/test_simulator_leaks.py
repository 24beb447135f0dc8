#!/usr/bin/env python3
"""Hundreds of robots that come and go leave nothing: no thread, no file descriptor, no memory, no topic."""

import os
import pathlib
import re
import unittest

import rosgraph
import rospy
import rostest
from geometry_msgs.msg import Pose2D
from simulators import SERVICES, Simulator, wait
from tiers import thorough

TIMES = 300
WARM_UP = 20
MEMORY = 10_000  # [kB] of all that; one robot that stays takes more than 100


class SimulatorLeaksTest(unittest.TestCase):
    """One simulator with one robot that stays."""

    @thorough
    def test_hundreds_of_spawns_and_kills_leave_nothing(self):
        simulator = Simulator(self, '_map:=field', '_speed:=10')
        process = pathlib.Path('/proc', str(simulator.process.pid))
        spawn, kill = (rospy.ServiceProxy(f'/simulator/{name}', SERVICES[name]) for name in ('spawn', 'kill'))

        def come_and_go(number):
            name = f'guest{number}'
            heard = []
            answer = spawn(name, Pose2D(2.0, 2.0, 0.0))
            self.assertTrue(answer.success, answer.message)
            subscriber = rospy.Subscriber(f'/{name}/odom', rospy.AnyMsg, heard.append)
            wait(self, lambda: heard, f'/{name}/odom')
            answer = kill(name)
            self.assertTrue(answer.success, answer.message)
            subscriber.unregister()

        def registered():
            return [sorted(name for name, nodes in kind if '/simulator' in nodes)
                    for kind in rosgraph.Master('/test').getSystemState()]

        def counts():
            return len(os.listdir(process / 'fd')), len(os.listdir(process / 'task'))

        def memory():
            return int(re.search(r'VmRSS:\s*(\d+) kB', (process / 'status').read_text()).group(1))
        before = registered()
        for number in range(WARM_UP):
            come_and_go(number)
        fewest, much = counts(), memory()
        for number in range(WARM_UP, TIMES):
            come_and_go(number)
        wait(self, lambda: all(now <= then + 1 for now, then in zip(counts(), fewest)),
             f'file descriptors and threads as before, {fewest}')
        self.assertLess(memory() - much, MEMORY)
        self.assertEqual(registered(), before)


if __name__ == '__main__':
    rospy.init_node('test_simulator_leaks')
    rostest.rosrun('rumba_sim', 'simulator_leaks', SimulatorLeaksTest)
