#!/usr/bin/env python3
"""The end of the cleaner: each client gets its answer, and nothing is printed; one cleaner for each robot."""

import os
import signal
import subprocess
import unittest

import programs
import rospy
import rostest
from actionlib import CommState
from cleaners import Cleaner, go_to
from simulators import TIMEOUT, Heard, Simulator, folder_of, wait, wait_for_service

from rumba_msg.msg import CleanGoal, MissionStatus, Outcome

ENDS = 6  # of the cleaner while a client is connected
STUCK = """import pathlib
import time
from rumba_cleaning.behaviour import Behaviour
from rumba_cleaning.strategies import strategy
@strategy('stuck')
class Stuck(Behaviour):
    def __init__(self, context):
        pass
    def update(self, observation):
        pathlib.Path(__file__).with_name('is_stuck').touch()
        while True:
            time.sleep(1.0)
"""


def start(name, *arguments):
    """A cleaner that needs no simulator, as a process."""
    if rospy.has_param(f'/{name}'):
        rospy.delete_param(f'/{name}')
    return programs.start('rumba_cleaning', 'cleaner', f'__name:={name}', '_map:=studio', *arguments,
                          stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, universal_newlines=True)


class CleanerEndTest(unittest.TestCase):
    """A simulator or none for each test."""

    @staticmethod
    def kill(process):
        """Have a process end without a chance to say so."""
        process.kill()
        process.wait()
        process.stderr.close()

    def test_a_cleaner_that_ends_answers_its_goal_and_prints_nothing(self):
        Simulator(self, '_map:=studio', '_speed:=10')
        for number in range(ENDS):
            cleaner = Cleaner(self, stderr=subprocess.PIPE).connect()
            action, goal = [('clean', CleanGoal()), ('go_to', go_to(1.0, 2.5))][number % 2]
            goal = cleaner.send(action, goal).is_active()
            cleaner.process.send_signal([signal.SIGINT, signal.SIGTERM][number // 2 % 2])
            self.assertEqual(cleaner.process.wait(TIMEOUT), 0)
            self.assertEqual(goal.ends(Outcome.FAILED).outcome.message, 'the cleaner ends')
            self.assertEqual(cleaner.process.stderr.read(), '')
            cleaner.process.stderr.close()

    def test_a_strategy_that_never_returns_keeps_neither_the_client_nor_the_process(self):
        path, folder = os.environ['PYTHONPATH'], folder_of(self, {'stuck.py': STUCK.encode()})
        os.environ['PYTHONPATH'] = f'{folder}:{path}'
        self.addCleanup(os.environ.update, PYTHONPATH=path)
        cleaner = Cleaner(self, '_strategies:=stuck', '_strategy:=stuck', stderr=subprocess.PIPE)
        self.addCleanup(self.kill, cleaner.process)
        Simulator(self, '_map:=field', '_speed:=10')
        cleaner.connect()
        goal = cleaner.send('clean', CleanGoal())
        wait(self, (folder / 'is_stuck').exists, 'the strategy')
        queued = cleaner.send('go_to', go_to(1.0, 2.5))
        wait(self, lambda: queued.handle.get_comm_state() == CommState.PENDING, 'the cleaner to hear of it')
        cleaner.process.send_signal(signal.SIGINT)
        self.assertEqual(goal.ends(Outcome.FAILED).outcome.message, 'the cleaner ends')
        self.assertEqual(queued.ends(Outcome.FAILED).outcome.message, 'the cleaner ends')
        _, error = cleaner.process.communicate(timeout=TIMEOUT)
        self.assertEqual(cleaner.process.returncode, 1)
        self.assertRegex(error, 'the strategy has not returned for 8 s: the cleaner ends without it')
        self.assertNotIn('Traceback', error)

    def test_of_two_cleaners_that_start_at_once_one_works_and_the_other_says_why_it_does_not(self):
        cleaners = {name: start(name) for name in ('one', 'two')}
        for process in cleaners.values():
            self.addCleanup(self.kill, process)
        wait_for_service(self, '/rumba/go_to_position')
        wait(self, lambda: any(process.poll() is not None for process in cleaners.values()), 'one to end')
        works, ends = sorted(cleaners, key=lambda name: cleaners[name].poll() is not None)
        self.assertEqual((cleaners[works].poll(), cleaners[ends].returncode), (None, 2))
        self.assertEqual(cleaners[ends].communicate()[1],
                         f"cleaner: robot 'rumba' has a cleaner already: /{works} publishes /rumba/mission_status: "
                         'end it first, or name another robot: _robot:=rumba2\n')
        for name, argument, message in ((works, '_seed:=1', f'a node /{works} is already running: end it first'),
                                        ('late', '_seed:=2', f'/{works} publishes /rumba/mission_status')):
            late = start(name, argument)
            self.addCleanup(self.kill, late)
            self.assertIn(message, late.communicate(timeout=TIMEOUT)[1])
            self.assertEqual(late.returncode, 2)
        self.assertIsNone(cleaners[works].poll())
        other = start('other', '_robot:=rumba2')
        self.addCleanup(self.kill, other)
        wait_for_service(self, '/rumba2/go_to_position', other)

    def test_a_cleaner_that_was_killed_does_not_count(self):
        first = start('killed')
        self.addCleanup(self.kill, first)
        status = Heard(self, '/rumba/mission_status', MissionStatus)
        status.find()
        self.kill(first)
        second = start('next')
        self.addCleanup(self.kill, second)
        status.fresh()
        second.terminate()
        self.assertEqual(second.wait(TIMEOUT), 0)


if __name__ == '__main__':
    rospy.init_node('test_cleaner_end')
    rostest.rosrun('rumba_cleaning', 'cleaner_end', CleanerEndTest)
