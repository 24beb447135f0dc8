#!/usr/bin/env python3
"""A robot for the tests of the trial ground, with one planted fault: it dies, leaks, hangs, forgets or prints too much.

`frail_node.py FAULT` has the fault after the hundredth message on /rumba/cmd_vel.
"""

import os

import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState

from rumba_msg.msg import CleaningStatus, GoToActionGoal, GoToActionResult, MissionStatus, SimulatorState

PERIOD = 0.02  # [s]
ENOUGH = 100  # messages
LEAKED = 200  # files


class FrailNode:
    """Publishes what the oracles ask for."""

    def __init__(self, fault):
        """Have a fault, in one word; `none` is none."""
        self._fault, self._has_it, self._messages, self._leak = fault, False, 0, []
        self._publishers = {
            name: rospy.Publisher(f'/rumba/{name}', kind, queue_size=100)
            for name, kind in (('ground_truth', Odometry), ('battery_state', BatteryState),
                               ('cleaning_status', CleaningStatus), ('go_to/result', GoToActionResult))}
        self._mission = rospy.Publisher('/rumba/mission_status', MissionStatus, queue_size=1, latch=True)
        self._mission.publish(MissionStatus(state=MissionStatus.CLEANING))
        self._state = rospy.Publisher('/simulator/state', SimulatorState, queue_size=1)
        rospy.Subscriber('/rumba/cmd_vel', Twist, self._on_twist)
        rospy.Subscriber('/rumba/go_to/goal', GoToActionGoal, self._on_goal)

    def _on_twist(self, _):
        self._messages += 1
        if self._messages != ENOUGH:
            return
        self._has_it = self._fault != 'none'
        if self._fault == 'dies':
            os._exit(0)
        elif self._fault == 'leaks':
            self._leak = [open(os.devnull) for _ in range(LEAKED)]
        elif self._fault == 'raises':
            raise ValueError('a planted fault')

    def _on_goal(self, message):
        if not (self._has_it and self._fault == 'hangs'):
            result = GoToActionResult()
            result.status.goal_id = message.goal_id
            self._publishers['go_to/result'].publish(result)

    def run(self):
        """Live."""
        tick = 0
        while not rospy.is_shutdown():
            is_lost = self._has_it and self._fault == 'forgets'
            tick += not (self._has_it and self._fault == 'stops')
            self._state.publish(SimulatorState(tick=tick, step_rate=50.0, speed=1.0))
            self._publishers['ground_truth'].publish(Odometry())
            self._publishers['battery_state'].publish(BatteryState(charge=0.1 if is_lost else 2.0, capacity=2.7))
            self._publishers['cleaning_status'].publish(CleaningStatus(coverage=0.5))
            rospy.rostime.wallsleep(PERIOD)


if __name__ == '__main__':
    rospy.init_node('frail')
    FrailNode(rospy.myargv()[1]).run()
