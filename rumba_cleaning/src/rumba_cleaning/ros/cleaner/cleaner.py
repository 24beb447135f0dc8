"""cleaner: has one Rumba clean its floor, and come home to charge; drives it to its dock, off it, or to a place.

Below the robot's name it serves the actions
  clean    rumba_msg/Clean    undock   rumba_msg/Undock
  dock     rumba_msg/Dock     go_to    rumba_msg/GoTo
of which one runs at a time: a new goal ends the one before; and the service
  go_to_position    rumba_msg/TargetPosition: which velocity now leads toward a target
It publishes
  mission_status    rumba_msg/MissionStatus: latched; at each change, and at 1 Hz while a goal is active
  cmd_vel           geometry_msgs/Twist: while a goal is active, as often as dock_status comes
subscribes to
  bumper            rumba_msg/Bumper        cliff             rumba_msg/Cliff
  dock_status       rumba_msg/DockStatus    battery_state     sensor_msgs/BatteryState
  cleaning_status   rumba_msg/CleaningStatus
and to /tf and /tf_static for map -> odom -> base_footprint, and uses the service
  set_brushes_up    std_srvs/SetBool
The stamps of dock_status are its clock.

Parameters, as in `rosrun rumba_cleaning cleaner _robot:=rumba2 _strategy:=bounce`:
"""

import queue
import time
import traceback
from typing import Any, Callable, Optional, Type

import rospy
from actionlib import ActionServer
from actionlib_msgs.msg import GoalStatus

from rumba_cleaning import strategies
from rumba_cleaning.behaviour import STOP, Command, Observation, Status
from rumba_cleaning.belief.context import Context
from rumba_cleaning.mission.mission import State
from rumba_cleaning.ros.cleaner.activities import ACTIVITIES, Activity
from rumba_cleaning.ros.cleaner.actuators import Brushes, Wheels
from rumba_cleaning.ros.cleaner.announcer import Announcer
from rumba_cleaning.ros.cleaner.go_to_position import GoToPosition
from rumba_cleaning.ros.cleaner.senses import SECOND, Senses
from rumba_cleaning.ros.cleaner.settings import Settings, robot_of_simulator
from rumba_msg.msg import CleanActionGoal
from rumba_sim.model import map_file
from rumba_sim.model.errors import RumbaError
from rumba_sim.model.geometry import Pose
from rumba_sim.ros.common import node
from rumba_sim.ros.common.maps import map_of_simulator, map_path

PERIOD = 0.2  # [s] of the wall clock, to look after a robot that is silent
SILENCE = 2.0  # [s] of the wall clock, of a robot that is gone
FIRST_SILENCE = 10.0  # [s] of the wall clock, of one that was never heard: it may be about to come
PATIENCE = 5 * SECOND  # [ns] with a robot that does not tell all that a behaviour must know ...
UNREAD = 50  # ... or so many times dock_status without bumper or cliff ...
PATIENCE_WALL = 2.0  # [s] ... and not sooner: at a high speed connections of its topics still come
SETTLING = 2 * SECOND  # [ns] from the end to the result, at most: the robot comes to rest, and the figures come ...
SETTLING_WALL = 5.0  # [s] ... unless time stands still
REST = 0.001  # [m], [rad] from one reading to the next is none


def main() -> None:
    """Run the node."""
    node.run('cleaner', Settings, lambda settings: Cleaner(settings).run())


class Run:
    """A goal that is active, and since when.

    Attributes:
        activity: what is done for it.
        handle: who asked for it.
        outcome: how its behaviour ended; RUNNING until then.
        message: the last word of the behaviour.
        ended: stamp of that; None before it.
    """

    def __init__(self, activity: Activity, handle: Any, senses: Senses) -> None:
        """Begin now."""
        self.activity = activity
        self.handle = handle
        self.outcome = Status.RUNNING
        self.message = ''
        self.ended: Optional[rospy.Time] = None
        self.before = senses.cleaning
        self.pose: Optional[Pose] = None  # at the reading before
        self.begun = self.seen = self.due = senses.passed  # [ns]; the last reading that told all; the next feedback
        self.since = self.seen_wall = time.monotonic()  # this, or its end; and `seen`, of the wall clock

    def see(self, senses: Senses) -> None:
        """A reading told all."""
        self.seen, self.seen_wall, self.before = senses.passed, time.monotonic(), self.before or senses.cleaning

    @property
    def is_unseen(self) -> bool:
        """Whether it is long enough, by the wall clock, that a reading told all."""
        return time.monotonic() - self.seen_wall > PATIENCE_WALL

    def end(self, outcome: Status, message: str, senses: Senses) -> None:
        """The behaviour has ended; what is left is to rest."""
        self.outcome, self.message = outcome, message
        self.ended, self.seen, self.since = senses.stamp, senses.passed, time.monotonic()


