"""Judges a run by the messages of a robot's topics.

In lockstep, the monitor takes part: the world waits until all that it sent for a control tick has come, so that what
counts, and in which order, does not depend on the machine.
"""

import contextlib
import math
import threading
import time
from typing import Any, Dict, List, Optional, Sequence, Set, Tuple

import rosgraph
import rospy
from nav_msgs.msg import Odometry

from rumba_evaluation.ros.judge import surroundings
from rumba_evaluation.ros.judge.examiner_feed import ExaminerFeed
from rumba_evaluation.ros.judge.launched_parameters import as_launched
from rumba_evaluation.ros.judge.recording import Recording
from rumba_evaluation.ros.judge.robot_feed import RobotFeed
from rumba_evaluation.ros.judge.robot_topics import PLACE, TOPICS, Value, stamps
from rumba_evaluation.verdicts import silence
from rumba_evaluation.verdicts.awaited import Awaited
from rumba_evaluation.verdicts.conditions import Condition
from rumba_evaluation.verdicts.examination import Examination
from rumba_evaluation.verdicts.field_conditions import FieldCondition, Rate
from rumba_evaluation.verdicts.mission_verdict import Judge, Verdict
from rumba_evaluation.verdicts.origins import Origins
from rumba_evaluation.verdicts.tick_readings import TickReadings
from rumba_msg.msg import Lockstep
from rumba_sim.model.common.errors import WorldError
from rumba_sim.ros.common import conversions
from rumba_sim.ros.participants import simulator_client

PERIOD = 0.05  # [s] of the wall clock
LOOK_PERIOD = 0.5  # [s] of the wall clock from one look at the master to the next
MODE_PATIENCE = 3.0  # [s] of the wall clock from the first message until it is assumed that there is no lockstep ...
STATE_PATIENCE = 30.0  # ... if the master knows a publisher of the state, which tells
TICK_PATIENCE = 5.0  # [s] of the wall clock to wait for the messages of a tick
REST = 0.2  # [s] of the wall clock for what is on its way at the end


