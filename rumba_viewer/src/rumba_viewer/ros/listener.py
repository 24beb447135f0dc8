"""Listens to a simulation, whichever of its nodes come and go, and makes snapshots of what there is to show."""

import http.client
import math
import threading
import time
import xmlrpc.client
from typing import Any, Callable, Dict, NamedTuple, Optional, Tuple

import rosgraph
import rospy
from visualization_msgs.msg import MarkerArray

from rumba_msg.msg import SimulatorState
from rumba_sim.model.common.errors import RumbaError, one_line
from rumba_sim.model.maps import map_file
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.ros.common import obstacle_markers
from rumba_sim.ros.participants.simulator_client import TOPIC, robot_config
from rumba_viewer.ros import readings, ros_graph
from rumba_viewer.ros.map_listener import MapListener, Maps
from rumba_viewer.ros.readings import State
from rumba_viewer.ros.robot_listener import RobotListener
from rumba_viewer.ros.subscription import Subscription
from rumba_viewer.scene.dock_field import docks
from rumba_viewer.scene.map_frame import on_floor
from rumba_viewer.scene.snapshot import Grid, MapFeatures, Obstacle, Robot, Simulation, Size, Snapshot

# What is raised if the master or the simulator ends during a call.
GONE = (rospy.ROSException, rosgraph.MasterException, xmlrpc.client.Error, http.client.HTTPException, OSError)
LOOK_PERIOD = 1.0  # [s] from one look at the graph to the next
SILENCE = 3.0  # [s] of the wall clock, after which a silent simulator or robot counts as gone
ERROR_PERIOD = 10.0  # [s] of the wall clock between two lines about the same trouble
COVERAGE_PERIOD = 0.2  # [s] of the wall clock, at least, from one picture of the coverage to the next


class Heard(NamedTuple):
    """The newest state of a simulator, and when it came, on the wall clock [s]."""

    state: Optional[State] = None
    came: float = -math.inf


class MapFiles(NamedTuple):
    """What the files of a map contain, and the properties of the robots on it.

    Attributes:
        features, config: defaults if they cannot be read.
        of: node, map and grid to which they belong.
    """

    features: MapFeatures = MapFeatures()
    config: RobotConfig = RobotConfig()
    of: Tuple[Any, ...] = ()


