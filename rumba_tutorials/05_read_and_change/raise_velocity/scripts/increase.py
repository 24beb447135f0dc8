#!/usr/bin/env python3
"""Follows the velocity that a robot is told on cmd_vel, asks by how much to raise it, and tells the robot that.

Any robot that takes a geometry_msgs/Twist will do: cmd_vel:=/rumba/cmd_vel, cmd_vel:=/turtle1/cmd_vel.
"""

import copy
import math
import time

import rospy
from geometry_msgs.msg import Twist

PERIOD = rospy.Duration(0.1)  # robots stop when nobody has told them anything for a while
LAST_WORDS = 0.2  # [s] that the last message needs on its way, before this program ends


class Driver:
    """Says again and again what the robot shall do: what was last asked for, here or by another node."""

    def __init__(self):
        self.velocity = Twist()  # always replaced and never changed, since three threads use it
        self.publisher = rospy.Publisher('cmd_vel', Twist, queue_size=1)
        rospy.Subscriber('cmd_vel', Twist, self.follow)
        rospy.Timer(PERIOD, lambda _: self.publisher.publish(self.velocity))
        rospy.on_shutdown(self.stop)

    def follow(self, velocity):
        """Take over what another node says; what this node says comes back to it too, and is no news."""
        if velocity._connection_header['callerid'] != rospy.get_name():
            self.velocity = velocity

    def increase(self, amount):
        """Raise the velocity ahead [m/s]; a negative amount lowers it."""
        faster = copy.deepcopy(self.velocity)
        faster.linear.x += amount
        self.velocity = faster

    def stop(self):
        self.velocity = Twist()
        self.publisher.publish(self.velocity)
        time.sleep(LAST_WORDS)


def ask(velocity):
    """An amount [m/s] that the user types; None where that is q, or the end."""
    print(f'now {velocity:.2f} m/s; raise it by how much? (q: stop and leave)', flush=True)
    while True:
        try:
            answer = input('> ').strip()
            if answer == 'q':
                return None
            amount = float(answer)
            if math.isfinite(amount):
                return amount
        except ValueError:
            pass
        except (EOFError, KeyboardInterrupt):
            return None
        print(f'{answer!r} is not an amount: a number of m/s, such as 0.1 or -0.1', flush=True)


def main():
    # rospy's own handler of Ctrl-C would end the node, and leave input() waiting.
    rospy.init_node('increase', disable_signals=True)
    driver = Driver()
    amount = 0.0
    while amount is not None:
        driver.increase(amount)
        amount = ask(driver.velocity.linear.x)
    rospy.signal_shutdown('the user leaves')


if __name__ == '__main__':
    main()
