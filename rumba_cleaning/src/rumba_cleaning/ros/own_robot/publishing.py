"""Publishing from callbacks, which still run while a node ends."""

from typing import Any

import rospy


def publish(publisher: rospy.Publisher, message: Any) -> None:
    """Publish, unless the node ends, which closes its topics while callbacks still run."""
    try:
        publisher.publish(message)
    except rospy.ROSException:
        if not rospy.is_shutdown():
            raise
