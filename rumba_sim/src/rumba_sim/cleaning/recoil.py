"""Back from what is in the way, far enough to turn."""

from rumba_sim.cleaning.behaviour import Observation

SPEED = 0.1  # [m/s] backward
BUMP = 0.05  # [m] back from a contact
# Back from a cliff: the sensors see it 0.15 m ahead of the middle, the robot needs up to 0.08 m to notice and to stop,
# and its wheels, 0.12 m off the middle, must not swing over the edge when it turns.
CLIFF = 0.15  # [m]


def time_back(observation: Observation) -> float:
    """How long to drive backward from what is felt or seen [s]."""
    return (CLIFF if any(observation.cliffs) else BUMP) / SPEED
