"""Which parameters nobody may change in an examination."""

from typing import Any, Dict, List, Tuple

import rospy

from rumba_sim.ros.participants.simulator_client import SETTINGS
from rumba_sim.ros.running import launched

SIMULATOR, SIMULATED = 'simulator', 'use_sim_time'


def as_launched() -> Tuple[Dict[str, Any], List[str]]:
    """Parameters that stay as they are, and the nodes to which nobody else gives any.

    Who marks knows what was launched; otherwise it is what the simulator has found at its start.
    """
    now = rospy.get_param('/', {})
    if not launched.is_fixed():
        return {name: value for name, value in now.items() if name in (SIMULATOR, SIMULATED)}, [f'/{SIMULATOR}']
    nodes = launched.nodes()
    places = tuple(f'{node}/' for node in nodes)
    found = {name: value for name, value in launched.parameters().items()
             if name.startswith(places) or name == f'/{SIMULATED}'}
    of_simulator = now.get(SIMULATOR)
    if isinstance(of_simulator, dict):  # otherwise a node has replaced all of them by a value
        found[f'/{SIMULATOR}/{SETTINGS}'] = of_simulator.get(SETTINGS, {})  # which the simulator writes itself
    return found, nodes
