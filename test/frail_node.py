#!/usr/bin/env python3
"""A robot for the tests of the trial ground, with one planted fault: it dies, leaks, hangs, forgets or prints too much.

`frail_node.py FAULT` has the fault after the hundredth message on /rumba/cmd_vel. A fault that begins with `drips-`
leaves something behind with each goal, from the start on.
"""

import math
import os
import signal
import socket
import threading
import time

import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState

from rumba_msg.msg import CleaningStatus, GoToActionGoal, GoToActionResult, MissionStatus, SimulatorState

PERIOD = 0.02  # [s]
ENOUGH = 100  # messages
LEAKED = 200  # files, and twice as many sockets and threads
DRIPS = {  # what a goal leaves behind
    'drips-files': lambda: open(os.devnull), 'drips-sockets': socket.socket,
    'drips-threads': lambda: threading.Thread(target=time.sleep, args=[1e6], daemon=True).start(),
    'drips-memory': lambda: os.urandom(20_000)}
ODD = {  # fields of messages that cannot be true
    'below-zero': {'charge': -0.1}, 'overfull': {'charge': 2.8}, 'no-number': {'charge': math.nan},
    'too-clean': {'coverage': 1.1}, 'backwards': {'distance': -1.0}}


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
        elif self._fault == 'leaks-threads':
            for _ in range(LEAKED):
                DRIPS['drips-threads']()
        elif self._fault == 'leaks-memory':
            self._leak = 350 * 2 ** 20 * b'x'
        elif self._fault == 'raises':
            raise ValueError('a planted fault')
        elif self._fault == 'floods':
            print('\n'.join(100_000 * ['a planted fault']), flush=True)
        elif self._fault == 'long-line':
            print(5_000 * 'y', flush=True)
        elif self._fault == 'escape':
            print('\x1b[2J', flush=True)
        elif self._fault == 'silent':
            os.kill(os.getpid(), signal.SIGSTOP)

    def _on_goal(self, message):
        if self._fault in DRIPS:
            self._leak.append(DRIPS[self._fault]())
        if not (self._has_it and self._fault == 'hangs'):
            result = GoToActionResult()
            result.status.goal_id = message.goal_id
            self._publishers['go_to/result'].publish(result)

    def _pose(self):
        message = Odometry()
        message.pose.pose.position.x = math.inf if self._has_it and self._fault == 'nowhere' else 1.0
        return message

    def run(self):
        """Live."""
        tick = 0
        while not rospy.is_shutdown():
            is_lost = self._has_it and self._fault == 'forgets'
            tick += not (self._has_it and self._fault == 'stops')
            odd = ODD.get(self._fault, {}) if self._has_it else {}
            self._state.publish(SimulatorState(tick=tick, step_rate=50.0, speed=1.0))
            self._publishers['ground_truth'].publish(self._pose())
            self._publishers['battery_state'].publish(BatteryState(
                charge=0.1 if is_lost else odd.get('charge', 2.0), capacity=2.7))
            self._publishers['cleaning_status'].publish(CleaningStatus(
                coverage=odd.get('coverage', 0.5), distance=odd.get('distance', 1.0)))
            rospy.rostime.wallsleep(PERIOD)


if __name__ == '__main__':
    rospy.init_node('frail')
    FrailNode(rospy.myargv()[1]).run()
