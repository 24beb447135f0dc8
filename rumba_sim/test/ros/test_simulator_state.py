#!/usr/bin/env python3
"""The state of a simulator, and its settings, whatever the node is called and wherever it was started."""

import os
import signal
import subprocess
import unittest

import rospy
import rostest
from dynamic_reconfigure.client import Client
from simulators import ENDS_WITHIN, ROOM, TIMEOUT, Heard, Simulator, folder_of, forget_parameters, lookup, wait

from rumba_msg.msg import SimulatorState
from rumba_sim.ros.participants.simulator_client import SimulatorClient, robot_config

FILES = {**ROOM, 'robot.yaml': b'drive: {radius: 0.2, max_speed: 0.4}\nspeed: 3.0\n'}


class SimulatorStateTest(unittest.TestCase):
    """A simulator for each test."""

    def tune(self, **values):
        """Change settings as rqt_reconfigure does."""
        client = Client('/simulator/tuning', timeout=TIMEOUT)
        self.addCleanup(client.close)
        client.update_configuration(values)

    def test_each_change_is_published_at_once(self):
        simulator = Simulator(self, '_map:=field', '_speed:=10', '_seed:=7')
        state = Heard(self, '/simulator/state')
        first = state.find()
        self.assertEqual((first.node, first.is_paused, first.speed, first.is_time_simulated, first.step_rate,
                          first.seed), ('/simulator', False, 10.0, True, 50.0, 7))
        self.assertTrue(os.path.isabs(first.map) and first.map.endswith('/rumba_sim/maps/field.yaml'), first.map)
        state.messages.clear()
        for _ in range(5):  # too fast for what is published once a second
            simulator.does('pause')
            simulator.does('resume')

        def changes():
            pauses = [message.is_paused for message in state.messages]
            return [now for before, now in zip([False, *pauses], pauses) if now != before]
        wait(self, lambda: len(changes()) >= 10, 'all changes')
        self.assertEqual(changes(), [True, False] * 5)
        self.tune(speed=4.0, battery_drain=7.0)
        state.find(lambda message: message.speed == 4.0)
        self.assertEqual(rospy.get_param('/simulator/settings/speed'), 4.0)
        self.assertEqual(robot_config('/simulator').battery.drain, 7.0)

    def test_it_is_published_once_a_second_and_tells_how_fast_time_passes(self):
        simulator = Simulator(self, '_map:=field', '_speed:=10')
        state = Heard(self, '/simulator/state')
        state.find(lambda message: 8.0 < message.real_time_factor < 10.5)
        simulator.pause()
        state.find(lambda message: message.is_paused and message.real_time_factor == 0.0)
        state.messages.clear()
        begin = rospy.get_time()
        wait(self, lambda: len(state.messages) >= 3)
        self.assertGreater(rospy.get_time() - begin, 1.5)
        self.assertEqual({(message.tick, message.header.stamp.to_nsec()) for message in state.messages},
                         {(simulator.ticks, simulator.ticks * 20_000_000)})
        simulator.step(7)
        state.find(lambda message: message.tick == simulator.ticks)
        simulator.does('reset')  # ticks count on
        simulator.step()
        state.find(lambda message: message.tick == simulator.ticks)

    def test_at_a_slow_speed_it_is_published_as_often_and_the_end_comes_as_soon(self):
        simulator = Simulator(self, '_map:=field', '_speed:=0.001')
        state = Heard(self, '/simulator/state')
        wait(self, lambda: len(state.messages) >= 4)
        self.assertLess(state.messages[-1].tick - state.messages[0].tick, 2)
        begin = rospy.get_time()
        simulator.end()
        self.assertLess(rospy.get_time() - begin, ENDS_WITHIN)

    def test_whoever_listens_late_gets_the_newest_state(self):
        simulator = Simulator(self, '_map:=field')
        simulator.does('pause')
        state = Heard(self, '/simulator/state').find()
        self.assertEqual(state._connection_header['latching'], '1')
        self.assertTrue(state.is_paused)
        self.assertEqual((state.speed, state.is_time_simulated), (1.0, False))
        self.assertAlmostEqual(state.header.stamp.to_sec(), rospy.get_time(), delta=TIMEOUT)

    def test_a_node_of_another_name_is_found_by_its_state(self):
        simulator = Simulator(self, '__name:=sim2', '_map:=field', '_drive/max_speed:=0.3', node='/sim2')
        client = SimulatorClient()
        self.addCleanup(client.close)
        state = client.wait(TIMEOUT)
        self.assertEqual(state.node, '/sim2')
        self.assertEqual(robot_config(state.node).drive.max_speed, 0.3)
        simulator.does('pause')
        wait(self, lambda: client.state.is_paused)

    def test_in_a_namespace_the_topic_is_there_too(self):
        Simulator(self, '__ns:=/upstairs', '_map:=field', node='/upstairs/simulator')
        state = Heard(self, '/upstairs/simulator/state').find()
        self.assertEqual(state.node, '/upstairs/simulator')
        self.assertEqual(robot_config(state.node), robot_config('/nobody'))
        self.assertNotIn('/simulator/state', dict(rospy.get_published_topics()))

    def test_paths_may_be_relative_and_parameters_override_the_file(self):
        folder = folder_of(self, FILES)
        Simulator(self, '_map:=room.yaml', '_config:=robot.yaml', '_drive/max_speed:=0.3', folder=folder)
        state = Heard(self, '/simulator/state').find()
        self.assertEqual((state.map, state.speed), (f'{folder}/room.yaml', 3.0))
        drive = robot_config(state.node).drive
        self.assertEqual((drive.radius, drive.max_speed), (0.2, 0.3))

    def test_with_roslaunch_paths_may_be_relative_too(self):
        folder = folder_of(self, FILES)
        forget_parameters()
        command = ['roslaunch', 'rumba_sim', 'simulator.launch', 'map:=room.yaml', 'config:=robot.yaml']
        environment = {**os.environ, 'PWD': str(folder)}
        launch = subprocess.Popen(command, cwd=folder, env=environment, stdout=subprocess.DEVNULL)
        self.addCleanup(launch.wait)
        self.addCleanup(launch.terminate)
        state = Heard(self, '/simulator/state').find()
        self.assertEqual(state.map, f'{folder}/room.yaml')
        self.assertEqual(robot_config(state.node).drive.radius, 0.2)

    def test_what_a_killed_simulator_left_is_not_taken_for_settings_of_the_user(self):
        killed = Simulator(self, '_map:=field', '_speed:=10')
        self.tune(speed=4.0, battery_drain=7.0)
        wait(self, lambda: rospy.get_param('/simulator/settings/battery/drain') == 7.0)
        killed.process.send_signal(signal.SIGKILL)
        self.assertEqual(killed.process.wait(TIMEOUT), -signal.SIGKILL)
        rospy.set_param('/simulator/settings/rubbish', 1)
        begun = []
        late = rospy.Subscriber('/simulator/state', SimulatorState, begun.append)
        self.addCleanup(late.unregister)
        self.assertEqual(lookup('/simulator/tuning/set_parameters') is None, False)
        Simulator(self, '_map:=studio', forget=False)
        state = wait(self, lambda: begun and begun[0])
        self.assertTrue(state.map.endswith('/studio.yaml'))
        self.assertEqual(state.speed, 10.0)  # a parameter that was given stays, as always in ROS
        self.assertEqual(robot_config('/simulator').battery.drain, 1.0)
        self.assertFalse(rospy.has_param('/simulator/settings/rubbish'))


if __name__ == '__main__':
    rospy.init_node('test_simulator_state', disable_rostime=True)
    rostest.rosrun('rumba_sim', 'simulator_state', SimulatorStateTest)
