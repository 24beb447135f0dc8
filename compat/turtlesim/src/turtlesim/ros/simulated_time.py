"""/use_sim_time: true while this node publishes /clock, and then as it was before, also if a node was killed meanwhile.

The simulator of rumba_sim keeps what it found in the same parameter, so that each of the two restores what the other
left when it was killed.
"""

import contextlib

import rospy

USE_SIM_TIME = '/use_sim_time'
FOUND = '/use_sim_time_before_simulator'  # what it was; while this node has set it, and after the node was killed


def claim() -> None:
    """Make time that of /clock, for nodes that start from now on."""
    rospy.set_param(FOUND, _found())
    rospy.set_param(USE_SIM_TIME, True)


def restore() -> None:
    """Make /use_sim_time what it was; if it was not true, it is deleted: without a /clock, time would stay 0."""
    with contextlib.suppress(OSError):  # the master has gone
        for name in [FOUND] if _found() else [USE_SIM_TIME, FOUND]:
            with contextlib.suppress(KeyError):  # deleted already
                rospy.delete_param(name)


def _found() -> bool:
    return bool(rospy.get_param(FOUND, rospy.get_param(USE_SIM_TIME, False)))
