#!/usr/bin/env python3
"""Settings that change at run time, and the diagnostics of the simulator."""

import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from dynamic_reconfigure.client import Client
from simulators import Heard, Simulator, wait


class SimulatorTuningTest(unittest.TestCase):
    """A simulator for each test, on the empty field."""

    def client(self):
        """A client of dynamic_reconfigure, as in rqt_reconfigure."""
        client = Client('/simulator/tuning', timeout=30.0)
        self.addCleanup(client.close)
        return client

    def test_drain_noise_rates_timeout_and_speed_change_at_run_time(self):
        simulator = Simulator(self, '_map:=field', '_speed:=10', '_rates/sensors:=50', '_rates/ground_truth:=50')
        client = self.client()
        before = client.get_configuration()
        self.assertEqual((before['battery_drain'], before['rates_scan'], before['speed']), (1.0, 10, 10.0))
        battery, scan = Heard(self, '/rumba/battery_state'), Heard(self, '/rumba/scan')
        truth = Heard(self, '/rumba/ground_truth')
        truth.find()
        changed = client.update_configuration({'battery_drain': 1000.0, 'laser_noise': 0.0, 'rates_scan': 50,
                                               'drive_command_timeout': 0.1})
        self.assertEqual((changed['battery_drain'], changed['rates_scan'], changed['rates_odom']), (1000.0, 50, 50))
        simulator.pause()
        first = simulator.ticks
        simulator.step(100)
        drained = battery.at(first).charge - battery.at(first + 100).charge
        self.assertAlmostEqual(drained, 0.69 * 1000.0 * 2.0 / 3600.0, delta=1e-4)
        self.assertEqual(scan.at(first + 57).ranges, scan.at(first + 58).ranges)
        simulator.drive(0.0, 1.0, truth)
        begin = simulator.ticks
        simulator.step(20)
        rates = [truth.at(begin + tick).twist.twist.angular.z for tick in range(20)]
        # After 5 ticks without a command it slows down.
        self.assertEqual(rates.index(max(rates)), 4)
        simulator.does('resume')
        client.update_configuration({'speed': 0.5})
        told = Heard(self, '/diagnostics', DiagnosticArray)
        told.find(lambda message: any(value.key == 'wanted speed [times real time]' and value.value == '0.5'
                                      for status in message.status for value in status.values))

    def test_a_rate_that_does_not_divide_the_step_rate_is_refused_and_the_old_one_stays(self):
        simulator = Simulator(self, '_map:=field', '_speed:=10')
        client, log = self.client(), Heard(self, '/rosout')
        now = client.update_configuration({'rates_scan': 15, 'battery_drain': 7.0})
        self.assertEqual((now['rates_scan'], now['battery_drain']), (10, 1.0))
        self.assertIn('tuning: rates/scan is 15: must divide step_rate, 50: one of 0, 1, 2, 5, 10, 25, 50',
                      log.find(lambda message: 'rates/scan' in message.msg).msg)
        now = client.update_configuration({'rates_scan': 25})
        self.assertEqual(now['rates_scan'], 25)
        simulator.end()
        client.close()  # or rospy may connect to the new node before that says that its topics are latched
        # A new node with the same name at the same master uses none of these values.
        Simulator(self, '_speed:=1', forget=False)
        again = self.client()
        self.assertEqual(again.get_configuration()['rates_scan'], 10)
        # In real time, the speed is 1.
        now = again.update_configuration({'speed': 3.0})
        self.assertEqual(now['speed'], 1.0)
        log.find(lambda message: message.msg.startswith('speed can change only if /clock is published'))

    def test_a_new_speed_counts_at_once_and_one_that_is_too_low_is_refused(self):
        Simulator(self, '_map:=field', '_speed:=0.001')
        client, clock, log = self.client(), Heard(self, '/clock'), Heard(self, '/rosout')
        for speed in (0.0005, 5e-324):
            self.assertEqual(client.update_configuration({'speed': speed})['speed'], 0.001)
            log.find(lambda message: message.msg == f'tuning: speed is {speed:g}: must be 0, or 0.001 to '  # noqa: B023
                                                    '1000000')
        client.update_configuration({'speed': 10.0})
        begin = time.monotonic()
        clock.find(lambda message: message.clock.to_sec() > 1.0)
        self.assertLess(time.monotonic() - begin, 15.0)  # at speed 0.001 a tick takes 20 s

    def test_diagnostics_have_the_time_of_the_simulation(self):
        Simulator(self, '_map:=field', '_speed:=10')
        stamp = Heard(self, '/diagnostics', DiagnosticArray).find().header.stamp.to_sec()
        self.assertGreater(stamp, 0.0)
        self.assertLess(stamp, 1e6)

    def test_diagnostics_describe_battery_and_speed(self):
        Simulator(self, '_map:=field', '_speed:=4', '_percentage:=5', '_battery/drain:=0')
        told = Heard(self, '/diagnostics', DiagnosticArray)

        def status(name):
            return next((status for message in reversed(told.messages[:]) for status in message.status
                         if status.name == name), None)
        battery = wait(self, lambda: status('simulator: battery of rumba'))
        self.assertEqual((battery.level, battery.message, battery.hardware_id),
                         (DiagnosticStatus.WARN if isinstance(battery.level, bytes) else 1, 'low: 5 %', 'field'))

        def achieved():
            found = status('simulator: simulation')
            values = {value.key: value.value for value in found.values} if found else {}
            return abs(float(values.get('speed [times real time]', 0.0)) - 4.0) < 0.2 and values
        values = wait(self, achieved)
        self.assertEqual(values['wanted speed [times real time]'], '4')


if __name__ == '__main__':
    rospy.init_node('test_simulator_tuning')
    rostest.rosrun('rumba_sim', 'simulator_tuning', SimulatorTuningTest)
