"""A goal that is active: what the robot does for it, reading by reading, until its client has a result."""

import time
import traceback
from typing import Any, Callable, List, Optional

import rospy

from rumba_cleaning.behaviour import FALLEN, Observation, Status
from rumba_cleaning.mission.stages import State
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.ros.cleaner.goals.activities import Activity
from rumba_cleaning.ros.cleaner.robots import conversions
from rumba_cleaning.ros.cleaner.robots.robot import Robot
from rumba_cleaning.ros.cleaner.robots.senses import SECOND
from rumba_sim.model.common.errors import RumbaError, one_line, quoted
from rumba_sim.model.common.geometry import Pose
from rumba_sim.ros.running.node import PATIENCE

GONE_AFTER = 2.0  # [s] of the wall clock without a publisher: the robot is gone ...
NEVER_CAME_AFTER = PATIENCE  # ... or, if it was never heard, will not come
INCOMPLETE_AFTER = 5 * SECOND  # [ns] of the robot's time without a complete reading: a sensor is silent ...
INCOMPLETE_COUNT = 50  # ... as it is if dock_status came so many times without bumper or cliff ...
# ... but only after this [s] of the wall clock: at a high speed its topics still connect, and while a plan is computed
# no message is taken, and afterwards all those of one topic before those of another.
CONNECTED_AFTER = 2.0
REST_WITHIN = 2 * SECOND  # [ns] of the robot's time from the end to the result, at most ...
REST_WITHIN_WALL = 5.0  # ... and at most this [s] of the wall clock, if time stands still
REST = 0.001  # [m], [rad] that a robot at rest moves at most from one reading to the next
WORDS = {Outcome.SUCCEEDED: 'done', Outcome.CANCELLED: 'ended',
         Outcome.PREEMPTED: 'ended'}  # else: given up


