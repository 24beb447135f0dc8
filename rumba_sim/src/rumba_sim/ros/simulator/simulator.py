"""simulator: Rumbas on a map, in real time or faster, without a window.

For each robot, below its name (rumba, rumba2, ...), it publishes
  battery_status   rumba_msg/BatteryStatus    battery_state   sensor_msgs/BatteryState
  odom             nav_msgs/Odometry          ground_truth    nav_msgs/Odometry
  scan             sensor_msgs/LaserScan      bumper          rumba_msg/Bumper
  cliff            rumba_msg/Cliff            dock_status     rumba_msg/DockStatus
  cleaning_status  rumba_msg/CleaningStatus   coverage        nav_msgs/OccupancyGrid
subscribes to
  cmd_vel          geometry_msgs/Twist: linear.x [m/s], angular.z [rad/s]
  teleop/cmd_vel   geometry_msgs/Twist: the same from a person; overrides cmd_vel until 0.5 s after its last message
and serves
  set_brushes_up   std_srvs/SetBool           teleport        rumba_msg/Teleport
It publishes simulator/state (rumba_msg/SimulatorState, latched), /map, /tf, /tf_static and /diagnostics, and also
/clock if time is simulated: at any speed except 1, or if /use_sim_time is true. It serves /static_map and, below its
own name, pause, resume, reset, digest (std_srvs/Trigger), step (rumba_msg/Step), spawn (rumba_msg/Spawn), kill
(rumba_msg/Kill), add_obstacle (rumba_msg/AddObstacle) and remove_obstacle (rumba_msg/RemoveObstacle). It publishes
simulator/obstacles (visualization_msgs/MarkerArray) for those who want to see them. With localisation:=slam, /map is
that of the robot: those who look on get the true one on simulator/map (nav_msgs/OccupancyGrid, latched), in the frame
world of all that only the simulator knows, and world -> map on /tf_static. In lockstep it publishes simulator/lockstep
(rumba_msg/Lockstep), and waits for those who answer on simulator/lockstep_answers (rumba_msg/LockstepAnswer).
rqt_reconfigure shows it as NAME/tuning; the parameters NAME/settings are the settings in force. The parameter
interface adds the topics and frames of another robot, such as /scan, /odom and /cmd_vel of a TurtleBot3:
docs/own_node.md. In an examination it publishes and serves nothing that the robot could not know: the judge,
mission_test, gets that over a private socket.

Parameters, as in `rosrun rumba_sim simulator _map:=studio _speed:=10 _battery/drain:=60`:
"""

import contextlib
import gc
import time
import uuid
from typing import Any, Callable, Dict, Optional, Tuple

import rospy
from std_srvs.srv import Trigger, TriggerResponse

from rumba_msg.srv import (
    AddObstacle, AddObstacleResponse, Kill, KillResponse, RemoveObstacle, RemoveObstacleResponse, Spawn, SpawnResponse,
    Step, StepResponse)
from rumba_sim.model.common.config import updated
from rumba_sim.model.common.errors import ConfigError, RumbaError, WorldError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps import map_file
from rumba_sim.model.remarks import remarks
from rumba_sim.model.simulation import obstacle_file
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.common.paths import absolute
from rumba_sim.ros.participants.examiner import ExaminerServer, socket_path
from rumba_sim.ros.participants.maps import map_path, refuse_second, tell_map
from rumba_sim.ros.participants.requests import Requests
from rumba_sim.ros.participants.simulator_client import SETTINGS
from rumba_sim.ros.robot.localisation import map_topic, true_frame
from rumba_sim.ros.robot.state_publisher import StatePublisher, tell_settings
from rumba_sim.ros.running import master_watch, node, peers
from rumba_sim.ros.running.peers import NO_ANSWER
from rumba_sim.ros.simulator import reconfigure
from rumba_sim.ros.simulator.diagnostics import Diagnostics
from rumba_sim.ros.simulator.fleet import Fleet
from rumba_sim.ros.simulator.lockstep import Lockstep
from rumba_sim.ros.simulator.obstacle_board import ObstacleBoard
from rumba_sim.ros.simulator.pace import Pace, wake_on_time
from rumba_sim.ros.simulator.settings import TUNABLE, Settings
from rumba_sim.ros.simulator.simulated_time import SimulatedTime
from rumba_sim.ros.simulator.state_file import StateFile

TUNING = 'tuning'  # below the node's name: the parameters of dynamic_reconfigure
MAX_STEP = 1_000_000  # [ticks] of one call


def main() -> None:
    """Run the node."""
    node.run('simulator', Settings, lambda settings: Simulator(settings).run(), own_clock=True,
             own_parameters=[TUNING, SETTINGS], is_single=True)


