"""The bag of an examination: where the robot was, what it sensed, and who commanded it."""

import threading
from typing import Any, Dict, Tuple

import rosbag
import roslib.message
import rospy

from rumba_sim.model.common.errors import ConfigError
from rumba_sim.ros.participants.examiner_frames import COMMAND, MESSAGE, Frame

RECORDED = ('ground_truth', 'battery_state', 'bumper', 'dock_status', 'cleaning_status')  # below the robot's name


class Recording:
    """Writes what a simulator tells into a bag, each node with a connection of its own."""

    def __init__(self, path: str, robot: str) -> None:
        """Begin a bag.

        Args:
            path: of the bag.
            robot: its name.

        Raises:
            ConfigError: the file cannot be written.
        """
        self._topics = {rospy.resolve_name(f'{robot}/{topic}') for topic in RECORDED}
        self._connections: Dict[Tuple[str, str], Any] = {}  # by topic and sender
        self._lock = threading.Lock()
        self._is_open = True
        try:
            self._bag = rosbag.Bag(path, 'w')
        except OSError as error:
            raise ConfigError(f'recording: {path}: {error.strerror}') from error

    def take(self, frame: Frame) -> None:
        """Write a frame, if it is to be recorded."""
        with self._lock:
            if self._is_open and (frame.kind == COMMAND or frame.kind == MESSAGE and frame.topic in self._topics):
                self._write(frame)

    def _write(self, frame: Frame) -> None:
        """Write a message with the connection of its sender: rosbag has only one for each topic."""
        of_topics = self._bag._topic_connections
        of_topics.pop(frame.topic, None)
        if (frame.topic, frame.sender) in self._connections:
            of_topics[frame.topic] = self._connections[frame.topic, frame.sender]
        kind = roslib.message.get_message_class(frame.type)
        header = {'topic': frame.topic, 'type': kind._type, 'md5sum': kind._md5sum, 'callerid': frame.sender,
                  'message_definition': kind._full_text}
        self._bag.write(frame.topic, (kind._type, frame.content, kind._md5sum, kind),
                        rospy.Time(frame.secs, frame.nsecs), raw=True, connection_header=header)
        self._connections[frame.topic, frame.sender] = of_topics[frame.topic]

    def close(self) -> None:
        """Finish the bag."""
        with self._lock:
            if self._is_open:
                self._is_open = False
                self._bag.close()
