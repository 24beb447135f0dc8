#!/usr/bin/env python3
"""The simulator's time: clock, pause, step and reset, exact to the tick."""

import os
import pathlib
import subprocess
import tempfile
import threading
import unittest

import programs
import rospy
import rostest
from simulators import STEP_RATE, TICK, Heard, Simulator, forget_parameters, wait, wait_for_service
from tf2_msgs.msg import TFMessage
from tiers import thorough

PER_READING = STEP_RATE // 10  # ticks from one reading of the sensors to the next


def ticks_of(transforms):
    """The ticks of which a message of /tf has the pose by odometry."""
    return [each.header.stamp.to_nsec() // TICK for each in transforms.transforms
            if each.child_frame_id == 'base_footprint']


class SimulatorTimeTest(unittest.TestCase):
    """A simulator for each test, on the empty field."""

    def stepped(self, *arguments):
        """A paused simulator, and the ground truth of its robot at every tick."""
        simulator = Simulator(self, '_map:=field', '_speed:=10', '_rates/ground_truth:=50', *arguments)
        truth = Heard(self, '/rumba/ground_truth')
        truth.find()
        simulator.pause()
        return simulator, truth

    def test_the_clock_starts_above_zero_and_continues_after_a_reset(self):
        simulator = Simulator(self, '_map:=field', '_speed:=10')
        clock = Heard(self, '/clock')
        for _ in range(3):
            count = len(clock.messages)
            wait(self, lambda: len(clock.messages) > count + 20)  # noqa: B023 (called at once)
            simulator.does('reset')
        wait(self, lambda: len(clock.messages) > count + 40)
        times = [message.clock.to_nsec() for message in clock.messages]
        self.assertGreater(times[0], 0)
        self.assertEqual(times, sorted(set(times)))
        self.assertTrue(all(time % TICK == 0 for time in times))
        # Nodes that start later use that clock, until the simulator ends.
        self.assertTrue(rospy.get_param('/use_sim_time'))
        simulator.end()
        self.assertFalse(rospy.has_param('/use_sim_time'))

    def test_at_speed_0_the_clock_and_all_transforms_come_with_the_sensors(self):
        simulator = Simulator(self, '_map:=field', '_speed:=0')
        clock, tf = Heard(self, '/clock'), Heard(self, '/tf', TFMessage)
        wait(self, lambda: len(clock.messages) > 10 and len(tf.messages) > 10)
        simulator.pause()
        wait(self, lambda: ticks_of(tf.messages[-1])[-1] == simulator.ticks, 'the last transforms')
        told = [message.clock.to_nsec() // TICK for message in clock.messages]
        self.assertEqual({tick % PER_READING for tick in told if tick < simulator.ticks}, {1})
        numbers = [ticks_of(message) for message in tf.messages[1:]]
        self.assertEqual({len(each) for each in numbers[:-1]}, {PER_READING})
        self.assertEqual(sum(numbers, []), list(range(numbers[0][0], simulator.ticks + 1)))

    def test_while_paused_the_clock_is_published_and_nothing_else_happens(self):
        simulator, truth = self.stepped()
        for ticks in (0, 1_000_001, 2 ** 32 - 1):
            simulator.refuses(f'^ticks is {ticks}: must be 1 to 1000000$', 'step', ticks)
        simulator.does('pause')
        clock = Heard(self, '/clock')
        wait(self, lambda: len(clock.messages) >= 5)
        self.assertEqual({message.clock.to_nsec() for message in clock.messages}, {simulator.ticks * TICK})
        simulator.step()
        truth.at(simulator.ticks)
        self.assertEqual(truth.messages[-1].header.stamp.to_nsec(), simulator.ticks * TICK)
        for _ in range(2):
            simulator.does('resume')
        clock.find(lambda message: message.clock.to_nsec() > (simulator.ticks + 20) * TICK)
        simulator.refuses('^the simulation is running: pause it first$', 'step', 1)

    def test_a_step_is_exact_to_the_tick_and_the_robot_stops_without_commands(self):
        simulator, truth = self.stepped('_drive/command_timeout:=2')
        simulator.drive(0.3, 0.0, truth)
        clock = Heard(self, '/clock')
        before = simulator.ticks
        for ticks in (1, 1, 7, 50):
            simulator.step(ticks)
            now = clock.find(lambda message: message.clock.to_nsec() >= simulator.ticks * TICK)
            self.assertEqual(now.clock.to_nsec(), simulator.ticks * TICK)
            # 0.9 m/s^2 up to 0.3 m/s, in steps of a tick, from the middle of the field.
            passed = simulator.ticks - before + 1
            way = sum(min(0.3, 0.9 * tick / STEP_RATE) for tick in range(1, passed + 1)) / STEP_RATE
            place = truth.at(simulator.ticks).pose.pose.position
            self.assertAlmostEqual(place.x - 5.544444, way, delta=1e-9)
            self.assertAlmostEqual(place.y - 5.544444, 0.0, delta=1e-9)
        # The command holds for the 100 ticks of the timeout; from 0.3 m/s the robot stops in 16.7 ticks.
        simulator.step(100)
        speeds = [truth.at(before + tick).twist.twist.linear.x for tick in (99, 100, 115, 116)]
        self.assertEqual((speeds[0], speeds[3]), (0.3, 0.0))
        self.assertAlmostEqual(speeds[1], 0.3 - 0.018, delta=1e-9)
        self.assertGreater(speeds[2], 0.0)

    def test_no_message_of_a_step_of_a_hundred_ticks_is_lost(self):
        simulator, truth = self.stepped()
        truth.messages.clear()
        first = simulator.ticks
        simulator.step(100)
        truth.at(simulator.ticks)
        self.assertEqual([message.header.stamp.to_nsec() // TICK for message in truth.messages][-100:],
                         list(range(first + 1, simulator.ticks + 1)))

    def test_a_long_step_delays_neither_the_state_nor_the_end(self):
        simulator = Simulator(self, '_map:=field', '_speed:=10')
        state = Heard(self, '/simulator/state')
        simulator.pause()

        def step():
            try:
                simulator.call('step', 1_000_000)
            except rospy.ServiceException:
                pass
        thread = threading.Thread(target=step)
        thread.start()
        state.find(lambda message: message.is_paused and message.tick > simulator.ticks + 100)
        simulator.end()
        thread.join()

    def test_reset_restores_everything_except_the_time(self):
        simulator, truth = self.stepped('_brushes_up:=true', '_percentage:=50', '_battery/drain:=100',
                                        '_rates/sensors:=50')
        state, status = Heard(self, '/rumba/battery_state'), Heard(self, '/rumba/battery_status')
        simulator.drive(0.3, 0.5, truth)
        simulator.step(100)
        before = simulator.ticks
        self.assertGreater(abs(truth.at(before).pose.pose.position.x - 5.544444), 0.01)
        wait(self, lambda: state.messages and state.messages[-1].percentage < 0.499)
        simulator.does('rumba/set_brushes_up', False)
        simulator.does('reset')
        simulator.step()
        self.assertEqual(simulator.ticks, before + 1)
        begun = truth.at(simulator.ticks)
        self.assertAlmostEqual(begun.pose.pose.position.x, 5.544444)
        self.assertEqual((begun.pose.pose.orientation.z, begun.twist.twist.linear.x), (0.0, 0.0))
        self.assertAlmostEqual(state.at(simulator.ticks).percentage, 0.5, delta=1e-3)
        wait(self, lambda: status.messages[-1].brushes_up, 'the brushes')

    def test_in_real_time_there_is_no_clock_and_stamps_are_wall_time(self):
        Simulator(self, '_map:=field')
        before = rospy.Time.now()
        odom = Heard(self, '/rumba/odom').find()
        self.assertLessEqual(before, odom.header.stamp)
        self.assertLessEqual(odom.header.stamp, rospy.Time.now())
        self.assertNotIn('/clock', dict(rospy.get_published_topics()))
        self.assertFalse(rospy.has_param('/use_sim_time'))

    def test_at_speed_1_there_is_a_clock_if_use_sim_time_is_true(self):
        rospy.set_param('/use_sim_time', True)
        self.addCleanup(rospy.delete_param, '/use_sim_time')
        simulator = Simulator(self, '_map:=field')
        Heard(self, '/clock').find(lambda message: message.clock.to_sec() > 0.5)
        simulator.end()
        self.assertTrue(rospy.get_param('/use_sim_time'))

    def test_use_sim_time_is_afterwards_as_it_was_before_also_if_a_simulator_was_killed(self):
        self.addCleanup(forget_parameters, '/use_sim_time')
        for found in (True, False):
            forget_parameters('/use_sim_time')
            if found:
                rospy.set_param('/use_sim_time', True)
            Simulator(self, '_map:=field', '_speed:=10').end()
            self.assertEqual(rospy.get_param('/use_sim_time', False), found)
            Simulator(self, '_map:=field', '_speed:=10').kill()
            self.assertTrue(rospy.get_param('/use_sim_time'))
            with tempfile.TemporaryDirectory() as folder:  # /rosout loses what a node says before others hear it
                again = Simulator(self, '_map:=field', environment={**os.environ, 'ROS_LOG_DIR': folder})
                log = wait(self, lambda: pathlib.Path(folder, 'simulator.log').read_text(), 'the log')
            self.assertRegex(log, f'an earlier simulator was killed.* it is {str(found).lower()} again')
            self.assertEqual(rospy.get_param('/use_sim_time', False), found)
            again.end()

    @thorough
    def test_simulator_launch_leaves_use_sim_time_as_it_was(self):
        self.addCleanup(forget_parameters, '/use_sim_time')
        for found, speed in ((True, 1), (True, 10), (False, 10), (False, 1)):
            forget_parameters('/use_sim_time')
            if found:
                rospy.set_param('/use_sim_time', True)
            forget_parameters()
            launch = subprocess.Popen(['roslaunch', 'rumba_sim', 'simulator.launch', 'map:=field',
                                       f'speed:={speed}'], stdout=subprocess.DEVNULL)
            self.addCleanup(launch.wait)
            self.addCleanup(launch.terminate)
            wait_for_service(self, '/simulator/tuning/set_parameters', launch)
            self.assertEqual(rospy.get_param('/use_sim_time'), found or speed != 1)
            launch.terminate()
            launch.wait()
            self.assertEqual(rospy.get_param('/use_sim_time', False), found)

    def test_a_node_that_waits_for_a_clock_that_nobody_publishes_says_so(self):
        rospy.set_param('/use_sim_time', True)
        self.addCleanup(rospy.delete_param, '/use_sim_time')
        node = programs.start('rumba_sim', 'battery_status_publisher', stderr=subprocess.PIPE, universal_newlines=True)
        self.addCleanup(node.communicate)
        self.addCleanup(node.terminate)
        self.assertIn('/use_sim_time is true, but nothing publishes /clock: for this node, time stands still. Start a '
                      'simulator; or run `rosparam delete /use_sim_time`', node.stderr.readline())


if __name__ == '__main__':
    rospy.init_node('test_simulator_time')
    rostest.rosrun('rumba_sim', 'simulator_time', SimulatorTimeTest)
