"""cleaner: has one Rumba clean its floor and come home to charge; drives it to its dock, off it, or to a pose.

Below the robot's name it serves the actions
  clean    rumba_msg/Clean    undock   rumba_msg/Undock
  dock     rumba_msg/Dock     go_to    rumba_msg/GoTo
of which one runs at a time: a new goal preempts the one before. A goal of clean with `resume` goes on with the last
cleaning that was preempted or cancelled, or whose robot was gone. After a reset of the simulator, the active goal
begins again, and no cleaning can be resumed; a goal ends if the simulator is started again, or if this node ends. It
serves
  go_to_position    rumba_msg/TargetPosition: which velocity, or heading, now leads toward a target; a node that serves
                    it already keeps it; not served without a map (mapless)
publishes
  mission_status    rumba_msg/MissionStatus: latched; at each change, and at 1 Hz while a goal is active
  team_report       rumba_msg/TeamReport: what it tells its mates
  team_plan         rumba_msg/TeamPlan: latched; where it will drive, for its mates
  cmd_vel           geometry_msgs/Twist: while a goal is active, as often as dock_status comes
subscribes to
  bumper            rumba_msg/Bumper        cliff             rumba_msg/Cliff
  dock_status       rumba_msg/DockStatus    battery_state     sensor_msgs/BatteryState
  cleaning_status   rumba_msg/CleaningStatus
  teleop/cmd_vel    geometry_msgs/Twist: while a person drives, and for 0.5 s after, the cleaner commands nothing
to scan (sensor_msgs/LaserScan) if it goes by its laser,
to team_report and team_plan of its mates, the robots of its team,
and to /tf and /tf_static for map -> odom -> base_footprint; without a map, the pose is odom -> base_footprint. It takes
part in a lockstep by simulator/lockstep and simulator/lockstep_answers (rumba_msg/Lockstep, LockstepAnswer), and uses
the service
  set_brushes_up    std_srvs/SetBool
The map and the shape of the robot are those of the simulator in the same namespace, from
  simulator/state   rumba_msg/SimulatorState
The stamps of dock_status are its clock.

Parameters, as in `rosrun rumba_cleaning cleaner _robot:=rumba2 _strategy:=bounce`:
"""

import os
import queue
import threading
from typing import Any, Callable, Optional

import rospy
from actionlib_msgs.msg import GoalStatus

from rumba_cleaning import strategies
from rumba_cleaning.belief.context import Context, own_seed
from rumba_cleaning.belief.mates import Report, Task
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.ros.cleaner.goals import foresight
from rumba_cleaning.ros.cleaner.goals.action_server import Server
from rumba_cleaning.ros.cleaner.goals.activities import ACTIONS, Activity, Cleaning
from rumba_cleaning.ros.cleaner.goals.executor import DaemonExecutor, Planners
from rumba_cleaning.ros.cleaner.goals.go_to_position import GoToPosition
from rumba_cleaning.ros.cleaner.goals.interruption import Interruption
from rumba_cleaning.ros.cleaner.goals.run import Run, describe
from rumba_cleaning.ros.cleaner.goals.settings import Settings
from rumba_cleaning.ros.cleaner.goals.survey import SurveyListener
from rumba_cleaning.ros.cleaner.goals.workplace import Workplace, World
from rumba_cleaning.ros.cleaner.robots import conversions
from rumba_cleaning.ros.cleaner.robots.robot import Robot
from rumba_msg.msg import CleanActionGoal
from rumba_sim.model.common.errors import RumbaError
from rumba_sim.ros.common.own_robots import own_robot
from rumba_sim.ros.participants.lockstep import Work
from rumba_sim.ros.running import node

LOOK_PERIOD = 0.2  # [s] of the wall clock from one look after a silent robot to the next
PLANNERS = 4  # threads: a plan that is not needed any more may occupy one for seconds, and the next goal needs another
END = 'the cleaner ends'
END_WITHIN = 8.0  # [s] of the wall clock for the loop to notice that; then its goal is answered without it ...
FORCED_AFTER = 4.0  # ... and after this [s] the process ends without it: roslaunch kills it after 15 s


def main() -> None:
    """Run the node."""
    node.run('cleaner', Settings, lambda settings: Cleaner(settings).run(), is_single=True)


