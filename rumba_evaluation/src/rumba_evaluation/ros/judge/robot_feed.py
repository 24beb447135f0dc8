"""What a robot, its world and the node under test tell, as ROS brings it."""

import time
from typing import Any, Callable, Mapping, Optional, Tuple

import rospy
import rostopic

from rumba_msg.msg import Lockstep, SimulatorState
from rumba_sim.ros.participants import simulator_client
from rumba_sim.ros.participants.lockstep import Participant
from rumba_sim.ros.running import clock, peers

COMPLAINT_PERIOD = 40.0  # [s]
Take = Callable[[Any, str], None]  # gets a message, and the full name of its sender
OnState = Callable[[str, bool, str], None]  # gets the node of the world, whether it is in lockstep, and who says so
Found = Tuple[str, Any, Callable[[Any], Any]]  # a topic, its type, and what makes of a message the value of a field


class RobotFeed:
    """Topics of any nodes, the state of the simulator, and the ticks of its lockstep.

    Attributes:
        is_ordered: whether all that belongs to a tick comes before it.
        told: types of topics of which the master does not know.
    """

    is_ordered = False
    told: Mapping[str, str] = {}

    def begin(self, on_state: OnState, on_tick: Callable[[Lockstep], None]) -> None:
        """Listen from now on; the functions are called in other threads."""
        rospy.Subscriber(simulator_client.TOPIC, SimulatorState,
                         lambda state: on_state(state.node, state.is_lockstep, peers.caller(state)))
        self._participant = Participant(on_tick)

    def subscribe(self, topic: str, kind: Any, take: Take) -> None:
        """Have the messages of a topic, given by its full name, taken in another thread."""
        rospy.Subscriber(topic, kind, lambda message: take(message, peers.caller(message)))

    def find(self, path: str) -> Optional[Found]:
        """The topic and the field at a path, if somebody publishes it."""
        try:
            kind, topic, value = rostopic.get_topic_class(path)
        except rostopic.ROSTopicException as error:  # no master, or a type that this workspace does not have
            rospy.logwarn_throttle(COMPLAINT_PERIOD, f'{path}: {error}')
            return None
        return None if kind is None else (topic, kind, value or (lambda message: message))

    @property
    def is_time_known(self) -> bool:
        """Whether `now` is a time of the run."""
        return not clock.is_unknown()

    def now(self) -> float:
        """Time of the robots [s]; in real time one that nobody can set."""
        return time.monotonic() if rospy.rostime.is_wallclock() else float(rospy.get_time())

    def answer(self, stamp: rospy.Time) -> None:
        """Let the world go on after a tick."""
        self._participant.answer(stamp)

    def close(self) -> None:
        """The run is over."""
        self._participant.leave()