class Listener:
    """Looks at the graph in a thread of its own; callbacks of rospy store; the window asks.

    What several threads use is replaced as a whole and never changed, so that each of them sees a consistent value.
    """

    def __init__(self, robot: str, shows_laser: bool) -> None:
        """Select a robot by its name, and show its laser or not, once it is started."""
        self._wanted = robot, shows_laser
        self._on_master: Callable[[], object] = lambda: None
        self._graph = ros_graph.RosGraph()
        self._master = ''  # the one at which this node is registered
        self._robots: Dict[str, RobotListener] = {}
        self._subscriptions: Tuple[Subscription[Any], ...] = ()
        self._map_listener: Optional[MapListener] = None
        self._obstacles: Tuple[Obstacle, ...] = ()
        self._coverage: Tuple[Optional[Grid], float] = (None, 0.0)  # that is shown, and since when
        self._files, self._heard = MapFiles(), Heard()
        self._before = -math.inf  # when the last snapshot was made
        self._is_news, self._wake = True, threading.Event()

    def start(self, on_master: Callable[[], object]) -> None:
        """Begin to listen; `on_master` is called in the thread for each new master, where this node is unknown yet."""
        self._on_master = on_master
        threading.Thread(target=self._look_around, daemon=True).start()

    def select(self, robot: str, shows_laser: bool) -> None:
        """Select another robot, or show its laser or not."""
        self._wanted = robot, shows_laser
        self._wake.set()

    def _tell(self) -> None:
        self._is_news = True

    # --- the thread ---------------------------------------------------------------------------------------------------

    def _look_around(self) -> None:
        while not rospy.is_shutdown():
            try:
                self._follow(ros_graph.look())
            except GONE:
                pass
            except Exception as error:  # whatever parameters and files of others contain, the next look may do better
                if not rospy.is_shutdown():
                    rospy.logerr_throttle(ERROR_PERIOD, 'cannot follow the simulation: ' + one_line(
                        f'{type(error).__name__}: {error}'))
            self._wake.wait(LOOK_PERIOD)
            self._wake.clear()

    def _follow(self, graph: ros_graph.RosGraph) -> None:
        """Listen to the robots that are there, and stop listening to the others."""
        if graph != self._graph:
            self._graph = graph
            self._tell()
        if not graph.master:
            return
        if graph.master != self._master:
            if not graph.robots and any(robot.is_connected for robot in self._robots.values()):
                return  # a new master that knows no robot: the connections of the old one still work
            self._start_anew()
            self._master = graph.master  # not before all of it has worked
        before, (selected, shows_laser) = self._robots, self._wanted
        self._robots = {name: before.get(name) or RobotListener(name, self._tell) for name in graph.robots}
        for name in set(before) - set(graph.robots):
            before[name].close()
        for name, robot in self._robots.items():
            large = {'coverage', *(['scan'] if shows_laser else [])} if name == selected else set()
            robot.subscribe_large(large)
        self._read_map_files()

    def _start_anew(self) -> None:
        before, self._robots, self._heard = self._robots, {}, Heard()
        for robot in before.values():
            robot.close()
        for subscription in self._subscriptions:
            subscription.close()
        if self._map_listener is not None:
            self._map_listener.close()
        self._map_listener = MapListener(self._on_floor, self._tell)
        self._subscriptions = (
            Subscription(TOPIC, SimulatorState, readings.state, self._on_state, queue_size=10),
            Subscription(obstacle_markers.TOPIC, MarkerArray, readings.obstacles, self._on_obstacles))
        self._on_master()

    def _read_map_files(self) -> None:
        """Read the files of the simulator's map, once for each map."""
        state, plan = self._heard.state, self._maps.plan
        if state is None or (state.node, state.map, plan) == self._files.of:
            return
        config, features = self._files.config, MapFeatures()
        try:
            config = robot_config(state.node)
            floor = map_file.load(state.map, config.drive.radius)
            features = MapFeatures(docks(floor, config), floor.carpet, floor.cliff, True)
        except RumbaError:  # the simulator runs on another machine
            pass
        self._files = MapFiles(features, config, (state.node, state.map, plan))
        self._tell()

    # --- callbacks ----------------------------------------------------------------------------------------------------

    def _on_floor(self) -> None:
        for robot in self._robots.values():
            robot.forget()
        self._wake.set()
        self._tell()

    def _on_state(self, state: State) -> None:
        before, self._heard = self._heard.state, Heard(state, time.monotonic())
        if before is None or (state.node, state.map) != (before.node, before.map):
            self._wake.set()
        self._tell()

    def _on_obstacles(self, obstacles: Tuple[Obstacle, ...]) -> None:
        self._obstacles = obstacles
        self._tell()

    # --- what the window asks -----------------------------------------------------------------------------------------

    def has_news(self, now: float) -> bool:
        """Whether a snapshot of now [s of the wall clock] would show something else than the last one."""
        return (self._is_news or any(robot.is_moving(now) for robot in self._robots.values())
                or self._has_simulator(self._before) != self._has_simulator(now))

    def snapshot(self, now: float) -> Snapshot:
        """What there is to show at a time of the wall clock [s]."""
        self._is_news, self._before = False, now
        listeners, (name, _) = self._robots, self._wanted
        features, config, _ = self._files
        size = Size(config.drive.radius, config.brush.width)
        maps = self._maps
        there = (one.robot(now, size) for one in listeners.values() if self._is_there(one, now))
        robots = tuple(on_floor(robot, maps.frame) for robot in there if robot is not None)
        selected = listeners.get(name)
        stamps = [stamp for stamp in (one.known.stamp for one in listeners.values()) if stamp is not None]
        simulation = self._simulation(now, max(stamps) if stamps else None)
        coverage = self._shown_coverage(selected.known.coverage if selected else None, now)
        obstacles = self._obstacles if self._has_simulator(now) else ()
        return Snapshot(maps.plan, maps.known, maps.frame, coverage, features, robots, obstacles, name, simulation,
                        missing=self._missing(robots, simulation, maps.plan is not None))

    @property
    def _maps(self) -> Maps:
        listener = self._map_listener
        return listener.maps if listener is not None else Maps()

    def _simulation(self, now: float, stamp: Optional[float]) -> Simulation:
        state, graph = self._heard.state, self._graph
        if state is None or not self._has_simulator(now):
            return Simulation(is_simulated=graph.has_clock, time=stamp)
        below = f'{state.node}/'
        services = frozenset(name[len(below):] for name in graph.services if name.startswith(below))
        return Simulation(state.node, _known(state.reached), _known(state.wanted), state.is_paused, state.is_simulated,
                          stamp, services)

    def _has_simulator(self, now: float) -> bool:
        """Whether a simulator was heard recently, and has not taken its services back."""
        state, came = self._heard
        return state is not None and now - came < SILENCE and f'{state.node}/reset' in self._graph.services

    def _is_there(self, robot: RobotListener, now: float) -> bool:
        return robot.is_connected and (now - robot.known.came < SILENCE or now - self._heard.came < SILENCE)

    def _shown_coverage(self, newest: Optional[Grid], now: float) -> Optional[Grid]:
        """The newest coverage, but not more often than COVERAGE_PERIOD."""
        shown, since = self._coverage
        if newest is not shown and newest is not None and shown is not None and now - since < COVERAGE_PERIOD:
            self._is_news = True
            return shown
        if newest is not shown:
            self._coverage = newest, now
        return newest

    def _missing(self, robots: Tuple[Robot, ...], simulation: Simulation, has_map: bool) -> str:
        if robots:
            return '' if has_map else 'Waiting for a map\nNo node publishes /map.'
        if not self._graph.master:
            return missing_master()
        names = [name for name, robot in self._robots.items() if robot.is_connected]
        if simulation.node and names:
            why = 'Time is paused.' if simulation.is_paused else 'It comes ten times in a second of simulated time.'
            return f'Waiting for a pose of {" and ".join(names)}\n{why}'
        if simulation.node:
            return f'There is no robot\nTo add one:\nrosservice call {simulation.node}/spawn "{{}}"'
        return 'Waiting for a simulator\nTo start one, in another terminal:\nroslaunch rumba_sim simulator.launch'


def _known(value: float) -> Optional[float]:
    """A value; None instead of NaN."""
    return None if math.isnan(value) else value


def missing_master() -> str:
    """What to show while there is no master."""
    return (f'Waiting for ROS\nNo roscore answers at {rosgraph.get_master_uri()}. '
            'To start one with a robot, in another terminal:\nroslaunch rumba_sim simulator.launch')
