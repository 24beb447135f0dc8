"""Who tells where a robot is on the map: the transform map -> odom."""

from typing import Any

from rumba_sim.model.config import setting

TRUTH, SLAM = 'truth', 'slam'


def localisation_setting() -> Any:
    """The setting of who publishes map -> odom; only with `TRUTH` it is the node that has the setting."""
    return setting(TRUTH, 'who publishes map -> odom: truth (this node: the exact correction of odometry), mcl '
                          '(localiser), slam (mapper, which also publishes /map), or none (a node of yours, or nobody)',
                   choices=(TRUTH, 'mcl', SLAM, 'none'))
