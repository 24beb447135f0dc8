#!/usr/bin/env python3
"""The simulator ends when it is told to, soon and with exit code 0, whatever it does at that time."""

import os
import signal
import subprocess
import sys
import unittest

import rospy
import rostest
from ports import free_port
from rosgraph_msgs.msg import Log
from simulators import TIMEOUT, Heard, Simulator, wait

BROKEN = """
import dataclasses
import time
from rumba_sim.ros.running import node
from rumba_sim.ros.participants.requests import Requests

@dataclasses.dataclass(frozen=True)
class Settings:
    pass

def main(settings):
    requests = Requests()
    requests.post(lambda: {}['lost'])
    while True:
        time.sleep(2.0)
        requests.serve(time.monotonic())

node.run('broken', Settings, main)
"""


class SimulatorEndTest(unittest.TestCase):
    """Each test has a simulator for each way to end it."""

    def test_both_signals_end_it_in_real_time_as_fast_as_possible_and_while_paused(self):
        for speed in (1, 0):
            for number in (signal.SIGINT, signal.SIGTERM):
                simulator = Simulator(self, '_map:=field', f'_speed:={speed}')
                for topic in ('odom', 'scan', 'ground_truth'):
                    Heard(self, f'/rumba/{topic}').find()
                if speed and number == signal.SIGTERM:
                    simulator.does('pause')
                simulator.end(number)

    def test_an_error_in_what_was_posted_to_the_loop_is_logged_and_ends_the_node(self):
        log = Heard(self, '/rosout', Log)
        done = subprocess.run([sys.executable, '-c', BROKEN], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              universal_newlines=True, timeout=TIMEOUT, check=False)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertEqual(done.stdout.count("KeyError: 'lost'"), 1, done.stdout)
        told = log.find(lambda message: message.level == Log.FATAL)
        self.assertRegex(told.msg, r"^broken ends because of an error of its own:\nTraceback [^$]*KeyError: 'lost'\n$")

    def test_rosnode_kill_ends_it(self):
        simulator = Simulator(self, '_map:=field', '_speed:=0')
        Heard(self, '/rumba/odom').find()
        subprocess.check_call(['rosnode', 'kill', '/simulator'], stdout=subprocess.DEVNULL)
        self.assertEqual(simulator.process.wait(TIMEOUT), 0)

    def test_it_also_ends_if_the_master_has_ended(self):
        for speed, number in ((0, signal.SIGINT), (10, signal.SIGTERM)):
            port = free_port()
            uri = f'http://localhost:{port}'
            master = subprocess.Popen(['rosmaster', '--core', '-p', str(port)], stdout=subprocess.DEVNULL)
            self.addCleanup(master.wait)
            self.addCleanup(master.kill)
            simulator = Simulator(self, '_map:=field', f'_speed:={speed}', master=uri,
                                  environment={**os.environ, 'ROS_MASTER_URI': uri})
            master.terminate()
            wait(self, lambda: master.poll() is not None)  # noqa: B023 (called at once)
            simulator.end(number)


if __name__ == '__main__':
    rospy.init_node('test_simulator_end')
    rostest.rosrun('rumba_sim', 'simulator_end', SimulatorEndTest)