class Cleaner:
    """The loop that owns the behaviours; callbacks only queue what it shall do."""

    def __init__(self, settings: Settings) -> None:
        """Read the map and open all topics, services and actions.

        Raises:
            RumbaError: a strategy is unknown, or the map cannot be read.
        """
        strategies.load(settings.strategies)
        strategies.check(settings.strategy)
        self._settings = settings
        self._plan = map_file.load(map_path(settings.map) if settings.map else
                                   map_of_simulator(settings.simulator))
        self._config = robot_of_simulator(settings.simulator)
        self._run: Optional[Run] = None
        self._events: 'queue.Queue[Callable[[], None]]' = queue.Queue()
        self._is_reading_queued = False
        robot = settings.robot
        self._announcer = Announcer(robot)
        self._wheels = Wheels(robot)
        self._brushes = Brushes(robot)
        self._senses = Senses(robot, self._on_reading)
        GoToPosition(robot, self._context(), self._senses)
        self._servers = {name: self._serve(name, activity) for name, activity in ACTIVITIES.items()}
        rospy.on_shutdown(self._wheels.hold)

    def _context(self) -> Context:
        """A memory in which nothing has happened yet."""
        return Context(self._plan, self._config, self._settings.cleaning, self._settings.seed)

    def _serve(self, name: str, activity: Type[Activity]) -> ActionServer:
        """An action server; not a SimpleActionServer, which knows nothing of other actions, and refuses goals with an
        older stamp than the last one had, as all have once a simulator was started anew."""
        server = ActionServer(f'{self._settings.robot}/{name}', activity.action,
                              lambda handle: self._events.put(lambda: self._begin(name, activity, handle)),
                              self._on_cancel, auto_start=False)
        server.start()
        return server

    def run(self) -> None:
        """Do what is asked, until ROS shuts down."""
        if self._settings.autostart:
            self._servers['clean'].internal_goal_callback(CleanActionGoal())
        while not rospy.is_shutdown():
            try:
                event = self._events.get(timeout=PERIOD)
            except queue.Empty:
                event = self._look_after
            event()

    # --- what others do, in threads of rospy --------------------------------------------------------------------------

    def _on_reading(self) -> None:
        if not self._is_reading_queued:  # else the loop is behind: it takes the newest when it comes to it
            self._is_reading_queued = True
            self._events.put(self._read)

    def _on_cancel(self, handle: Any) -> None:
        run = self._run
        if run is not None and run.handle == handle:
            self._wheels.hold()  # at once, even if the loop is planning
        self._events.put(lambda: self._cancel(handle))

    # --- goals --------------------------------------------------------------------------------------------------------

    def _begin(self, name: str, activity: Type[Activity], handle: Any) -> None:
        """Take a goal up, in place of the one before; what cannot be done leaves that one alone."""
        if handle.get_goal_status().status == GoalStatus.RECALLING:
            handle.set_canceled(activity.result(self._senses, 'cancelled'), 'cancelled')
            return
        handle.set_accepted()
        try:
            new = Run(activity(self._context(), handle.get_goal()), handle, self._senses)
        except Exception as error:
            message = _why(error)
            self._announcer.say(f'{name}: refused: {message}')
            handle.set_aborted(activity.result(self._senses, message), message)
            return
        if self._run is not None:
            self._close(self._run, None, f'pre-empted by a goal of {name}')
        self._brushes.forget()
        self._senses.begin()
        self._run = new

    def _cancel(self, handle: Any) -> None:
        if self._run is not None and self._run.handle == handle:
            self._close(self._run, None, 'cancelled')
        self._wheels.release()

    def _close(self, run: Run, outcome: Optional[Status], message: str) -> None:
        """Answer whoever asked; an outcome of None: somebody wants something else."""
        if run.outcome is Status.RUNNING:
            self._rest()
        self._run = None
        try:
            run.activity.behaviour.terminate()
        except Exception as error:
            _why(error)
        result = run.activity.result(self._senses, message)
        seconds = (self._senses.passed - run.begun) / SECOND
        report = run.activity.report(run.before, self._senses.cleaning)
        word = {Status.SUCCEEDED: 'done', Status.FAILED: 'given up', None: 'ended'}[outcome]
        self._announcer.say(f'{word} after {seconds:.0f} s{report}: {message}')
        state = State.STRANDED if outcome is Status.FAILED and self._is_stranded(run) else State.IDLE
        self._announcer.tell(state, '', message, self._senses.stamp, is_due=True)
        answer = {Status.SUCCEEDED: run.handle.set_succeeded, Status.FAILED: run.handle.set_aborted,
                  None: run.handle.set_canceled}[outcome]
        answer(result, message)

    def _is_stranded(self, run: Run) -> bool:
        seen = self._senses.look()
        return run.activity.state is State.STRANDED or (
            seen is not None and seen.state_of_charge <= 0.0 and not seen.is_docked)

    # --- the robot ----------------------------------------------------------------------------------------------------

    def _read(self) -> None:
        """Act upon the newest reading."""
        self._is_reading_queued = False
        run = self._run
        if run is None:
            return
        observation = self._senses.observe()
        if observation is None:
            if self._senses.passed - run.seen > PATIENCE and run.is_unseen:
                self._close(run, Status.FAILED, self._senses.missing())
        elif run.outcome is Status.RUNNING:
            run.see(self._senses)
            self._act(run, observation)
        else:
            self._settle(run, observation.pose)

    def _act(self, run: Run, observation: Observation) -> None:
        behaviour = run.activity.behaviour
        command = self._update(run, observation)
        if behaviour.status is Status.RUNNING:
            self._wheels.drive(command)
            self._brushes.want(command.brushes_up)
        else:
            self._rest()
            run.end(behaviour.status, behaviour.message, self._senses)
        is_due = self._senses.passed >= run.due
        self._announcer.tell(run.activity.state, run.activity.strategy, behaviour.message, self._senses.stamp, is_due)
        if is_due:
            run.due = max(run.due + SECOND, self._senses.passed + 1)
            run.handle.publish_feedback(run.activity.feedback(self._senses, self._announcer.status))

    def _update(self, run: Run, observation: Observation) -> Command:
        """What the behaviour says; where that goes wrong, it has failed."""
        behaviour = run.activity.behaviour
        try:
            return behaviour.update(observation)
        except Exception as error:
            return behaviour.fail(_why(error))

    def _rest(self) -> None:
        self._wheels.stop()
        if not self._senses.is_alone:
            self._brushes.want(STOP.brushes_up)

    def _settle(self, run: Run, pose: Pose) -> None:
        """Answer once the robot is at rest and the figures are those of the end."""
        last, run.pose = run.pose, pose
        is_at_rest = last is not None and max(abs(now - then) for now, then in zip(pose, last)) < REST
        cleaning = self._senses.cleaning
        has_figures = not run.activity.needs_figures or cleaning is not None and cleaning.header.stamp > run.ended
        if is_at_rest and has_figures or self._senses.passed - run.seen > SETTLING:
            self._close(run, run.outcome, run.message)

    def _look_after(self) -> None:
        """Nothing comes: the robot is gone, or time stands still."""
        run = self._run
        if run is None:
            return
        now = time.monotonic()
        silence = SILENCE if self._senses.stamp is not None else FIRST_SILENCE
        if self._senses.is_alone and now - max(self._senses.heard, run.since) > silence:
            self._close(run, Status.FAILED, 'the robot is gone')
        elif self._senses.unread > UNREAD and run.is_unseen:
            self._close(run, Status.FAILED, self._senses.missing())
        elif run.outcome is not Status.RUNNING and now - run.since > SETTLING_WALL:
            self._close(run, run.outcome, run.message)


def _why(error: Exception) -> str:
    """What went wrong, for a person; of a strategy, which may be anybody's, the log tells where."""
    if isinstance(error, RumbaError):
        return str(error)
    rospy.logerr(traceback.format_exc())
    return f'{type(error).__name__}: {error}'