class MissionMonitor:
    """Judges a run by the messages of a robot's topics."""

    def __init__(self, found: List[Condition], robot: str, time_limit: float, patience: float, publisher: str,
                 awaited: Sequence[str], is_exam: bool, recording: Optional[Recording] = None) -> None:
        """Subscribe to the topics that the conditions need, in an examination at the beginning of the run.

        Args:
            found: the conditions.
            robot: its name.
            time_limit: of the run [s], in the time of the robot.
            patience: of the wall clock without any message [s], after which the run is aborted.
            publisher: full name of the node that publishes the robot's topics; empty: the one that the state names.
            awaited: topics of the node under test: in lockstep, the world waits for a message on each after a tick.
            is_exam: whether the simulator tells all over its private channel, and nobody may set a parameter of it.
            recording: of an examination.
        """
        self._robot = robot
        self._exam: Optional[Examination] = None
        self._feed = ExaminerFeed(patience, recording, self._annul, self._on_end) if is_exam else RobotFeed()
        self._patience = patience
        self._judge = Judge(found, time_limit)
        self._lock = threading.RLock()  # held while judge, origins or readings change
        self._last_message = self._last_look = time.monotonic()
        self._unpublished = [(condition, number) for condition in found if isinstance(condition, FieldCondition)
                             for number in range(len(condition.paths))]
        self._awaited = Awaited(str(rospy.resolve_name(topic)) for topic in awaited)
        self._known = [str(rospy.resolve_name(topic)) for topic in (
            *awaited, *(condition.paths[0] for condition in found if isinstance(condition, Rate)))]
        self._place = self._full(PLACE)
        self._heard: Set[str] = set()  # topics of which messages came
        self._surroundings = surroundings.Surroundings()
        self._kinds = kinds = {self._place: Odometry}
        self._taken: Dict[str, List[Tuple[Condition, Value]]] = {self._place: []}  # by topic
        for condition in found:
            for topic, kind, value in TOPICS.get(type(condition), []):
                kinds[self._full(topic)] = kind
                self._taken.setdefault(self._full(topic), []).append((condition, value))
        self._readings = TickReadings(list(kinds))
        self._is_lockstep: Optional[bool] = None  # not known yet
        self._first_message = self._tick_came = math.inf  # times of time.monotonic
        self._tick: Optional[Lockstep] = None  # that is not answered
        self._has_looked = False  # whether it has looked for fields since the first tick came
        self._expected = set(kinds)  # topics with a message for each tick, or for some
        state = rospy.resolve_name(simulator_client.TOPIC)
        self._origins = Origins([topic for topic, values in self._taken.items() if values], state, publisher)
        if not is_exam:
            self._listen()

    def _listen(self) -> None:
        """Subscribe to the topics of the robot, and then take part.

        Raises:
            WorldError: there is no simulator in an examination.
        """
        for topic, kind in self._kinds.items():
            self._subscribe(topic, kind)
        self._feed.begin(self._on_state, self._on_tick)

    def _listen_in_examination(self, feed: ExaminerFeed) -> None:
        """Begin with all that the simulator tells, from its first word on."""
        try:
            self._listen()
        except WorldError as error:
            self._annul(str(error))
            return
        self._exam = Examination(*as_launched())
        self._subscribe_to_fields()
        feed.follow()

    def _full(self, topic: str) -> str:
        return str(rospy.resolve_name(f'{self._robot}/{topic}'))

    # --- messages -------------------------------------------------------------------------------------------------

    def _subscribe(self, topic: str, kind: Any) -> None:
        """Take what comes on a topic, once for all conditions: each message is one answer of who is awaited."""
        def act(message: Any) -> None:
            if topic == self._place and kind is Odometry:
                self._judge.locate(conversions.plane_pose(message.pose.pose))
            for condition, value in self._taken[topic]:
                self._judge.update(condition, value(message), self._now())

        def take(message: Any, sender: str) -> None:
            with self._lock:
                if self._taken[topic]:
                    self._last_message = time.monotonic()
                    self._origins.publishes(topic, sender)
                self._heard.add(topic)
                stamp = message.header.stamp.to_sec() if getattr(message, '_has_header', False) else 0.0
                self._first_message = min(self._first_message, time.monotonic())
                self._readings.take(topic, stamp, lambda: act(message))
                self._awaited.hear(topic)
                self._settle()
        self._feed.subscribe(topic, kind, take)

    def _on_state(self, node: str, is_lockstep: bool, sender: str) -> None:
        with self._lock:
            self._origins.publishes(rospy.resolve_name(simulator_client.TOPIC), sender)
            self._origins.names(node)
            if self._is_lockstep is None:
                self._is_lockstep = is_lockstep
            self._settle()

    def _annul(self, reason: str) -> None:
        with self._lock:
            self._judge.annul(reason)

    def _on_end(self) -> None:
        with self._lock:
            self._judge.abort('the simulator has ended')

    # --- lockstep -------------------------------------------------------------------------------------------------

    def _on_tick(self, tick: Lockstep) -> None:
        with self._lock:
            self._is_lockstep, self._tick, self._tick_came = True, tick, time.monotonic()
            if not self._feed.is_ordered:
                due = {self._full(topic): stamp for topic, stamp in stamps(tick).items()}
                self._readings.expect({topic: stamp for topic, stamp in due.items() if topic in self._expected})
            self._settle()

    def _settle(self) -> None:
        """Judge what has come, in lockstep once everything of a tick is there, and answer for it."""
        if self._tick is None and not self._feed.is_time_known:
            return  # a run that began at 0 s would be over as soon as the time of the robots comes
        patience = STATE_PATIENCE if self._origins.has_state else MODE_PATIENCE
        if self._is_lockstep is None and time.monotonic() < self._first_message + patience:
            return
        if self._is_lockstep and (self._tick is None or not self._has_looked or self._readings.missing
                                  or self._awaited.silent):
            return
        for _, act in self._readings.release():
            act()
        if self._tick is not None:
            self._judge.check_time(self._now())
            if not self._judge.is_over:  # otherwise the world stands still until there is a verdict
                tick, self._tick = self._tick, None
                self._awaited.begin()
                self._feed.answer(tick.header.stamp)

    def _go_on(self) -> None:
        """Wait no longer for what does not come."""
        if self._tick is not None and time.monotonic() > self._tick_came + TICK_PATIENCE and self._readings.missing:
            missing = self._readings.missing
            rospy.logwarn(f'{" and ".join(missing)}: no message for a control tick in {TICK_PATIENCE:g} s: the test '
                          'goes on without waiting for it')
            self._expected -= set(missing)
            self._readings.expect({})
        if self._tick is not None:
            self._awaited.give_up(self._tick_came, time.monotonic())
        self._settle()

    def _now(self) -> float:
        return self._feed.now() if self._tick is None else float(self._tick.header.stamp.to_sec())

    # --- the run --------------------------------------------------------------------------------------------------

    def run(self) -> None:
        """Wait until the run is over."""
        if isinstance(self._feed, ExaminerFeed):
            self._listen_in_examination(self._feed)
        while not self._judge.is_over:
            self._subscribe_to_fields()
            self._look_at_publishers(LOOK_PERIOD)
            time.sleep(PERIOD)  # rospy.sleep would wait for the clock of a simulator, which may have ended
            with self._lock:
                self._go_on()
                if not self._is_lockstep:
                    self._judge.check_time(self._now())
                if time.monotonic() - self._last_message > self._patience:
                    self._judge.abort(f'no message came for {self._patience:g} s of the wall clock')
                if rospy.is_shutdown():
                    self._judge.abort('the test was stopped')
        self._complete()

    def _complete(self) -> None:
        """Wait until it is known who must publish: the run may end before the state of the simulator comes."""
        if self._tick is not None:
            time.sleep(REST)  # the origins of what is on its way count too
        end = time.monotonic() + self._patience
        self._look_at_publishers()
        while not self._origins.is_complete and time.monotonic() < end and not rospy.is_shutdown():
            time.sleep(PERIOD)
        self._look_at_publishers()
        with self._lock:
            if not self._origins.is_complete:
                self._judge.annul(self._origins.unknown())

    def _look_at_publishers(self, period: float = 0.0) -> None:
        """Ask the master who publishes, not more often than in a period [s]; the run is void if a wrong node does."""
        if time.monotonic() - self._last_look >= period:
            self._last_look = time.monotonic()
            publishers = self._surroundings.look()
            if self._exam is not None:
                with contextlib.suppress(rosgraph.MasterException, OSError):  # it ends, or is busy
                    self._exam.look(rospy.get_param('/', {}))
            with self._lock:
                for topic, nodes in publishers:
                    for name in nodes:
                        self._origins.publishes(topic, name)
        with self._lock:
            problem = self._origins.problem() or (self._exam.problem if self._exam is not None else '')
            if problem:
                self._judge.annul(problem)

    def _subscribe_to_fields(self) -> None:
        """Subscribe to the topics of those fields that have a publisher since the last call."""
        is_ticking = self._tick is not None
        for condition, number in self._unpublished[:]:
            path = rospy.resolve_name(condition.paths[number])
            found = self._feed.find(path)
            if found is not None:
                topic, kind, value = found
                self._unpublished.remove((condition, number))
                self._take_field(condition, number, topic, kind, value)
        self._has_looked = self._has_looked or is_ticking

    def _take_field(self, condition: FieldCondition, number: int, topic: str, kind: Any, value: Value) -> None:
        with self._lock:
            self._origins.watch(topic)
            self._awaited.publishes(topic, time.monotonic())
            is_new = topic not in self._taken
            self._taken.setdefault(topic, []).append(
                (condition, lambda message: condition.reading(number, value(message))))
            self._expected.add(topic)
        if is_new:
            self._subscribe(topic, kind)

    def verdicts(self) -> List[Verdict]:
        """The verdict on each condition."""
        ours = [rospy.get_name(), *self._origins.owners, str(rospy.resolve_name(self._robot))]
        seen = self._surroundings.seen(ours, self._heard, self._feed.told)

        def why(condition: Condition) -> str:
            return silence.reason(self._paths(condition), self._known, seen, surroundings.fields)
        with self._lock:
            return self._judge.verdicts(lambda condition: ' or '.join(self._paths(condition)), why)

    def _paths(self, condition: Condition) -> List[str]:
        """Full names of topics, perhaps with a field, from which the values of a condition come."""
        topics = condition.paths if isinstance(condition, FieldCondition) else [
            f'{self._robot}/{topic}' for topic, _, _ in TOPICS[type(condition)]]
        return [str(rospy.resolve_name(topic)) for topic in topics]

    def close(self) -> None:
        """Take part no longer."""
        self._feed.close()
