"""draw_square: makes turtle1 draw a square with sides of 2 m, again and again.

It waits for turtle1/pose (turtlesim/Pose), calls reset (std_srvs/Empty), then publishes
  turtle1/cmd_vel    geometry_msgs/Twist, one for each pose
"""

import queue

import rospy
from geometry_msgs.msg import Twist, Vector3
from std_srvs.srv import Empty

from turtlesim.model.errors import TurtlesimError
from turtlesim.model.square import Square
from turtlesim.msg import Pose
from turtlesim.ros import node


def main() -> None:
    """Run the node."""
    node.run('draw_square', {}, draw)


def draw() -> None:
    """Draw until ROS shuts down.

    Raises:
        TurtlesimError: the service reset fails.
    """
    publisher = rospy.Publisher('turtle1/cmd_vel', Twist, queue_size=1)
    rospy.wait_for_message('turtle1/pose', Pose)
    rospy.wait_for_service('reset')
    try:
        rospy.ServiceProxy('reset', Empty)()
    except rospy.ServiceException as error:
        raise TurtlesimError(f'reset: {error}') from error
    square = Square()
    poses: 'queue.Queue[Pose]' = queue.Queue()
    rospy.Subscriber('turtle1/pose', Pose, poses.put, queue_size=1, tcp_nodelay=True)
    while not rospy.is_shutdown():
        try:
            pose = poses.get(timeout=0.5)
        except queue.Empty:
            continue
        while not poses.empty():  # those that came while the node was late are old
            pose = poses.get()
        speed, turn_rate = square.command(pose.x, pose.y, pose.theta)
        publisher.publish(Twist(Vector3(speed, 0.0, 0.0), Vector3(0.0, 0.0, turn_rate)))
