"""Listens to a simulation, whichever of its nodes come and go, and makes snapshots of what there is to show."""

import http.client
import itertools
import math
import threading
import time
import xmlrpc.client
from typing import Any, Callable, Dict, Optional, Tuple

import rosgraph
import rospy
from nav_msgs.msg import OccupancyGrid
from rospy.numpy_msg import numpy_msg

from rumba_msg.msg import SimulatorState
from rumba_sim.model import map_file
from rumba_sim.model.errors import RumbaError
from rumba_sim.model.robot_config import RobotConfig
from rumba_sim.ros.common.simulator_client import SimulatorClient, robot_config
from rumba_viewer.ros import ros_graph
from rumba_viewer.ros.robot_listener import RobotListener
from rumba_viewer.scene.dock_field import dock
from rumba_viewer.scene.snapshot import Grid, MapFeatures, Robot, Simulation, Size, Snapshot

# What is raised if the master or the simulator ends during a call.
GONE = (rospy.ROSException, rosgraph.MasterException, xmlrpc.client.Error, http.client.HTTPException, OSError)
LOOK_PERIOD = 1.0  # [s] from one look at the graph to the next
SILENCE = 3.0  # [s] of the wall clock, after which a silent simulator or robot counts as gone
COVERAGE_PERIOD = 0.2  # [s] of the wall clock, at least, from one picture of the coverage to the next


