"""A node that drives turtles in circles: `turtle_driver.py NAME ...` commands each of them 10 times a second."""

import time

import rospy
from geometry_msgs.msg import Twist, Vector3

PERIOD = 0.1  # [s]
CIRCLE = Twist(Vector3(1.0, 0.0, 0.0), Vector3(0.0, 0.0, 1.0))  # of radius 1 m


def main():
    """Drive until interrupted."""
    rospy.init_node('driver', disable_rostime=True, disable_rosout=True)
    publishers = [rospy.Publisher(f'{name}/cmd_vel', Twist, queue_size=10) for name in rospy.myargv()[1:]]
    while any(publisher.get_num_connections() == 0 for publisher in publishers):
        time.sleep(PERIOD)
    print('driving', flush=True)
    due = time.monotonic()
    while not rospy.is_shutdown():
        for publisher in publishers:
            publisher.publish(CIRCLE)
        due += PERIOD
        time.sleep(max(0.0, due - time.monotonic()))


if __name__ == '__main__':
    main()
