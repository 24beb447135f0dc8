"""Listens to the simulation, whoever comes and goes, and tells what there is to show."""

import http.client
import itertools
import threading
import time
import xmlrpc.client
from typing import Any, Callable, Dict, Optional, Tuple

import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import OccupancyGrid
from rospy.numpy_msg import numpy_msg

from rumba_cleaning.ros.cleaner.settings import robot_of_simulator
from rumba_sim.model import map_file
from rumba_sim.model.errors import RumbaError
from rumba_sim.model.robot_config import RobotConfig
from rumba_sim.ros.common.maps import FLOOR_PLAN
from rumba_viewer.ros import ros_graph
from rumba_viewer.ros.robot_listener import RobotEar
from rumba_viewer.scene.dock_field import dock
from rumba_viewer.scene.snapshot import Grid, Place, Robot, Simulation, Size, Snapshot

# A master or a simulator that goes amid an answer.
GONE = (rospy.ROSException, rosgraph.MasterException, xmlrpc.client.Error, http.client.HTTPException, OSError)
LOOK_PERIOD = 1.0  # [s] from one look at the master to the next
SILENCE = 3.0  # [s] of the wall clock, after which who says nothing is gone
COVERAGE_PERIOD = 0.2  # [s] of the wall clock, at least, from one picture of the floor to the next
GRACE = 2.5  # [s] for which an answer to pause counts more than /diagnostics, which look back
SPEED, WANTED = 'speed [times real time]', 'wanted speed [times real time]'  # in /diagnostics


