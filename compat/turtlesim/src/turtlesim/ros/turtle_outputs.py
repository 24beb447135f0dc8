"""The topics that the turtles publish at every step."""

from typing import Any, Callable, List, Mapping, Tuple

import rospy

from turtlesim.model.field import Field, topics
from turtlesim.msg import Color, Pose

QUEUE = 100  # messages that wait for a slow subscriber before the oldest is dropped


class SerializedPose(Pose):
    """A pose that is serialised already: to build and pack a message costs most of the time of publishing it."""

    def __init__(self, data: bytes) -> None:
        """Take five little-endian float32 in the order of the definition."""
        self.data = data

    def serialize(self, buff: Any) -> None:
        """Write the bytes that rospy sends."""
        buff.write(self.data)


class TurtleOutputs(rospy.SubscribeListener):
    """The two topics that one turtle publishes."""

    def __init__(self, name: str, peers_changed: Callable[[], None]) -> None:
        """Open the topics; `peers_changed` is called, from any thread, when a subscriber comes or goes."""
        self._peers_changed = peers_changed
        prefix = topics(name)
        self.pose = rospy.Publisher(f'{prefix}pose', Pose, self, queue_size=QUEUE)
        self.colour = rospy.Publisher(f'{prefix}color_sensor', Color, self, queue_size=QUEUE)

    def close(self) -> None:
        """Close the topics."""
        self.pose.unregister()
        self.colour.unregister()

    def peer_subscribe(self, *_: Any) -> None:
        """Called by rospy when a subscriber comes."""
        self._peers_changed()

    def peer_unsubscribe(self, *_: Any) -> None:
        """Called by rospy when a subscriber goes."""
        self._peers_changed()


class Broadcaster:
    """Publishes poses and colours of all turtles; topics without a subscriber cost nothing."""

    def __init__(self, field: Field, outputs: Mapping[str, TurtleOutputs]) -> None:
        """Publish the turtles of a field.

        Args:
            field: the turtles.
            outputs: topics by the name of the turtle; call `changed` after a change of `field.names` or of these.
        """
        self._field = field
        self._outputs = outputs
        self._is_known = False
        self._poses: List[Tuple[int, rospy.Publisher]] = []  # rows of `Field.readings` that have subscribers
        self._colours: List[Tuple[str, rospy.Publisher]] = []

    def changed(self) -> None:
        """Note that turtles or subscribers came or went; may be called from any thread."""
        self._is_known = False

    def publish(self) -> None:
        """Publish where each turtle is, and the colour under it."""
        if not self._is_known:
            self._find_subscribers()
        if self._poses:
            readings = self._field.readings().astype('<f4')
            for row, publisher in self._poses:
                publisher.publish(SerializedPose(readings[row].tobytes()))
        for name, publisher in self._colours:
            publisher.publish(*self._field.colour(name))

    def _find_subscribers(self) -> None:
        self._is_known = True  # set first, so that a change that comes meanwhile is not missed
        turtles = [(row, name, self._outputs[name]) for row, name in enumerate(self._field.names)
                   if name in self._outputs]
        self._poses = [(row, topics.pose) for row, _, topics in turtles if topics.pose.get_num_connections()]
        self._colours = [(name, topics.colour) for _, name, topics in turtles if topics.colour.get_num_connections()]
