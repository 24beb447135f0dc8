#!/usr/bin/env python3
"""The content of the simulator's messages: units, signs, ranges, stamps and frames follow the conventions of ROS."""

import math
import unittest

import rospy
import rostest
from sensor_msgs.msg import BatteryState
from simulators import TICK, Heard, Simulator
from tf2_msgs.msg import TFMessage

HALF = 0.5 * math.pi
RATES = {'odom': 50.0, 'scan': 10.0, 'battery_status': 5.0, 'cleaning_status': 1.0}  # [Hz]


class SimulatorTopicsTest(unittest.TestCase):
    """A simulator for each test."""

    def measure_rates(self, seconds, *arguments):
        """The shares of RATES at which topics come for some seconds of the stamps of odometry."""
        Simulator(self, '_map:=field', *arguments)
        heard = {topic: Heard(self, f'/rumba/{topic}') for topic in RATES}
        for each in heard.values():
            each.find()
        begin = heard['odom'].fresh().header.stamp
        for each in heard.values():
            each.messages.clear()
        end = heard['odom'].last(lambda message: (message.header.stamp - begin).to_sec() >= seconds).header.stamp
        return {topic: len(each.messages) / (end - begin).to_sec() / RATES[topic] for topic, each in heard.items()}

    def test_topics_come_at_their_rates_of_simulated_time(self):
        for topic, share in self.measure_rates(30.0, '_speed:=10').items():
            self.assertAlmostEqual(share, 1.0, delta=0.1, msg=topic)

    def test_topics_come_at_their_rates_in_real_time(self):
        """What a busy machine makes late is left out, so the bounds are wide."""
        for topic, share in self.measure_rates(4.0).items():
            self.assertAlmostEqual(share, 1.0, delta=0.3, msg=topic)

    def test_the_battery_follows_the_conventions(self):
        simulator = Simulator(self, '_map:=studio', '_speed:=10', '_percentage:=97', '_battery/drain:=500',
                              '_rates/battery:=50')
        battery = Heard(self, '/rumba/battery_state')
        battery.find(lambda state: state.percentage == 1.0)
        battery.messages.clear()
        simulator.does('reset')
        charging = battery.find(lambda state: state.percentage < 1.0)
        self.assertEqual(charging.power_supply_status, BatteryState.POWER_SUPPLY_STATUS_CHARGING)
        self.assertGreater(charging.current, 0.0)
        self.assertTrue(0.97 <= charging.percentage < 1.0)
        # One of before the reset may still have been on its way.
        full = battery.find(lambda state: state.percentage == 1.0 and state.header.stamp > charging.header.stamp)
        self.assertEqual(full.power_supply_status, BatteryState.POWER_SUPPLY_STATUS_FULL)
        status = Heard(self, '/rumba/battery_status')  # before it leaves the dock: in seconds it will be empty
        simulator.teleport(1.5, 2.5, 0.0)
        drained = battery.fresh(lambda state: state.percentage < 0.99)
        self.assertEqual(drained.power_supply_status, BatteryState.POWER_SUPPLY_STATUS_DISCHARGING)
        # Idle and brushes.
        self.assertAlmostEqual(drained.current, -0.69, places=6)
        self.assertAlmostEqual(drained.charge, 2.7 * drained.percentage, places=5)
        for state in (charging, full, drained):
            self.assertAlmostEqual(state.capacity, 2.7, places=6)
            self.assertAlmostEqual(state.design_capacity, 2.7, places=6)
            self.assertTrue(14.0 < state.voltage < 18.0)
            self.assertTrue(state.present)
            self.assertEqual(state.power_supply_technology, BatteryState.POWER_SUPPLY_TECHNOLOGY_NIMH)
            self.assertEqual(state.power_supply_health, BatteryState.POWER_SUPPLY_HEALTH_GOOD)
            self.assertEqual(len(state.cell_voltage), 12)
            # Other versions of the message have other fields.
            for name in ('cell_voltage', 'temperature', 'cell_temperature'):
                value = getattr(state, name, math.nan)
                self.assertTrue(all(map(math.isnan, value if isinstance(value, (list, tuple)) else [value])), name)
        simulator.does('rumba/set_brushes_up', True)
        up = status.fresh(lambda message: message.brushes_up)
        self.assertEqual((up.location_x, up.location_y, up.orientation_theta), (1.5, 2.5, 0.0))
        self.assertLess(up.percentage_battery, 100.0 * drained.percentage + 1.0)
        self.assertGreater(up.percentage_battery, 0.0)
        self.assertRegex(up.debug_message, r'^1\d\.\d V, 0\.19 A, discharging$')

    def test_the_laser_follows_the_conventions_and_is_not_mirrored(self):
        """There are walls 3 m behind the robot and 2 m to its right, but none within 8 m ahead and to the left."""
        simulator = Simulator(self, '_map:=field', '_speed:=10', '_laser/noise:=0')
        simulator.teleport(3.0, 2.0, 0.0)
        heard = Heard(self, '/rumba/scan')
        scan = heard.fresh()
        scan = heard.fresh()
        self.assertEqual(len(scan.ranges), 360)
        self.assertAlmostEqual(scan.angle_min, -math.pi, places=6)
        self.assertAlmostEqual(scan.angle_max, scan.angle_min + 359 * scan.angle_increment, places=5)
        self.assertAlmostEqual(scan.angle_increment, math.radians(1.0), places=7)
        self.assertEqual((scan.time_increment, round(scan.scan_time, 6)), (0.0, 0.1))
        self.assertEqual((round(scan.range_min, 6), scan.range_max, list(scan.intensities)), (0.12, 8.0, []))

        def seen(angle):
            return scan.ranges[round((angle - scan.angle_min) / scan.angle_increment) % 360]
        self.assertAlmostEqual(seen(-math.pi), 3.0, delta=1e-3)
        self.assertAlmostEqual(seen(-HALF), 2.0, delta=1e-3)
        self.assertAlmostEqual(seen(-0.25 * math.pi), 2.0 * math.sqrt(2.0), delta=1e-3)
        self.assertEqual((seen(0.0), seen(HALF)), (math.inf, math.inf))
        simulator.teleport(3.0, 2.0, HALF)
        turned = heard.fresh(lambda message: abs(message.ranges[0] - 2.0) < 1e-3)
        self.assertAlmostEqual(turned.ranges[270], 3.0, delta=1e-3)

    def test_a_laser_of_another_model_is_where_it_is_mounted_and_tells_what_its_driver_does(self):
        """It looks back, upside down, from 0.1 m ahead of the centre: the wall behind is 3.1 m away, at its angle 0."""
        simulator = Simulator(self, '_map:=field', '_speed:=10', '_laser/model:=lds01', '_laser/noise:=0',
                              '_laser/relative_noise:=0', '_laser/relative_bias:=0', '_laser/bias:=0',
                              '_laser/dropouts:=0', '_laser/x:=0.1', f'_laser/yaw:={math.pi}',
                              '_laser/upside_down:=true')
        parts = Heard(self, '/tf_static', TFMessage)
        simulator.teleport(3.0, 2.0, 0.0)
        heard = Heard(self, '/rumba/scan')
        heard.fresh()
        scan, next_scan = heard.fresh(), heard.fresh()
        self.assertAlmostEqual((next_scan.header.stamp - scan.header.stamp).to_sec(), 0.2, places=6)
        self.assertAlmostEqual(scan.scan_time, 0.2, places=6)
        self.assertEqual((len(scan.ranges), scan.angle_min, scan.range_max), (360, 0.0, 3.5))
        self.assertAlmostEqual(scan.angle_max, math.radians(359.0), places=5)
        self.assertAlmostEqual(scan.ranges[0], 3.1, delta=2e-3)
        self.assertAlmostEqual(scan.ranges[90], 0.0)  # to the left of the robot, nothing is within 3.5 m
        self.assertAlmostEqual(scan.ranges[270], 2.0, delta=2e-3)
        mounted = next(part.transform for message in parts.messages for part in message.transforms
                       if part.child_frame_id == 'laser')
        turn = mounted.rotation
        self.assertAlmostEqual(mounted.translation.x, 0.1)
        for value, wanted in zip((turn.x, turn.y, turn.z, turn.w), (0.0, 1.0, 0.0, 0.0)):
            self.assertAlmostEqual(value, wanted)

    def test_messages_of_one_tick_have_the_same_stamp_and_frames_without_a_prefix(self):
        simulator = Simulator(self, '_map:=studio', '_speed:=10')
        topics = ['odom', 'ground_truth', 'scan', 'battery_state', 'bumper', 'cliff', 'dock_status', 'cleaning_status',
                  'coverage']
        heard = {topic: Heard(self, f'/rumba/{topic}') for topic in topics}
        transforms = Heard(self, '/tf', TFMessage)
        for topic in topics:
            heard[topic].find()
        transforms.find()
        simulator.pause()
        simulator.step(100)
        # Messages of all rates are due at the first tick, and after each full second.
        second = (simulator.ticks - 1) // 50 * 50 + 1
        bases = {topic: heard[topic].at(second).header.frame_id for topic in topics}
        self.assertEqual(bases, {
            'odom': 'odom', 'ground_truth': 'map', 'scan': 'laser', 'battery_state': 'base_link', 'bumper': 'base_link',
            'cliff': 'base_link', 'dock_status': 'base_link', 'cleaning_status': 'map', 'coverage': 'map'})
        told = transforms.find(lambda message: message.transforms[0].header.stamp.to_nsec() == second * TICK)
        self.assertEqual({(part.header.frame_id, part.child_frame_id, part.header.stamp.to_nsec())
                          for part in told.transforms},
                         {('odom', 'base_footprint', second * TICK), ('map', 'odom', second * TICK)})
        self.assertEqual({heard[topic].at(second).child_frame_id for topic in ('odom', 'ground_truth')},
                         {'base_footprint'})
        # The stamps of two seconds of ticks fit each rate.
        for topic, rate in (('odom', 50), ('ground_truth', 10), ('scan', 10), ('battery_state', 10), ('bumper', 10),
                            ('cliff', 10), ('dock_status', 10), ('cleaning_status', 1)):
            heard[topic].at((simulator.ticks - 1) // (50 // rate) * (50 // rate) + 1)
            stamps = [message.header.stamp.to_nsec() for message in heard[topic].messages]
            self.assertEqual(stamps[-2 * rate:], [stamps[-1] - back * 1_000_000_000 // rate
                                                  for back in reversed(range(2 * rate))], topic)

    def test_the_map_is_published_and_served_with_the_first_stamp(self):
        simulator = Simulator(self, '_map:=studio', '_speed:=10')
        told, served = Heard(self, '/map').find(), simulator.call('static_map').map
        self.assertEqual(told, served)
        self.assertEqual((told.header.frame_id, told.info.resolution), ('map', served.info.resolution))
        self.assertEqual(len(told.data), told.info.width * told.info.height)
        self.assertEqual(set(told.data) - {-1}, {0, 100})
        self.assertEqual(told.header.stamp.to_nsec(), TICK)
        # While nothing happens, a new subscriber gets the present coverage.
        simulator.pause()
        grid = Heard(self, '/rumba/coverage').find()
        self.assertEqual((grid.info.width, grid.info.height), (told.info.width, told.info.height))
        self.assertLessEqual(grid.header.stamp.to_nsec(), simulator.ticks * TICK)

    def test_the_bumper_distinguishes_left_from_right_and_so_does_the_status(self):
        simulator = Simulator(self, '_map:=field', '_speed:=10', '_rates/sensors:=50')
        bumper, status = Heard(self, '/rumba/bumper'), Heard(self, '/rumba/battery_status')
        # The robot looks along x, slightly toward the wall at y = 0: the wall is on its right.
        for heading, left, right in ((-0.6, False, True), (-HALF, True, True), (math.pi + 0.6, True, False)):
            simulator.teleport(4.0, 0.175, heading)
            pressed = bumper.fresh(lambda message: message.is_left_pressed or message.is_right_pressed)
            pressed = bumper.fresh(lambda message: message.is_left_pressed or message.is_right_pressed)
            self.assertEqual((pressed.is_left_pressed, pressed.is_right_pressed), (left, right), heading)
        status.fresh(lambda message: message.debug_message == 'bumper pressed left')


if __name__ == '__main__':
    rospy.init_node('test_simulator_topics')
    rostest.rosrun('rumba_sim', 'simulator_topics', SimulatorTopicsTest)
