"""What a robot of others may have beside odometry and scan, by topics of whatever type its driver has."""

from typing import Any, Dict

import roslib.message
import rospy

from rumba_cleaning.own_robot.inputs import READERS, State
from rumba_cleaning.ros.cleaner.robots.location import QUEUE

COMPLAINT_PERIOD = 30.0  # [s]


class OptionalInputs:
    """Listens to them; packages of messages are imported when a message comes.

    Attributes:
        state: what they told.
    """

    def __init__(self, robot: str) -> None:
        """Listen to a robot, by its name."""
        self.state = State()
        self._classes: Dict[str, Any] = {}  # of messages, by type; None: its package is not installed
        for topic in READERS:
            rospy.Subscriber(f'{robot}/{topic}', rospy.AnyMsg, self._take, topic, queue_size=QUEUE)

    def _take(self, message: Any, topic: str) -> None:
        header = message._connection_header
        kind, name = header['type'], header['topic']
        reader = READERS[topic].get(kind)
        if reader is None:
            _complain(f'{name} has type {kind}: ignored, since {topic} must be one of {", ".join(READERS[topic])}')
            return
        if kind not in self._classes:
            self._classes[kind] = roslib.message.get_message_class(kind)
        known = self._classes[kind]
        if known is None:
            _complain(f'{name} has type {kind}: ignored, since the package {kind.split("/")[0]} is not installed: '
                      'install it, or source the workspace that has it')
        elif known._md5sum != header['md5sum']:
            _complain(f'{name} has another version of {kind} than the one that is installed: ignored')
        else:
            told = known()
            told.deserialize(message._buff)
            reader(self.state, told)


def _complain(line: str) -> None:
    rospy.logwarn_throttle_identical(COMPLAINT_PERIOD, line)