class Cleaner:
    """The loop that owns the behaviours; callbacks only queue what it is to do."""

    def __init__(self, settings: Settings) -> None:
        """Read the map and open all topics, services and actions.

        Raises:
            RumbaError: a strategy is unknown, the map cannot be read, there is no simulator that tells one, or another
                cleaner works for the robot.
        """
        strategies.load(settings.strategies)
        (strategies.check_mapless if settings.mapless else strategies.check)(settings.strategy)
        self._settings, own = settings, own_robot(settings.own_robot)
        self._work = Work()
        self._events: 'queue.Queue[Callable[[], None]]' = queue.Queue()
        self._has_ended = threading.Event()
        self._workplace = Workplace(settings.map, lambda: self._events.put(self._look_at_world),
                                    SurveyListener(settings.robot) if settings.mapping else None,
                                    has_map=not settings.mapless, own=own, docks=settings.docks,
                                    home=settings.home_pose)
        self._world: Optional[World] = self._workplace.world  # that of the goal and of the cleaning below
        self._run: Optional[Run] = None
        self._interruption = Interruption()
        self._is_missed = False  # whether the last goal ended because there were no readings, and there are none yet
        self._read_stamp: Optional[rospy.Time] = None  # of the newest reading that was acted upon
        self._is_reading_postponed = False
        self._is_reading_queued = True  # by `run`, after the goal of autostart
        self._planners = Planners(DaemonExecutor(PLANNERS), lambda: self._workplace.lockstep is not None,
                                  lambda: self._events.put(self._read_postponed))
        self._robot = Robot(settings.robot, self._on_reading, settings.team.split(),
                            lambda: self._events.put(self._read_postponed), lambda: self._workplace.lockstep,
                            lambda: self._work.goes_on or self._planners.are_at_work, settings.laser,
                            settings.mapless, own, settings.docks)
        if not settings.mapless:
            GoToPosition(settings, self._workplace, self._robot.senses)
        self._servers = {name: self._serve(name) for name in ACTIONS}
        if not rospy.core.is_shutdown_requested():
            rospy.on_shutdown(self._end)
        if rospy.core.is_shutdown_requested():  # rospy may not call `_end` any more
            self._has_ended.set()

    def _serve(self, name: str) -> Server:
        """The server of an action."""
        return Server(f'{self._settings.robot}/{name}', ACTIONS[name].type,
                      lambda handle: self._events.put(lambda: self._accept(name, handle)),
                      lambda handle: self._events.put(lambda: self._cancel(handle)),
                      lambda code, message: self._result(name, code, message))

    def run(self) -> None:
        """Handle events until ROS shuts down."""
        if self._settings.autostart:
            self._servers['clean'].internal_goal_callback(CleanActionGoal())
        self._events.put(self._read)
        self._work.rest()
        while not self._has_ended.is_set():
            try:
                event = self._events.get(timeout=LOOK_PERIOD)
            except queue.Empty:
                event = self._look_after
            try:
                with self._work:
                    event()
            except (Exception, SystemExit) as error:  # a strategy may raise anything
                self._close(Outcome.ERROR, describe(error))

    def _end(self) -> None:
        """Called in a thread of rospy while its topics are still open: have no goal and no wheel go on."""
        self._events.put(self._finish)
        if not self._has_ended.wait(END_WITHIN):
            rospy.logerr(f'the strategy has not returned for {END_WITHIN:g} s: the cleaner ends without it')
            self._run = None  # its goal is answered below
            threading.Thread(target=self._force_end, daemon=True).start()
        for server in self._servers.values():
            server.close(END)
        self._robot.wheels.close()
        self._robot.participant.leave()

    def _finish(self) -> None:
        self._interrupt(Outcome.FAILED, END)
        self._has_ended.set()

    def _force_end(self) -> None:
        if not self._has_ended.wait(FORCED_AFTER):
            os._exit(node.OWN_ERROR)

    # --- the simulator --------------------------------------------------------------------------------------------

    def _look_at_world(self) -> None:
        """Notice whether the simulator was started again, or reset, since the last look."""
        before, self._world = self._world, self._workplace.world
        if before is None or self._world is None or before == self._world:
            return
        is_new_run = before.run != self._world.run
        self._interruption.forget()
        self._forget_plans()
        self._read_stamp = None
        self._robot.senses.forget(self._world.since, is_new_run)
        if is_new_run:
            self._close(Outcome.NO_READINGS, 'the robot is gone: the simulator was started again')
        elif self._run is not None:
            self._run.begin_again()

    # --- readings -------------------------------------------------------------------------------------------------

    def _on_reading(self) -> None:
        """Called in a thread of rospy."""
        if not self._is_reading_queued:  # else the loop is behind, and takes the newest reading when it gets there
            self._is_reading_queued = True
            self._events.put(self._read)

    def _read(self) -> None:
        self._is_reading_queued = False
        stamp = self._robot.senses.stamp
        if stamp is None or stamp == self._read_stamp:
            return
        is_lockstep = self._workplace.lockstep is not None
        self._is_reading_postponed = self._planners.are_at_work or is_lockstep and not self._robot.team.have_told(
            self._read_stamp)
        if self._is_reading_postponed:
            return
        self._read_stamp = stamp
        self._planners.deliver()
        self._robot.wheels.forget()
        activities = self._run.activity if self._run is not None else None, self._interruption.cleaning
        listeners = [activity.hear for activity in activities if activity is not None]
        self._robot.team.listen(listeners, stamp, before=stamp if is_lockstep else None)
        try:
            if self._run is not None:
                self._run.read()
                self._forget_closed()
            elif self._is_missed and self._robot.senses.look() is not None:
                self._is_missed = False
                self._robot.announcer.welcome(stamp)
        finally:
            self._tell_mates(stamp)
            self._robot.answer(rests=self._run is None)

    def _tell_mates(self, stamp: rospy.Time) -> None:
        pose = None if self._robot.team.is_alone else self._robot.senses.pose()
        if pose is not None:
            self._robot.team.tell(Report(pose, True, Task.OFF) if self._run is None else self._run.activity.for_mates(
                pose), stamp)

    def _read_postponed(self) -> None:
        """The planners, or the mates, may have done what the world waits for."""
        if self._is_reading_postponed:
            self._read()

    def _look_after(self) -> None:
        self._robot.look_after()
        self._read_postponed()
        if self._run is not None:
            self._run.look_after()
            self._forget_closed()

    def _forget_closed(self) -> None:
        if self._run is not None and self._run.is_closed:
            self._is_missed = self._run.outcome is Outcome.UNKNOWN
            self._interruption.keep(self._run)
            self._run = None

    # --- goals ----------------------------------------------------------------------------------------------------

    def _accept(self, name: str, handle: Any) -> None:
        """Begin with a goal in place of the one before; one that is refused leaves that alone."""
        if handle.get_goal_status().status == GoalStatus.RECALLING:
            handle.set_canceled(self._result(name, Outcome.CANCELLED, 'cancelled'), 'cancelled')
            return
        self._robot.participant.wake()
        handle.set_accepted()
        try:
            self._begin(name, handle)
        except (Exception, SystemExit) as error:  # a strategy may raise anything
            code, message = Outcome.REFUSED if isinstance(error, RumbaError) else Outcome.ERROR, describe(error)
            self._robot.announcer.say(f'{name}: refused: {message}')
            handle.set_aborted(self._result(name, code, message), message)

    def _begin(self, name: str, handle: Any) -> None:
        """Begin with an accepted goal.

        Raises:
            RumbaError: the goal cannot be carried out.
        """
        self._look_at_world()
        activity = self._activity(name, handle.get_goal())
        self._interrupt(Outcome.PREEMPTED, f'preempted by a goal of {name}')
        if isinstance(activity, Cleaning):
            self._interruption.forget()
        self._is_missed = False
        self._run = Run(activity, handle, self._robot)

    def _result(self, name: str, code: Outcome, message: str) -> Any:
        return ACTIONS[name].result(self._robot.senses, conversions.outcome(code, message))

    def _activity(self, name: str, goal: Any) -> Activity:
        """What to do for a goal.

        Raises:
            RumbaError: the goal cannot be carried out.
        """
        if name == 'clean' and goal.resume:
            return self._interruption.rest(self._run, goal.time_limit)
        context = self._context()
        activity = ACTIONS[name].activity(context, goal)
        if name == 'clean':
            foresight.warn(context, self._settings.cleaning, self._robot.senses.pose())
        return activity

    def _context(self) -> Context:
        """What the robot knows at first.

        Raises:
            RumbaError: the map cannot be read, or the settings of the simulator are invalid.
        """
        seed = own_seed(self._settings.seed, self._settings.robot)
        if self._settings.mapless:
            return Context.without_map(self._workplace.robot(), self._settings.cleaning, seed)
        plan, robot = self._workplace.look()
        context = Context(plan, robot, self._settings.cleaning, seed, self._planners, self._workplace.survey,
                          self._robot.team.mates())
        settings = self._settings
        context.has_dock, context.docks_itself = settings.docks or not settings.own_robot, settings.docks
        context.end = settings.home_pose
        pose = self._robot.senses.pose()
        if self._robot.team.is_alone and pose is not None:
            context.moor(pose)
        return context

    def _cancel(self, handle: Any) -> None:
        if self._run is not None and self._run.handle == handle:
            self._interrupt(Outcome.CANCELLED, 'cancelled')

    def _interrupt(self, outcome: Outcome, message: str) -> None:
        """End the goal that is active, if there is one, and keep its cleaning to be resumed."""
        run, self._run = self._run, None
        if run is None:
            return
        self._forget_plans()
        self._interruption.keep(run)
        run.interrupt(outcome, message)

    def _close(self, outcome: Outcome, message: str) -> None:
        """End the goal that is active, if there is one, for good."""
        run, self._run = self._run, None
        self._forget_plans()
        if run is not None and not run.is_closed:
            run.close(outcome, message)
            self._is_missed = outcome is Outcome.NO_READINGS

    def _forget_plans(self) -> None:
        if self._planners.forget():
            self._events.put(self._read_postponed)