class Simulator:
    """The world, the loop that owns it, and what the robots publish and serve."""

    def __init__(self, settings: Settings) -> None:
        """Create the world and open all topics and services.

        Raises:
            RumbaError: the map or a setting is wrong, or another simulator is running.
        """
        refuse_second()
        self._settings = settings
        self._requests = Requests()
        self._is_paused = False
        path = map_path(settings.map)
        plan = map_file.load(path, settings.robot.drive.radius)
        self._file = StateFile(settings)
        obstacles = obstacle_file.load(absolute(settings.obstacles)) if settings.obstacles else []
        saved, self._ticks = self._file.world(plan, settings, obstacles)
        self._world = saved or World(plan, settings.robot, settings.step_rate, settings.seed, obstacles)
        for remark in remarks(self._world):
            rospy.logwarn(remark)
        self._pace = Pace(settings.step_rate, settings.speed, is_time_simulated(settings), self._ticks)
        self._run = uuid.uuid4().hex
        self._examiner = ExaminerServer(socket_path()) if settings.exam else None
        self._lockstep = self._lockstep_of(settings)
        self._diagnostics = Diagnostics(settings.map)
        self._fleet = Fleet(self._world, settings, self._requests, self._diagnostics, lambda: self._pace.stamp,
                            self._is_held, self._on_command, self._examiner)
        frame = true_frame(settings.localisation)
        self._obstacles = ObstacleBoard(self._world, self._requests, lambda: self._pace.stamp, frame,
                                        settings.exam)
        for _ in range(0 if saved else settings.robots):
            self._fleet.spawn()
        self._file.begin(self._world, self._ticks)
        tell_map(self._world.plan, self._pace.stamp, map_topic(settings.localisation, settings.exam), frame)
        self._state = StatePublisher(settings.told, path, settings.step_rate, self._pace.is_simulated, self._run,
                                     self._lockstep is not None)
        self._serve()
        self._publish_state()
        if self._examiner is not None:
            self._examiner.open(self._lockstep is not None, self._on_examiner)

    def _serve(self) -> None:
        if self._settings.exam:
            return  # nobody pauses, changes or tunes the world
        for name, service, response, act in (
                ('pause', Trigger, TriggerResponse, lambda _: self._pause(True)),
                ('resume', Trigger, TriggerResponse, lambda _: self._pause(False)),
                ('reset', Trigger, TriggerResponse, self._reset),
                ('digest', Trigger, TriggerResponse, lambda _: (f'{self._world.digest()} {self._world.tick}',)),
                ('step', Step, StepResponse, lambda request: self._step(request.ticks)),
                ('spawn', Spawn, SpawnResponse, self._spawn),
                ('kill', Kill, KillResponse, self._kill),
                ('add_obstacle', AddObstacle, AddObstacleResponse, self._obstacles.add),
                ('remove_obstacle', RemoveObstacle, RemoveObstacleResponse, self._obstacles.remove)):
            rospy.Service(f'~{name}', service, self._handler(response, act))
        tuning = reconfigure.serve(self._settings, TUNABLE, TUNING, self._on_tuning)
        master_watch.after_return(lambda: tuning.update_configuration({}))

    def _handler(self, response: Any, act: Callable[[Any], Tuple[Any, ...]]) -> Callable[[Any], Any]:
        """A service that has the loop act; an error becomes its answer."""
        def handle(request: Any) -> Any:
            try:
                return response(True, *self._requests.call(lambda: act(request)))
            except RumbaError as error:
                return response(success=False, message=str(error))
            except rospy.ROSException:
                if not rospy.is_shutdown():
                    raise
                return response(success=False, message='the simulator ends')
        return handle

    # --- the loop -------------------------------------------------------------------------------------------------

    def run(self) -> None:
        """Simulate until ROS shuts down; then save, also if that closes a topic while this publishes."""
        wake_on_time()
        gc.freeze()  # what there is now remains: collections of garbage need not look at it, and take no time
        if self._lockstep is not None:
            self._lockstep.wait_for_commanders(self._report_and_hold)
        try:
            while not rospy.is_shutdown():
                self._go_on()
        except Exception:
            if not rospy.core.is_shutdown_requested():
                raise
        self._file.save(self._world, self._ticks)

    def _go_on(self) -> None:
        if self._is_paused:
            self._pace.hold()
        else:
            self._tick()
            self._pace.next_tick()
        self._serve_requests()
        self._wait_for_answers()

    def _serve_requests(self) -> None:
        """Carry out requests until the next tick is due, and report when a report is due."""
        while not rospy.is_shutdown():
            self._requests.serve(min(self._pace.due, self._state.due))
            self._report()
            if time.monotonic() >= self._pace.due:
                return

    def _wait_for_answers(self, but: str = '') -> None:
        """In lockstep, carry out requests until everybody has answered, other than the node `but`."""
        if self._lockstep is not None:
            self._lockstep.wait(self._report_and_hold, but)

    def _report_and_hold(self) -> None:
        self._report()
        self._pace.tell_again()

    def _report(self) -> None:
        """Publish state and diagnostics, if they are due."""
        if time.monotonic() >= self._state.due:
            self._publish_state()
            self._diagnostics.update(self._pace.stamp, self._state.real_time_factor, self._pace.speed, self._pace.late)

    def _publish_state(self) -> None:
        self._state.publish(self._ticks, self._pace.stamp, self._is_paused, self._pace.speed)

    def _tick(self) -> None:
        self._fleet.apply_commands()
        self._world.step()
        self._ticks += 1
        due = self._settings.paced_rates.due(self._ticks, self._settings.step_rate)
        is_bundled = not due.sensors and self._is_bundled
        self._pace.tick(is_told=not is_bundled)
        self._fleet.publish(due, keep_transforms=is_bundled)
        self._obstacles.publish_if_due(self._ticks)
        if self._lockstep is not None:
            self._lockstep.publish(due, self._pace.stamp, self._state.resets)
        self._file.save_if_due(self._world, self._ticks)

    @property
    def _is_bundled(self) -> bool:
        """Whether clock and transforms wait for the next control tick, since time passes as fast as possible."""
        return self._pace.speed == 0.0 and not self._is_paused and self._settings.rates.sensors > 0

    # --- lockstep -------------------------------------------------------------------------------------------------

    def _lockstep_of(self, settings: Settings) -> Optional[Lockstep]:
        """The lockstep that the settings ask for, or None."""
        if settings.lockstep == 'false' or settings.lockstep == 'auto' and not self._pace.is_simulated:
            return None
        return Lockstep(self._requests, self._run, settings.wait_for, settings.lockstep_patience,
                        lambda topic: self._fleet.is_commanded(topic), self._examiner)

    def _wake_participants(self) -> None:
        if self._lockstep is not None:
            self._lockstep.wake()

    def _on_command(self, topic: str) -> None:
        """Called in threads of rospy."""
        if self._lockstep is not None:
            self._lockstep.on_command(topic)

    def _on_examiner(self, answer: Any) -> None:
        """Called in the thread of the channel."""
        if self._lockstep is not None:
            self._lockstep.on_examiner(answer)

    def _is_held(self) -> bool:
        return self._lockstep is not None and self._lockstep.is_waiting

    # --- services -------------------------------------------------------------------------------------------------

    def _pause(self, is_paused: bool) -> Tuple[str]:
        self._is_paused = is_paused
        self._wake_participants()
        self._fleet.publish_transforms()
        self._pace.hurry()
        self._publish_state()
        return ('paused' if is_paused else 'running',)

    def _reset(self, request: Any) -> Tuple[str]:
        self._wait_for_answers(but=peers.caller(request))  # no command for this world shall come to the next one
        self._fleet.forget_commands()
        if self._lockstep is not None:
            self._lockstep.reset()
        self._world.reset()
        self._obstacles.publish()
        self._state.resets += 1
        self._publish_state()
        return ('everything is as it was at the start, except the time',)

    def _step(self, ticks: int) -> Tuple[str]:
        if not self._is_paused:
            raise WorldError('the simulation is running: pause it first')
        if not 1 <= ticks <= MAX_STEP:
            raise WorldError(f'ticks is {ticks}: must be 1 to {MAX_STEP}')
        self._wake_participants()
        for _ in range(ticks):
            if rospy.is_shutdown():
                raise WorldError('the simulator ends')
            self._tick()
            self._wait_for_answers()
            self._report()
        self._publish_state()
        return (f'{ticks} ticks have passed',)

    def _spawn(self, request: Any) -> Tuple[str, str]:
        return self._fleet.spawn(request.name, Pose(request.pose.x, request.pose.y, request.pose.theta)), ''

    def _kill(self, request: Any) -> Tuple[str]:
        self._wait_for_answers(but=peers.caller(request))  # afterwards, nobody could
        self._fleet.kill(request.name)
        return ('',)

    def _on_tuning(self, values: Dict[str, Any]) -> Settings:
        settings: Settings = self._requests.call(lambda: self._tune(values))
        tell_settings(settings)
        self._requests.post(self._publish_state)
        return settings

    def _tune(self, values: Dict[str, Any]) -> Settings:
        """Apply new settings if they are valid; returns the settings in force."""
        try:
            settings = updated(self._settings, values, TUNING)
            if settings.speed != 1.0 and not self._pace.is_simulated:
                raise ConfigError('speed can change only if /clock is published: start with a speed other than 1, or '
                                  'with /use_sim_time true')
            self._world.config = settings.robot
            self._settings = self._fleet.settings = settings
            self._pace.speed = settings.speed
        except ConfigError as error:
            rospy.logerr(str(error))
        return self._settings


def is_time_simulated(settings: Settings) -> bool:
    """Whether time is that of /clock; if the settings ask for it, this sets /use_sim_time until the node ends."""
    parameter = SimulatedTime(rospy.get_name())
    if settings.speed == 1.0 and settings.lockstep != 'true':
        mended = parameter.mend()
        if mended:
            rospy.logwarn(mended)
        if parameter.found():
            rospy.loginfo('/use_sim_time is true: this simulator publishes /clock')
        return parameter.found()
    rospy.on_shutdown(lambda: forget_simulated_time(parameter))
    if not parameter.claim():
        rospy.loginfo('time is simulated: /use_sim_time is now true; nodes that started before keep to the wall clock')
    master_watch.after_return(parameter.claim)
    return True


def forget_simulated_time(parameter: SimulatedTime) -> None:
    """Make /use_sim_time what it was."""
    with contextlib.suppress(*NO_ANSWER):  # the master has ended
        parameter.restore()
