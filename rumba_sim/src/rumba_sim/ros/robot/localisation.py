"""Who tells where a robot is on the map: the transform map -> odom."""

from typing import Any, Optional

from rumba_sim.model.common.config import setting
from rumba_sim.ros.common.frames import MAP, WORLD
from rumba_sim.ros.participants.maps import TOPIC, TRUE_TOPIC

TRUTH, SLAM = 'truth', 'slam'


def localisation_setting() -> Any:
    """The setting of who publishes map -> odom; only with `TRUTH` it is the node that has the setting."""
    return setting(TRUTH, 'who publishes map -> odom: truth (this node: the exact correction of odometry), mcl '
                          '(localiser), slam (mapper, which also publishes /map), or none (your own node, or nobody)',
                   choices=(TRUTH, 'mcl', SLAM, 'none'))


def true_frame(localisation: str) -> str:
    """The frame of what only a simulator knows: with `SLAM`, `MAP` is that of the map which a robot makes."""
    return WORLD if localisation == SLAM else MAP


def map_topic(localisation: str, is_exam: bool) -> Optional[str]:
    """The topic of the true map: one for onlookers if a robot makes its own map, and none if that is examined."""
    if localisation != SLAM:
        return TOPIC
    return None if is_exam else TRUE_TOPIC
