#!/usr/bin/env python3
"""A sensor publishes the values of its parameters; the subscriber logs good and bad readings at different levels."""

import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Log

from thermometer.msg import Reading

TIMEOUT = 30.0
SAID = [  # temperature [degC], and what the subscriber logs
    (30.0, Log.INFO, 'sensor 3, hall: 30.0 degC'),
    (30.5, Log.WARN, 'sensor 3, hall: 30.5 degC, more than 30.0'),
    (float('nan'), Log.ERROR, 'sensor 3, hall: failed'),
]


class ThermometerTest(unittest.TestCase):
    """A sensor named oven on a topic of its own, and a subscriber with a limit of 30 degC."""

    def test_publisher(self):
        readings = [rospy.wait_for_message('oven', Reading, TIMEOUT) for _ in range(2)]
        for reading in readings:
            self.assertEqual((reading.id, reading.name), (7, 'oven'))
            self.assertAlmostEqual(reading.temperature, 80.0, delta=1.0)  # ten standard deviations
        self.assertNotEqual(readings[0].temperature, readings[1].temperature)
        self.assertGreater(readings[1].header.stamp, readings[0].header.stamp)

    def test_subscriber(self):
        said = set()
        log = rospy.Subscriber('/rosout', Log, lambda entry: said.add((entry.level, entry.msg)))
        publisher = rospy.Publisher('sensor_topic', Reading, queue_size=10)
        end = rospy.get_time() + TIMEOUT
        while not {(level, line) for _, level, line in SAID} <= said:
            self.assertLess(rospy.get_time(), end, said)
            for temperature, *_ in SAID:
                publisher.publish(Reading(id=3, name='hall', temperature=temperature))
            rospy.sleep(0.05)
        log.unregister()
        self.assertEqual(sum('sensor 3' in line for _, line in said), len(SAID))


if __name__ == '__main__':
    rospy.init_node('test_thermometer')
    rostest.rosrun('thermometer', 'thermometer', ThermometerTest)
