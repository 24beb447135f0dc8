"""Who listens to which turtle, and what they are told every step."""

from typing import Any, Callable, List, Mapping, Tuple

import rospy

from turtlesim.model.field import Field
from turtlesim.msg import Color, Pose

QUEUE = 100  # messages that a subscriber may be behind before it misses one


class ReadyPose(Pose):
    """A pose that is bytes already: most of the cost of a message is in making it."""

    def __init__(self, data: bytes) -> None:
        """Five little-endian float32, in the order of the definition."""
        self.data = data

    def serialize(self, buff: Any) -> None:
        """Write what rospy sends."""
        buff.write(self.data)


class Voice(rospy.SubscribeListener):
    """The two topics that a turtle publishes."""

    def __init__(self, name: str, peers_changed: Callable[[], None]) -> None:
        """Open them; a function is called, from whatever thread, when somebody begins or ends to listen."""
        self._peers_changed = peers_changed
        self.pose = rospy.Publisher(f'{name}/pose', Pose, self, queue_size=QUEUE)
        self.colour = rospy.Publisher(f'{name}/color_sensor', Color, self, queue_size=QUEUE)

    def close(self) -> None:
        """Close them."""
        self.pose.unregister()
        self.colour.unregister()

    def peer_subscribe(self, *_: Any) -> None:
        """Somebody listens now."""
        self._peers_changed()

    def peer_unsubscribe(self, *_: Any) -> None:
        """Somebody has gone."""
        self._peers_changed()


class Audience:
    """Those who listen; where nobody does, nothing is made, and no publisher is asked."""

    def __init__(self, field: Field, voices: Mapping[str, Voice]) -> None:
        """Tell of the turtles of a field by their voices; whoever changes either says so by `changed`."""
        self._field = field
        self._voices = voices
        self._is_known = False
        self._poses: List[Tuple[int, rospy.Publisher]] = []  # rows of readings that somebody hears
        self._colours: List[Tuple[str, rospy.Publisher]] = []

    def changed(self) -> None:
        """Turtles came or went, or who listens to them; may be called from any thread."""
        self._is_known = False

    def tell(self) -> None:
        """Publish where every turtle is, and what it sees, to those who listen."""
        if not self._is_known:
            self._find()
        if self._poses:
            readings = self._field.readings().astype('<f4')
            for row, publisher in self._poses:
                publisher.publish(ReadyPose(readings[row].tobytes()))
        for name, publisher in self._colours:
            publisher.publish(*self._field.colour(name))

    def _find(self) -> None:
        self._is_known = True  # before looking, lest a change that comes meanwhile be missed
        rows = [(row, name, self._voices[name]) for row, name in enumerate(self._field.names) if name in self._voices]
        self._poses = [(row, voice.pose) for row, _, voice in rows if voice.pose.get_num_connections()]
        self._colours = [(name, voice.colour) for _, name, voice in rows if voice.colour.get_num_connections()]