class Listener:
    """Asks the master in a thread of its own who is there; callbacks of rospy store; the window asks."""

    def __init__(self, robot: str, shows_laser: bool) -> None:
        """Attend to a robot by its name, and show its laser or not, once it is started."""
        self._selected, self._shows_laser = robot, shows_laser
        self._on_master: Callable[[], object] = lambda: None
        self._around = ros_graph.Surroundings()
        self._master = ''  # the one at which this node is known
        self._ears: Dict[str, RobotEar] = {}
        self._common: Tuple[rospy.Subscriber, ...] = ()
        self._numbers = itertools.count()
        self._plan: Optional[Grid] = None
        self._coverage: Tuple[Any, Optional[Grid], float] = (None, None, 0.0)
        self._place, self._config, self._place_of = Place(), RobotConfig(), ''
        self._speed: Optional[float] = None
        self._wanted: Optional[float] = None
        self._heard = self._grace_until = -SILENCE
        self._is_paused = False
        self._before = 0.0  # when the last snapshot was made
        self._is_news, self._wake = True, threading.Event()

    def start(self, on_master: Callable[[], object]) -> None:
        """Begin to listen; `on_master` is called in the thread for each master, which knows nothing of this node."""
        self._on_master = on_master
        threading.Thread(target=self._look_around, daemon=True).start()

    def attend(self, robot: str, shows_laser: bool) -> None:
        """Attend to another robot, or show its laser or not."""
        self._selected, self._shows_laser = robot, shows_laser
        self._wake.set()

    def note_pause(self, is_paused: bool) -> None:
        """The simulator was asked to pause or go on, and does."""
        self._is_paused, self._grace_until = is_paused, time.monotonic() + GRACE
        self._tell()

    def _tell(self) -> None:
        self._is_news = True

    # --- the thread ---------------------------------------------------------------------------------------------------

    def _look_around(self) -> None:
        while not rospy.is_shutdown():
            try:
                self._follow(ros_graph.look())
            except GONE:
                pass
            except Exception:  # what else may break while ROS shuts down
                if not rospy.is_shutdown():
                    raise
            self._wake.wait(LOOK_PERIOD)
            self._wake.clear()

    def _follow(self, around: ros_graph.Surroundings) -> None:
        """Listen to who is there, and no longer to who is not."""
        if around != self._around:
            self._around = around
            self._tell()
        if not around.master:
            return
        if around.master != self._master:
            if not around.robots and any(ear.is_connected for ear in self._ears.values()):
                return  # this master knows nobody: those who knew each other before it go on
            self._master = around.master
            self._begin_anew()
        for name in set(self._ears) - set(around.robots):
            self._ears.pop(name).close()
        for name in around.robots:
            if name not in self._ears:
                self._ears = {**self._ears, name: RobotEar(name, self._tell)}
        for name, ear in self._ears.items():
            large = {'coverage', *(['scan'] if self._shows_laser else [])} if name == self._selected else set()
            ear.attend(large)
        self._look_at_place()

    def _begin_anew(self) -> None:
        for ear in self._ears.values():
            ear.close()
        for subscriber in self._common:
            subscriber.unregister()
        self._ears = {}
        self._common = (rospy.Subscriber('/map', numpy_msg(OccupancyGrid), self._on_map, queue_size=1),
                        rospy.Subscriber('/diagnostics', DiagnosticArray, self._on_diagnostics, queue_size=10))
        self._on_master()

    def _look_at_place(self) -> None:
        """Read the files of the simulator's map, once for each map."""
        path = rospy.get_param(f'simulator/{FLOOR_PLAN}', '')
        place_of = f'{path} {self._plan.number if self._plan else None}'
        if place_of == self._place_of:
            return
        self._place_of = place_of
        try:
            self._config = robot_of_simulator('simulator')
            plan = map_file.load(path)
            self._place = Place(dock(plan, self._config) if plan.dock else None, plan.carpet, plan.cliff, True)
        except RumbaError:  # the simulator runs on another machine, or there is none
            self._place = Place()
        self._tell()

    # --- callbacks ----------------------------------------------------------------------------------------------------

    def _on_map(self, message: Any) -> None:
        self._plan = self._grid(message)
        self._heard = time.monotonic()
        for ear in self._ears.values():
            ear.forget()
        self._wake.set()
        self._tell()

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        values = {pair.key: pair.value for status in message.status for pair in status.values}
        if SPEED not in values:
            return
        self._heard = time.monotonic()
        self._speed = float(values[SPEED])
        self._wanted = float(values[WANTED]) if values[WANTED][0].isdigit() else 0.0
        if self._heard > self._grace_until:
            self._is_paused = self._speed == 0.0
        self._tell()

    def _grid(self, message: Any) -> Grid:
        info = message.info
        return Grid(message.data.reshape(info.height, info.width), info.resolution, info.origin.position.x,
                    info.origin.position.y, next(self._numbers))

    # --- what the window asks -----------------------------------------------------------------------------------------

    def has_news(self, now: float) -> bool:
        """Whether a snapshot of now [s of the wall clock] shows something else than the last one did."""
        return (self._is_news or any(ear.is_moving(now) for ear in list(self._ears.values()))
                or self._has_simulator(self._before) != self._has_simulator(now))

    def snapshot(self, now: float) -> Snapshot:
        """What there is to show at a time of the wall clock [s]."""
        self._is_news, self._before = False, now
        ears = dict(self._ears)
        size = Size(self._config.drive.radius, self._config.brush.width)
        there = (ear.robot(now, size) for ear in ears.values() if self._is_there(ear, now))
        robots = tuple(robot for robot in there if robot is not None)
        selected = ears.get(self._selected)
        stamps = [ear.stamp for ear in ears.values() if ear.stamp is not None]
        has_simulator = self._has_simulator(now)
        simulation = Simulation(
            self._speed if has_simulator else None, self._wanted if has_simulator else None,
            has_simulator and self._is_paused, self._around.has_clock, max(stamps) if stamps else None, has_simulator)
        coverage = self._coverage_grid(selected.coverage if selected else None, now)
        return Snapshot(self._plan, coverage, self._place, robots, self._selected, simulation,
                        self._missing(robots, has_simulator))

    def _has_simulator(self, now: float) -> bool:
        return now - self._heard < SILENCE and rospy.resolve_name('simulator/pause') in self._around.services

    def _is_there(self, ear: RobotEar, now: float) -> bool:
        return ear.is_connected and (now - ear.came < SILENCE or now - self._heard < SILENCE)

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

    def _missing(self, robots: Tuple[Robot, ...], has_simulator: bool) -> str:
        if robots:
            return '' if self._plan is not None else 'Waiting for a map\nNobody publishes /map.'
        if not self._around.master:
            return missing_master()
        if has_simulator:
            return f'No robot is there\nrosservice call {rospy.resolve_name("simulator/spawn")} "{{}}"'
        return 'Waiting for a simulator\nTo start one, in another terminal:\nroslaunch rumba_sim simulator.launch'


def missing_master() -> str:
    """What to show while there is no master."""
    return ('Waiting for ROS\nNo roscore answers at {}. To start one with a robot, in another terminal:\n'
            'roslaunch rumba_sim simulator.launch').format(rosgraph.get_master_uri())
