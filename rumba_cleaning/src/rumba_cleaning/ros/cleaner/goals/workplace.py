"""Where the cleaner works, and with what robot: what the simulator tells, and the map that a parameter may name."""

from typing import Callable, NamedTuple, Optional, Tuple

import rospy

from rumba_cleaning.edges.guard import why_it_creeps
from rumba_cleaning.ros.cleaner.goals.survey import SurveyListener
from rumba_msg.msg import SimulatorState
from rumba_sim.model.common.errors import ConfigError, MapError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps import map_file
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.own_robot import OwnRobot
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.ros.participants.maps import map_path
from rumba_sim.ros.participants.simulator_client import SimulatorClient, robot_config
from rumba_sim.ros.running.peers import NO_ANSWER


class World(NamedTuple):
    """A world of a simulator, until the next reset or the next start."""

    run: str  # of the simulator's node
    resets: int  # before it
    since: rospy.Time  # stamp of the first state that told of it: what is older belongs to the world before


class Workplace:
    """The floor plan and the robot, as they are now: a simulator may be started again with other ones.

    Attributes:
        world: the newest one; None until a simulator tells its state.
        survey: of a floor that is being mapped; None if its plan is that of a file.
    """

    def __init__(self, name: str, on_new_world: Callable[[], None] = lambda: None,
                 survey: Optional[SurveyListener] = None, has_map: bool = True,
                 own: Optional[OwnRobot] = None, docks: bool = False, home: Optional[Pose] = None) -> None:
        """Take the map of this name or path, or, if `name` is empty, that of the simulator, and wait for it.

        Args:
            name: of the map, or empty.
            on_new_world: called after each change of `world`, in a thread of rospy.
            survey: tells the plan instead, of a floor that is being mapped.
            has_map: whether `look` will be called; it finds out now whether there is a plan.
            own: what the robot is like if it is not ours; no simulator is needed then.
            docks: whether that robot docks by itself.
            home: where its dock is; None: where the map says.

        Raises:
            MapError: the map cannot be read, or there is no simulator, or the robot docks and nothing says where.
        """
        self.world: Optional[World] = None
        self.survey = survey
        self._own, self._docks, self._home = own, docks, home
        self._on_new_world = on_new_world
        self._named = map_path(name) if name else ''
        self._loaded: Optional[Tuple[str, str, FloorPlan]] = None  # after its path, and the simulator's run
        self._robot: Optional[Tuple[str, RobotConfig]] = None  # after the simulator's run
        self._warned = ''
        self._simulator = SimulatorClient(self._on_state)
        if survey is not None:
            survey.wait()
        if has_map:
            self.look()

    def robot(self) -> RobotConfig:
        """What the robot is like; waits for the simulator.

        Raises:
            MapError: there is no simulator.
            ConfigError: its settings were changed to invalid ones.
        """
        self._simulator.wait()
        return self._newest_robot()

    def look(self) -> Tuple[FloorPlan, RobotConfig]:
        """The floor plan, the same object until map or simulator are other ones, and what the robot is like.

        Without a simulator, the robot is as the defaults say.

        Raises:
            MapError: the map cannot be read, or no simulator tells one, or the robot docks and nothing says where.
            ConfigError: the settings of the simulator were changed to invalid ones.
        """
        if self.survey is not None:
            return self.survey.plan(), self._newest_robot()
        path = self._named or self._simulator.wait().map
        state = self._simulator.state
        wanted = path, state.run if state is not None else ''
        robot = self._newest_robot()
        if self._loaded is None or self._loaded[:2] != wanted:
            plan = map_file.load(path, robot.drive.radius)
            if self._own is not None:
                self._place_dock(plan)
            self._loaded = (*wanted, plan)
        return self._loaded[2], robot

    def _place_dock(self, plan: FloorPlan) -> None:
        """Have a plan show the dock of a robot that is not ours, or none: it cannot use that of a Rumba.

        Raises:
            MapError: the robot docks, and nothing says where.
        """
        if self._home is not None or not self._docks:
            plan.dock, plan.further_docks = (self._home if self._docks else None), ()
        elif plan.dock is None:
            raise MapError(f'{plan.name}: no dock on the map: its YAML file may name one, dock: [x, y, theta], or the '
                           'parameter home')

    @property
    def lockstep(self) -> Optional[Tuple[str, int]]:
        """Run and resets of the newest world, if it is in lockstep; else None."""
        state = self._simulator.state
        return self.world[:2] if self.world is not None and state is not None and state.is_lockstep else None

    def _newest_robot(self) -> RobotConfig:
        state, known = self._simulator.state, self._robot
        if self._own is not None:
            return self._own.config
        if state is None:
            return RobotConfig()
        return known[1] if known is not None and known[0] == state.run else robot_config(state.node)

    def _on_state(self, state: SimulatorState) -> None:
        """Called with each state, in a thread of rospy."""
        if self.world is None or self.world[:2] != (state.run, state.resets):
            self.world = World(state.run, state.resets, state.header.stamp)
            self._on_new_world()
        self._read_robot(state)

    def _read_robot(self, state: SimulatorState) -> None:
        """Read the settings of the robot ahead: asking the master in `look` would delay go_to_position."""
        try:
            self._robot = state.run, robot_config(state.node)
            self._warn(why_it_creeps(self._robot[1]))
        except ConfigError:
            self._robot = None  # `look` raises the error
        except NO_ANSWER:
            pass  # the master is being restarted: what is known remains

    def _warn(self, line: str) -> None:
        """Log a line unless it was the last one, or is empty."""
        if line and line != self._warned:
            rospy.logwarn(line)
        self._warned = line
