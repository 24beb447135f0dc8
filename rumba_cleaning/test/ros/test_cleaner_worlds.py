#!/usr/bin/env python3
"""The cleaner while simulators come and go: what belongs to a world that is gone does not count in the next one."""

import signal
import unittest

import rospy
import rostest
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
from cleaners import FLOOR, Cleaner, go_to
from simulators import TIMEOUT, Heard, Simulator, folder_of, shared, wait

from rumba_msg.msg import CleanGoal, GoToActionGoal, GoToActionResult, Outcome, SimulatorState

MAP = FLOOR + 'start: [1.0, 1.0, 0.0]\n'
OPEN, WALL = 80 * b'\xff', 40 * b'\xff' + b'\0' + 39 * b'\xff'


def picture(row):
    """A picture of 80 x 40 cells, each row alike."""
    return b'P5 80 40 255\n' + 40 * row


class CleanerWorldsTest(unittest.TestCase):
    """One cleaner, and one simulator after the other, on a floor whose map file changes."""

    @classmethod
    def setUpClass(cls):
        cls.fixture = shared(cls)
        cls.folder = folder_of(cls.fixture, {'floor.yaml': MAP.encode(), 'floor.pgm': picture(OPEN)})
        cls.cleaner = Cleaner(cls.fixture)
        cls.start()
        cls.cleaner.connect()

    @classmethod
    def start(cls):
        """Start a simulator."""
        cls.simulator = Simulator(cls.fixture, f'_map:={cls.folder}/floor.yaml', '_speed:=10')

    def start_again(self):
        """Kill the simulator and start another one; returns once the cleaner serves its robot."""
        run = Heard(self, '/simulator/state').find().run
        self.kill()
        self.start()
        Heard(self, '/simulator/state').find(lambda state: state.run != run)
        wait(self, self.is_served, 'the cleaner to notice')

    def kill(self):
        """Kill the simulator."""
        self.simulator.process.send_signal(signal.SIGKILL)
        self.simulator.process.wait(TIMEOUT)

    def is_served(self):
        """Whether the cleaner drives the robot, and not that of a simulator that is gone."""
        goal = self.cleaner.send('go_to', go_to(1.2, 1.0))
        wait(self, lambda: goal.has_ended, 'a result')
        return goal.handle.get_result().outcome.code == Outcome.SUCCEEDED

    def send(self, stamp, name):
        """Send a goal of go_to with a stamp [s] and an id; returns its result."""
        results = Heard(self, '/rumba/go_to/result', GoToActionResult)
        goals = rospy.Publisher('/rumba/go_to/goal', GoToActionGoal, queue_size=1)
        self.addCleanup(goals.unregister)
        wait(self, goals.get_num_connections, 'the cleaner to listen')
        goals.publish(GoToActionGoal(goal_id=GoalID(rospy.Time(stamp), name), goal=go_to(1.5, 1.0)))
        return results.find(lambda result: result.status.goal_id.id == name)

    def test_1_cancels_and_goals_of_a_time_that_is_over_do_not_count(self):
        self.assertEqual(self.send(1, 'first').status.status, GoalStatus.SUCCEEDED)
        cancels = rospy.Publisher('/rumba/go_to/cancel', GoalID, queue_size=1)
        self.addCleanup(cancels.unregister)
        wait(self, cancels.get_num_connections, 'the cleaner to listen')
        goal = self.cleaner.send('go_to', go_to(3.0, 1.0)).is_active()
        cancels.publish(GoalID(rospy.Time(2_000_000_000), ''))
        goal.ends(Outcome.CANCELLED)
        self.start_again()
        result = self.send(2, 'first')
        self.assertEqual(result.status.status, GoalStatus.SUCCEEDED, result)

    def test_2_the_status_of_actions_is_published_although_time_went_back(self):
        self.start_again()
        status = Heard(self, '/rumba/go_to/status', GoalStatusArray)
        wait(self, lambda: len({message.header.stamp for message in status.messages}) >= 5, 'the status')

    def test_3_a_map_file_that_changed_is_read_when_the_simulator_is_started_again(self):
        self.cleaner.send('go_to', go_to(3.0, 1.0)).ends(Outcome.SUCCEEDED)
        goal = self.cleaner.send('clean', CleanGoal()).is_active()
        self.kill()
        self.assertRegex(goal.ends(Outcome.NO_READINGS).outcome.message, '^the robot is gone')
        (self.folder / 'floor.pgm').write_bytes(picture(WALL))
        self.start()
        wait(self, self.is_served, 'the cleaner to notice')
        self.cleaner.refuses(r'^no path from \(1\.\d\d, 1\.00\) to \(3\.00, 1\.00\) m$', 'go_to', go_to(3.0, 1.0),
                             Outcome.NO_PATH)

    def test_4_a_cleaning_ends_and_is_not_resumed_if_the_simulator_is_started_again_at_once(self):
        goal = self.cleaner.send('clean', CleanGoal()).is_active()
        state = Heard(self, '/simulator/state').find()
        publisher = rospy.Publisher('/simulator/state', SimulatorState, queue_size=1)
        self.addCleanup(publisher.unregister)
        wait(self, lambda: publisher.get_num_connections() >= 2, 'the cleaner to listen')
        self.simulator.does('pause')
        state.run = 'another'
        # Again and again, since the simulator tells its own state once a second.
        wait(self, lambda: publisher.publish(state) or goal.has_ended, 'the end of the goal')
        self.assertEqual(goal.ends(Outcome.NO_READINGS).outcome.message,
                         'the robot is gone: the simulator was started again')
        self.cleaner.refuses('^nothing to resume: ', 'clean', CleanGoal(resume=True))


if __name__ == '__main__':
    rospy.init_node('test_cleaner_worlds')
    rostest.rosrun('rumba_cleaning', 'cleaner_worlds', CleanerWorldsTest)