class Run:
    """Acts upon readings until the behaviour has ended and the robot is at rest, then answers.

    Attributes:
        activity: what is done for the goal.
        handle: the goal, of actionlib.
        outcome: how the behaviour ended; UNKNOWN until then.
        is_closed: whether the client has its result.
    """

    def __init__(self, activity: Activity, handle: Any, robot: Robot) -> None:
        """Begin."""
        self.activity = activity
        self.handle = handle
        self.outcome = Outcome.UNKNOWN
        self.is_closed = False
        self._robot = robot
        self._senses = senses = robot.senses
        self._message = ''  # how the behaviour ended
        self._ended: Optional[rospy.Time] = None  # stamp of that
        self._last_pose: Optional[Pose] = None  # at the reading before, once the behaviour has ended
        self._first_figures = senses.cleaning
        self._begun = self._feedback_due = senses.passed
        self._complete = senses.passed  # when the newest complete reading came, or the end ...
        self._complete_wall = self._since_wall = time.monotonic()  # ... by the wall clock; the beginning, or the end
        self._silent: Optional[float] = None  # since when dock_status has come alone, by the wall clock
        robot.brushes.forget()
        senses.begin()
        activity.begin()

    # --- readings -------------------------------------------------------------------------------------------------

    def read(self) -> None:
        """Act upon the newest reading."""
        self._silent = None
        observation = self._senses.observe()
        if observation is None:
            if self._senses.passed - self._complete > INCOMPLETE_AFTER and self._had_time_to_connect():
                self.close(Outcome.NO_READINGS, self._senses.missing())
        elif self.outcome is Outcome.UNKNOWN:
            self._complete, self._complete_wall = self._senses.passed, time.monotonic()
            self._first_figures = self._first_figures or self._senses.cleaning
            self._act(observation)
        else:
            self._settle(observation.pose)

    def _act(self, observation: Observation) -> None:
        behaviour, strategy = self.activity.behaviour, self.activity.strategy
        try:
            self._take_step(observation)
        except (Exception, SystemExit) as error:  # a strategy may do anything
            behaviour.fail(f'strategy {strategy!r}: {describe(error)}' if strategy else describe(error), Outcome.ERROR)
        if behaviour.status is not Status.RUNNING:
            self._end(behaviour.outcome, behaviour.message)

    def _take_step(self, observation: Observation) -> None:
        """Have the behaviour decide, and do what it says; nothing while a person drives, and once it has ended."""
        behaviour = self.activity.behaviour
        if self._senses.has_fallen:
            behaviour.fail(FALLEN, Outcome.FALLEN)
        elif self._robot.teleop.is_driving:
            behaviour.stand_by(observation)
            self._robot.brushes.forget()  # the person may move them
            self._tell(State.YIELDING, 'a person drives')
        else:
            command = behaviour.step(observation)
            if behaviour.status is not Status.RUNNING:
                return
            self._robot.wheels.drive(command)
            self._robot.brushes.want(bool(command.brushes_up))
            self._robot.plan.show(behaviour.planned_path(), self._senses.stamp)
            if self.activity.state is not State.IDLE:  # else it still prepares to begin
                self._tell(self.activity.state, one_line(behaviour.message))

    def _tell(self, state: State, message: str) -> None:
        senses, announcer = self._senses, self._robot.announcer
        is_due = senses.passed >= self._feedback_due
        announcer.tell(state, self.activity.strategy, message, senses.stamp, is_due)
        if is_due:
            self._feedback_due = max(self._feedback_due + SECOND, senses.passed + 1)
            self.handle.publish_feedback(self.activity.feedback(senses, announcer.status))

    def look_after(self) -> None:
        """Called while no reading comes: give up if the robot is gone, but not if time stands still."""
        now = time.monotonic()
        patience = GONE_AFTER if self._senses.stamp is not None else NEVER_CAME_AFTER
        if self._senses.is_alone and now - max(self._senses.heard, self._since_wall) > patience:
            self.close(Outcome.NO_READINGS, self._senses.absence)
        elif self._is_silent(now):
            self.close(Outcome.NO_READINGS, self._senses.missing())
        elif self.outcome is not Outcome.UNKNOWN and now - self._since_wall > REST_WITHIN_WALL:
            self.close(self.outcome, self._message)

    def _is_silent(self, now: float) -> bool:
        """Whether dock_status has come alone for long."""
        if self._senses.unread <= INCOMPLETE_COUNT:
            self._silent = None
            return False
        self._silent = now if self._silent is None else self._silent
        return now - self._silent > CONNECTED_AFTER

    def _had_time_to_connect(self) -> bool:
        return time.monotonic() - self._complete_wall > CONNECTED_AFTER

    def begin_again(self) -> None:
        """The world was reset: what was done, or had even ended, is to be done there."""
        self.activity.begin_again()
        self.outcome, self._message, self._ended, self._last_pose = Outcome.UNKNOWN, '', None, None
        self._first_figures = None
        self._complete, self._complete_wall = self._senses.passed, time.monotonic()
        self._robot.brushes.forget()
        self._senses.begin()
        self._robot.announcer.say('the simulator was reset: begins again')

    # --- the end --------------------------------------------------------------------------------------------------

    def _end(self, outcome: Outcome, message: str) -> None:
        """The behaviour has ended: let the robot come to rest."""
        self._robot.rest()
        if outcome is Outcome.UNKNOWN or outcome not in list(Outcome):
            outcome, message = Outcome.ERROR, f'{message} (its outcome is {quoted(outcome)}: must be an Outcome)'
        self.outcome, self._message = Outcome(outcome), one_line(str(message))
        self._ended, self._complete, self._since_wall = self._senses.stamp, self._senses.passed, time.monotonic()

    def _settle(self, pose: Pose) -> None:
        """Answer once the robot is at rest and the figures are those of the end."""
        last, self._last_pose = self._last_pose, pose
        is_at_rest = last is not None and max(abs(now - then) for now, then in zip(pose, last)) < REST
        cleaning = self._senses.cleaning
        has_figures = not self.activity.needs_figures or cleaning is not None and cleaning.header.stamp > self._ended
        if is_at_rest and has_figures or self._senses.passed - self._complete > REST_WITHIN:
            self.close(self.outcome, self._message)

    def interrupt(self, outcome: Outcome, message: str) -> None:
        """Stop now, for a client's sake; a behaviour that has ended before keeps its outcome."""
        if self.outcome is Outcome.UNKNOWN:
            self.close(outcome, message)
        else:
            self.close(self.outcome, self._message)

    def close(self, outcome: Outcome, message: str) -> None:
        """Stop and answer the client."""
        if self.outcome is Outcome.UNKNOWN:
            self._robot.rest()
        self._robot.plan.show(None, self._senses.stamp)
        last_words: List[Callable[[], None]] = [self.activity.behaviour.stop, lambda: self._announce(outcome, message)]
        for say in last_words:
            try:
                say()
            except (Exception, SystemExit) as error:  # the client gets its answer in any case
                describe(error)
        result = self.activity.result(self._senses, conversions.outcome(outcome, message))
        answer = {Outcome.SUCCEEDED: self.handle.set_succeeded, Outcome.CANCELLED: self.handle.set_canceled,
                  Outcome.PREEMPTED: self.handle.set_canceled}.get(outcome, self.handle.set_aborted)
        answer(result, message)
        self.is_closed = True

    def _announce(self, outcome: Outcome, message: str) -> None:
        announcer, senses = self._robot.announcer, self._senses
        seconds = (senses.passed - self._begun) / SECOND
        report = self.activity.report(self._first_figures, senses.cleaning)
        announcer.say(f'{WORDS.get(outcome, "given up")} after {seconds:.0f} s{report}: {message}')
        is_stranded = outcome in (Outcome.FALLEN, Outcome.BATTERY_EMPTY) or (
            outcome is self.outcome and self.activity.state is State.STRANDED)
        announcer.tell(State.STRANDED if is_stranded else State.IDLE, '', message, senses.stamp, is_due=True)


def describe(error: BaseException) -> str:
    """What went wrong, for a person; the log tells where in the code, unless it is an error of input."""
    if isinstance(error, RumbaError):
        return str(error)
    rospy.logerr(traceback.format_exc())
    return one_line(f'{type(error).__name__}: {error}')
