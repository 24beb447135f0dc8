"""What `/rosapi/floor` answers: carpet, cliffs and docks of the simulator's map, which no topic shows."""

from typing import Any, Dict, Tuple

import rospy

from rumba_msg.msg import SimulatorState
from rumba_sim.model.common.errors import RumbaError
from rumba_sim.ros.participants.simulator_client import TOPIC, robot_config
from rumba_viewer.page.messages.errors import Refusal
from rumba_viewer.page.messages.layers import described

PATIENCE = 5.0  # [s] for the state of the simulator


class Floor:
    """Reads the files of a map once for each simulator; asked in threads, since that takes time."""

    def __init__(self) -> None:
        """Know no map."""
        self._known: Tuple[str, Dict[str, Any]] = '', {}

    def answer(self, _: Any) -> Dict[str, Any]:
        """Layers and docks.

        Raises:
            Refusal: there is no simulator, or its map cannot be read on this machine.
        """
        try:
            # As bytes, as clients of the page get it: a node can have a topic only by one class.
            state = SimulatorState().deserialize(rospy.wait_for_message(TOPIC, rospy.AnyMsg, PATIENCE)._buff)
        except rospy.ROSException:
            raise Refusal('no simulator says which map it has') from None
        if self._known[0] != state.run:
            try:
                self._known = state.run, _read(state.map, robot_config(state.node).drive.radius)
            except RumbaError as error:
                raise Refusal(f'the map cannot be read here: {error}') from None
        return self._known[1]


def _read(path: str, radius: float) -> Dict[str, Any]:
    from rumba_sim.model.maps import map_file  # with SciPy, which pages without a simulator do not need
    plan = map_file.load(path, radius)
    return described(plan.columns, plan.rows, {'carpet': plan.carpet, 'cliff': plan.cliff}, plan.docks)
