"""Shows where a robot plans to drive."""

from typing import Optional

import numpy as np
import rospy
from geometry_msgs.msg import Point, PoseStamped
from geometry_msgs.msg import Pose as PoseMessage
from nav_msgs.msg import Path
from std_msgs.msg import Header

from rumba_sim.model.kernel import Array
from rumba_sim.ros.common.conversions import quaternion
from rumba_sim.ros.common.frames import MAP

MANY = 100  # corners of a path; with fewer it is shown as it is
TOLERANCE = 0.01  # [m] from a path to what is shown of it, at most: one pixel or less


class PlanTopic:
    """Publishes the path that a robot follows, whenever that is another one."""

    def __init__(self, robot: str) -> None:
        """Show that a robot, by its name, has no plan."""
        self._publisher = rospy.Publisher(f'{robot}/plan', Path, queue_size=1, latch=True)
        self._shown: Optional[Array] = None
        self._publisher.publish(message(None, rospy.Time.now()))

    def show(self, path: Optional[Array], stamp: Optional[rospy.Time]) -> None:
        """Show the corners (n, 2) of a path [m], map frame, unless that array is shown already; None: no plan."""
        if path is self._shown:
            return
        self._shown = path
        self._publisher.publish(message(path, stamp or rospy.Time.now()))


def message(path: Optional[Array], stamp: rospy.Time) -> Path:
    """A path as a message; each pose faces the next one."""
    header = Header(stamp=stamp, frame_id=MAP)
    if path is None or len(path) < 2:
        return Path(header, [])
    if len(path) > MANY:
        from skimage import measure  # with so many corners the planner has loaded it already
        path = measure.approximate_polygon(path, TOLERANCE)
    along = np.diff(path, axis=0)
    headings = np.arctan2(along[:, 1], along[:, 0])
    return Path(header, [
        PoseStamped(header, PoseMessage(Point(x, y, 0.0), quaternion(theta)))
        for (x, y), theta in zip(path.tolist(), [*headings.tolist(), float(headings[-1])])])
