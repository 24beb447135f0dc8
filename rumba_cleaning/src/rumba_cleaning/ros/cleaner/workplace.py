"""Where the cleaner works, and with what robot: what the simulator tells, and the map that a parameter may name."""

from typing import Optional, Tuple

from rumba_msg.msg import SimulatorState
from rumba_sim.model import map_file
from rumba_sim.model.errors import ConfigError
from rumba_sim.model.floor_plan import FloorPlan
from rumba_sim.model.robot_config import RobotConfig
from rumba_sim.ros.common.maps import map_path
from rumba_sim.ros.common.simulator_client import SimulatorClient, robot_config


class Workplace:
    """The floor plan and the robot, as they are now: a simulator may be started again with other ones."""

    def __init__(self, name: str) -> None:
        """Take the map of this name or path, or, if `name` is empty, that of the simulator, and wait for it.

        Raises:
            MapError: the map cannot be read, or there is no simulator.
        """
        self._named = map_path(name) if name else ''
        self._loaded: Optional[Tuple[str, FloorPlan]] = None  # by its path
        self._robot: Optional[Tuple[str, RobotConfig]] = None  # by the name of the simulator's node
        self._simulator = SimulatorClient(self._read_robot)
        self.look()

    def look(self) -> Tuple[FloorPlan, RobotConfig]:
        """The floor plan, the same object until the map is another one, and what the robot is like.

        Without a simulator, the robot is as the defaults say.

        Raises:
            MapError: the map cannot be read, or no simulator tells one.
            ConfigError: the settings of the simulator were changed to invalid ones.
        """
        path = self._named or self._simulator.wait().map
        loaded = self._loaded
        if loaded is None or loaded[0] != path:
            loaded = self._loaded = path, map_file.load(path)
        return loaded[1], self._newest_robot()

    def _newest_robot(self) -> RobotConfig:
        state, known = self._simulator.state, self._robot
        if state is None:
            return RobotConfig()
        return known[1] if known is not None and known[0] == state.node else robot_config(state.node)

    def _read_robot(self, state: SimulatorState) -> None:
        """Called with each state, in a thread of rospy: asking the master in `look` would delay go_to_position."""
        try:
            self._robot = state.node, robot_config(state.node)
        except ConfigError:
            self._robot = None  # `look` raises the error
