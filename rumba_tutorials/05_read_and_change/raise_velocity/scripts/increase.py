#!/usr/bin/env python3
"""Follows the velocity command on cmd_vel, asks the user how much to add, and publishes the sum.

Works with any robot that obeys a geometry_msgs/Twist: cmd_vel:=/rumba/cmd_vel, cmd_vel:=/turtle1/cmd_vel.
"""

import copy
import math
import time

import rospy
from geometry_msgs.msg import Twist

PERIOD = rospy.Duration(0.1)  # a robot stops if no command comes for some time
LAST_MESSAGE = 0.2  # [s] for the last message to arrive before this program ends


class Driver:
    """Publishes a velocity again and again: the latest one, typed here or published by another node."""

    def __init__(self):
        self.velocity = Twist()  # never changed, only replaced, because three threads use it
        self.publisher = rospy.Publisher('cmd_vel', Twist, queue_size=1)
        rospy.Subscriber('cmd_vel', Twist, self.follow)
        rospy.Timer(PERIOD, lambda _: self.publisher.publish(self.velocity))
        rospy.on_shutdown(self.stop)

    def follow(self, velocity):
        """Take over the command of another node; ignore the messages of this node, which come back to it."""
        if velocity._connection_header['callerid'] != rospy.get_name():
            self.velocity = velocity

    def increase(self, amount):
        """Add an amount to the forward velocity [m/s]; a negative amount lowers it."""
        faster = copy.deepcopy(self.velocity)
        faster.linear.x += amount
        self.velocity = faster

    def stop(self):
        self.velocity = Twist()
        self.publisher.publish(self.velocity)
        time.sleep(LAST_MESSAGE)


def ask(velocity):
    """Return the amount [m/s] that the user types; None for q, the end of the input or Ctrl-C."""
    print(f'the velocity is {velocity:.2f} m/s; how much to add? (q: stop the robot and quit)', flush=True)
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
        print(f'{answer!r} is not a velocity: type a number in m/s, such as 0.1 or -0.1', flush=True)


def main():
    # The handler of rospy for Ctrl-C would end the node, but input() would go on waiting.
    rospy.init_node('increase', disable_signals=True)
    driver = Driver()
    amount = 0.0
    while amount is not None:
        driver.increase(amount)
        amount = ask(driver.velocity.linear.x)
    rospy.signal_shutdown('the user quits')


if __name__ == '__main__':
    main()
