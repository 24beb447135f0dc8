"""wanderer: drives a Rumba about, straight on until something is in the way, then off in another direction.

Subscribes:
  rumba/bumper    rumba_msg/Bumper: its stamps are this node's clock
  rumba/cliff     rumba_msg/Cliff
Publishes:
  rumba/cmd_vel   geometry_msgs/Twist, as often as bumper comes

Parameters, as in `rosrun rumba_sim wanderer _seed:=5`:
"""

import dataclasses
from typing import Optional, Sequence

import numpy as np
import rospy
from geometry_msgs.msg import Twist

from rumba_msg.msg import Bumper, Cliff
from rumba_sim.cleaning.behaviour import Observation
from rumba_sim.cleaning.bounce import Bounce
from rumba_sim.model.config import setting
from rumba_sim.model.geometry import Pose
from rumba_sim.ros import node


@dataclasses.dataclass(frozen=True)
class Settings:
    """The node's private parameters."""

    seed: int = setting(1, 'of the angles by which it turns away', '', 0, 2 ** 31 - 1)


def main() -> None:
    """Run the node."""
    node.run('wanderer', Settings, wander)


def wander(settings: Settings) -> None:
    """Answer each reading of the bumper with a command, until ROS shuts down."""
    wanderer = _Wanderer(settings.seed)
    rospy.Subscriber('rumba/cliff', Cliff, wanderer.on_cliff, queue_size=1)
    rospy.Subscriber('rumba/bumper', Bumper, wanderer.on_bumper, queue_size=10)
    rospy.spin()


class _Wanderer:
    """The behaviour between its topics."""

    def __init__(self, seed: int) -> None:
        self._behaviour = Bounce(np.random.default_rng(seed))
        self._publisher = rospy.Publisher('rumba/cmd_vel', Twist, queue_size=1)
        self._cliffs: Sequence[bool] = (False, False, False, False)
        self._last: Optional[rospy.Time] = None

    def on_cliff(self, cliff: Cliff) -> None:
        """Remember where the floor ends."""
        self._cliffs = (cliff.is_cliff_left, cliff.is_cliff_front_left, cliff.is_cliff_front_right,
                        cliff.is_cliff_right)

    def on_bumper(self, bumper: Bumper) -> None:
        """Update the behaviour and do as it says."""
        stamp = bumper.header.stamp
        dt = (stamp - self._last).to_sec() if self._last else 0.0
        self._last = stamp
        command = self._behaviour.update(Observation(
            dt=dt, pose=Pose(0.0, 0.0, 0.0), bumper=(bumper.is_left_pressed, bumper.is_right_pressed),
            cliffs=self._cliffs))
        twist = Twist()
        twist.linear.x, twist.angular.z = command.v, command.w
        self._publisher.publish(twist)
