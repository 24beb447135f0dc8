"""The state of the simulator in this namespace, and the properties of its robots, whatever its node is called."""

import threading
import time
from typing import Callable, Mapping, Optional

import rospy

from rumba_msg.msg import SimulatorState
from rumba_sim.model.common.config import from_mapping, names
from rumba_sim.model.common.errors import ConfigError, MapError, quoted
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.ros.running.node import PATIENCE

TOPIC = 'simulator/state'  # in the namespace of the simulator; independent of the name of its node
SETTINGS = 'settings'  # below the node's name: parameters with the settings in force
PERIOD = 0.1  # [s] between two looks whether ROS shuts down


class SimulatorClient:
    """Listens to the state of a simulator.

    Parameters remain after a node was killed: only a message shows that a simulator is running.

    Attributes:
        state: the newest state; None before the first message.
    """

    def __init__(self, on_state: Callable[[SimulatorState], None] = lambda _: None) -> None:
        """Subscribe; `on_state` is called with each state, in a thread of rospy."""
        self.state: Optional[SimulatorState] = None
        self._on_state = on_state
        self._came = threading.Event()
        self._subscriber = rospy.Subscriber(TOPIC, SimulatorState, self._take)

    def wait(self, patience: float = PATIENCE) -> SimulatorState:
        """The newest state; waits for the first one if necessary.

        Args:
            patience: how long to wait [s] of the wall clock.

        Raises:
            MapError: no state arrived.
            rospy.ROSInterruptException: the node ends.
        """
        end = time.monotonic() + patience
        while self.state is None:
            if rospy.is_shutdown():
                raise rospy.ROSInterruptException('the node ends')
            if time.monotonic() >= end:
                raise MapError(f'no simulator publishes {self._subscriber.resolved_name}: start one, or name a map: '
                               '_map:=studio')
            self._came.wait(PERIOD)
        return self.state

    def close(self) -> None:
        """Unsubscribe."""
        self._subscriber.unregister()

    def _take(self, state: SimulatorState) -> None:
        self.state = state
        self._came.set()
        self._on_state(state)


def robot_config(node: str) -> RobotConfig:
    """The properties of the robots of a simulator, given by the full name of its node; defaults for missing ones.

    Raises:
        ConfigError: another node has set its parameters to invalid values.
    """
    where = f'{node}/{SETTINGS}'
    parameters = rospy.get_param(where, {})
    if not isinstance(parameters, Mapping):
        raise ConfigError(f'parameter {where} is {quoted(parameters)}: must be the settings of a simulator')
    known = {name: parameters[name] for name in names(RobotConfig) if name in parameters}
    return from_mapping(RobotConfig, known, f'parameter {where}')
