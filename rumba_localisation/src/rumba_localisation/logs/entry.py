"""What a log tells of one scan."""

from typing import NamedTuple, Optional

from rumba_localisation.scan import Scan
from rumba_sim.model.common.geometry import Pose


class LogError(Exception):
    """A log that cannot be read; the message is one line."""


class Entry(NamedTuple):
    """A scan, and where the robot was."""

    stamp: float  # [s]
    odometry: Pose  # [m, rad] in a frame of its own
    scan: Scan
    reference: Optional[Pose]  # of the robot, if the log tells a better one [m, rad]
