"""mimic: makes one turtle move as another one does.

Subscribes to
  input/pose       turtlesim/Pose of the turtle to imitate
and publishes
  output/cmd_vel   geometry_msgs/Twist, one for each pose, with its speed and turn rate
Remap input and output to the names of two turtles: input:=turtlesim1/turtle1 output:=turtlesim2/turtle1.
"""

import rospy
from geometry_msgs.msg import Twist, Vector3

from turtlesim.msg import Pose
from turtlesim.ros import node


def main() -> None:
    """Run the node."""
    node.run('turtle_mimic', {}, mimic)


def mimic() -> None:
    """Mimic until ROS shuts down."""
    # rospy remaps whole names only: input:= changes `input`, not `input/pose`.
    publisher = rospy.Publisher(rospy.resolve_name('output') + '/cmd_vel', Twist, queue_size=1)

    def on_pose(pose: Pose) -> None:
        publisher.publish(Twist(Vector3(pose.linear_velocity, 0.0, 0.0), Vector3(0.0, 0.0, pose.angular_velocity)))

    rospy.Subscriber(rospy.resolve_name('input') + '/pose', Pose, on_pose, queue_size=1, tcp_nodelay=True)
    rospy.spin()
