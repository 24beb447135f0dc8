"""In an examination, what the simulator tells comes over a private channel, in the order of the world."""

import threading
from typing import Any, Callable, Dict, List, Optional

import roslib.message
import rospy
import rostopic
from std_msgs.msg import Header

from rumba_evaluation.ros.judge.recording import Recording
from rumba_evaluation.ros.judge.robot_feed import Found, OnState, RobotFeed, Take
from rumba_msg.msg import Lockstep, LockstepAnswer
from rumba_sim.ros.participants import lockstep
from rumba_sim.ros.participants.examiner import REFUSED, ExaminerClient, socket_path
from rumba_sim.ros.participants.examiner_frames import INTRUDER, MESSAGE, Frame


class ExaminerFeed(RobotFeed):
    """Takes from ROS only what the simulator does not tell, so what the node under test publishes."""

    is_ordered = True
    is_time_known = True

    def __init__(self, patience: float, recording: Optional[Recording], on_void: Callable[[str], None],
                 on_end: Callable[[], None]) -> None:
        """Do not connect yet.

        Args:
            patience: how long to wait for the simulator [s] of the wall clock.
            recording: gets everything that the simulator tells.
            on_void: called with the reason if the run does not count.
            on_end: called when the simulator has ended.
        """
        self._patience = patience
        self._recording = recording
        self._on_void, self._on_end = on_void, on_end
        self._client = ExaminerClient()
        self._has_begun = False
        self._listeners: Dict[str, List[Take]] = {}
        self._lockstep = str(rospy.resolve_name(lockstep.TOPIC))
        self._run = ''
        self._newest = Frame(MESSAGE)  # the stamps of commands may be older

    def begin(self, on_state: OnState, on_tick: Callable[[Lockstep], None]) -> None:
        """Wait for the simulator, and know of what it tells; `follow` listens.

        Raises:
            WorldError: it does not come, or another process was first.
        """
        hello = self._client.connect(socket_path(), self._patience)
        self.told, self._has_begun = hello.topics, True
        on_state(hello.node, hello.is_lockstep, hello.node)
        self._listeners.setdefault(self._lockstep, []).append(lambda tick, _: self._take_tick(tick, on_tick))

    def follow(self) -> None:
        """Listen in a thread from now on."""
        threading.Thread(target=self._follow, daemon=True).start()

    def _follow(self) -> None:
        for frame in self._client.frames():
            if frame.kind == MESSAGE:
                self._newest = frame
            if frame.kind == INTRUDER:
                self._on_void(REFUSED)
            if self._recording is not None:
                self._recording.take(frame)
            if frame.kind == MESSAGE and frame.topic in self._listeners:
                message = frame.message()
                for take in self._listeners[frame.topic]:
                    take(message, frame.sender)
        self._on_end()

    def _take_tick(self, tick: Lockstep, on_tick: Callable[[Lockstep], None]) -> None:
        self._run = tick.run
        on_tick(tick)

    def subscribe(self, topic: str, kind: Any, take: Take) -> None:
        """Have the messages of a topic taken in another thread: of ROS, if the simulator does not tell of it.

        Before `begin`, the topics are those of the robot.
        """
        if not self._has_begun or topic in self.told:
            self._listeners.setdefault(topic, []).append(take)
        else:
            super().subscribe(topic, kind, take)

    def find(self, path: str) -> Optional[Found]:
        """The topic and the field at a path, if the simulator tells of it or somebody publishes it."""
        for topic, kind in self.told.items():
            if f'{path}/'.startswith(f'{topic}/'):
                field, found = path[len(topic):], roslib.message.get_message_class(kind)
                if _has_field(found(), field):
                    return topic, found, rostopic.msgevalgen(field) if field else (lambda message: message)
        return super().find(path)

    def now(self) -> float:
        """Time of the world [s] when it told something last."""
        return self._newest.time

    def answer(self, stamp: rospy.Time) -> None:
        """Let the world go on after a tick."""
        self._answer(stamp, LockstepAnswer.DONE)

    def close(self) -> None:
        """The run is over."""
        if self._run:
            self._answer(rospy.Time(), LockstepAnswer.LEAVES)
        self._client.close()

    def _answer(self, stamp: rospy.Time, state: int) -> None:
        self._client.answer(LockstepAnswer(Header(stamp=stamp), self._run, rospy.get_name(), state, ''))


def _has_field(message: Any, path: str) -> bool:
    """Whether a message has a field, up to an index; the path of the message itself is empty."""
    for name in filter(None, path.split('[')[0].split('/')):
        if not hasattr(message, name):
            return False
        message = getattr(message, name)
    return True