class Listener:
    """Looks at the graph in a thread of its own; callbacks of rospy store; the window asks.

    What several threads use is replaced as a whole and never changed, so that each of them sees a consistent value.
    """

    def __init__(self, robot: str, shows_laser: bool) -> None:
        """Select a robot by its name, and show its laser or not, once it is started."""
        self._selected, self._shows_laser = robot, shows_laser
        self._on_master: Callable[[], object] = lambda: None
        self._graph = ros_graph.RosGraph()
        self._master = ''  # the one at which this node is registered
        self._robots: Dict[str, RobotListener] = {}
        self._simulator: Optional[SimulatorClient] = None
        self._map: Optional[rospy.Subscriber] = None
        self._numbers = itertools.count()
        self._plan: Optional[Grid] = None
        self._coverage: Tuple[Any, Optional[Grid], float] = (None, None, 0.0)
        self._features, self._config = MapFeatures(), RobotConfig()
        self._features_of: Tuple[Any, ...] = ()  # node, map and grid to which they belong
        self._state: Optional[SimulatorState] = None
        self._heard = -math.inf  # when that came, on the wall clock [s]
        self._before = -math.inf  # when the last snapshot was made
        self._is_news, self._wake = True, threading.Event()

    def start(self, on_master: Callable[[], object]) -> None:
        """Begin to listen; `on_master` is called in the thread for each new master, where this node is unknown yet."""
        self._on_master = on_master
        threading.Thread(target=self._look_around, daemon=True).start()

    def select(self, robot: str, shows_laser: bool) -> None:
        """Select another robot, or show its laser or not."""
        self._selected, self._shows_laser = robot, shows_laser
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
            except Exception:  # anything may fail while ROS shuts down
                if not rospy.is_shutdown():
                    raise
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
            self._master = graph.master
            self._start_anew()
        before = self._robots
        self._robots = {name: before.get(name) or RobotListener(name, self._tell) for name in graph.robots}
        for name in set(before) - set(graph.robots):
            before[name].close()
        for name, robot in self._robots.items():
            large = {'coverage', *(['scan'] if self._shows_laser else [])} if name == self._selected else set()
            robot.subscribe_large(large)
        self._read_map_files()

    def _start_anew(self) -> None:
        before, self._robots, self._state = self._robots, {}, None
        for robot in before.values():
            robot.close()
        if self._simulator is not None:
            self._simulator.close()
        if self._map is not None:
            self._map.unregister()
        self._map = rospy.Subscriber('/map', numpy_msg(OccupancyGrid), self._on_map, queue_size=1)
        self._simulator = SimulatorClient(self._on_state)
        self._on_master()

    def _read_map_files(self) -> None:
        """Read the files of the simulator's map, once for each map."""
        state, plan = self._state, self._plan
        if state is None or (state.node, state.map, plan) == self._features_of:
            return
        try:
            self._config = robot_config(state.node)
            floor = map_file.load(state.map)
            self._features = MapFeatures(dock(floor, self._config) if floor.dock else None, floor.carpet, floor.cliff,
                                         True)
        except RumbaError:  # the simulator runs on another machine
            self._features = MapFeatures()
        self._features_of = state.node, state.map, plan
        self._tell()

    # --- callbacks ----------------------------------------------------------------------------------------------------

    def _on_map(self, message: Any) -> None:
        self._plan = self._grid(message)
        for robot in self._robots.values():
            robot.forget()
        self._wake.set()
        self._tell()

    def _on_state(self, state: SimulatorState) -> None:
        before, self._state, self._heard = self._state, state, time.monotonic()
        if before is None or (state.node, state.map) != (before.node, before.map):
            self._wake.set()
        self._tell()

    def _grid(self, message: Any) -> Grid:
        info = message.info
        return Grid(message.data.reshape(info.height, info.width), info.resolution, info.origin.position.x,
                    info.origin.position.y, next(self._numbers))

    # --- what the window asks -----------------------------------------------------------------------------------------

    def has_news(self, now: float) -> bool:
        """Whether a snapshot of now [s of the wall clock] would show something else than the last one."""
        return (self._is_news or any(robot.is_moving(now) for robot in self._robots.values())
                or self._has_simulator(self._before) != self._has_simulator(now))

    def snapshot(self, now: float) -> Snapshot:
        """What there is to show at a time of the wall clock [s]."""
        self._is_news, self._before = False, now
        listeners = self._robots
        size = Size(self._config.drive.radius, self._config.brush.width)
        there = (one.robot(now, size) for one in listeners.values() if self._is_there(one, now))
        robots = tuple(robot for robot in there if robot is not None)
        selected = listeners.get(self._selected)
        stamps = [one.stamp for one in listeners.values() if one.stamp is not None]
        simulation = self._simulation(now, max(stamps) if stamps else None)
        coverage = self._coverage_grid(selected.coverage if selected else None, now)
        return Snapshot(self._plan, coverage, self._features, robots, self._selected, simulation,
                        missing=self._missing(robots, simulation))

    def _simulation(self, now: float, stamp: Optional[float]) -> Simulation:
        state, graph = self._state, self._graph
        if state is None or not self._has_simulator(now):
            return Simulation(is_simulated=graph.has_clock, time=stamp)
        below = f'{state.node}/'
        services = frozenset(name[len(below):] for name in graph.services if name.startswith(below))
        return Simulation(state.node, _known(state.real_time_factor), _known(state.speed), state.is_paused,
                          state.is_time_simulated, stamp, services)

    def _has_simulator(self, now: float) -> bool:
        """Whether a simulator was heard recently, and has not taken its services back."""
        state = self._state
        return state is not None and now - self._heard < SILENCE and f'{state.node}/reset' in self._graph.services

    def _is_there(self, robot: RobotListener, now: float) -> bool:
        return robot.is_connected and (now - robot.came < SILENCE or now - self._heard < SILENCE)

    def _coverage_grid(self, message: Any, now: float) -> Optional[Grid]:
        """The newest coverage, but not more often than COVERAGE_PERIOD."""
        known, grid, made = self._coverage
        if message is not known:
            if message is not None and grid is not None and now - made < COVERAGE_PERIOD:
                self._is_news = True
                return grid
            grid = self._grid(message) if message is not None else None
            self._coverage = message, grid, now
        return grid

    def _missing(self, robots: Tuple[Robot, ...], simulation: Simulation) -> str:
        if robots:
            return '' if self._plan is not None else 'Waiting for a map\nNo node publishes /map.'
        if not self._graph.master:
            return missing_master()
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
