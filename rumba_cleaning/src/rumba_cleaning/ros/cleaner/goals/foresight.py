"""What the log says before a cleaning begins, if it will not go as people expect."""

import contextlib
from typing import Optional

import rospy

from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.mission import outlook
from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.geometry import Pose


def warn(context: Context, config: CleaningConfig, pose: Optional[Pose]) -> None:
    """Log a line if the battery will not last on the map, or the robot cannot drive at the cleaning speed.

    Args:
        context: what the robot knows.
        config: the settings as they were given.
        pose: of the robot; None if it is not known yet.
    """
    if pose is None or not context.has_map or context.survey is not None:
        return
    with contextlib.suppress(MapError):  # the robot is not quite where it believes to be
        for remark in outlook.remarks(context.plan, *pose[:2], context.robot, config):
            rospy.logwarn(remark)
