"""What was heard of a robot for some seconds, as plain values."""

from typing import Dict, List, NamedTuple, Optional, Tuple

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.model.settings.mounting import Mounting

NAMES = Tuple[str, ...]


class Topic(NamedTuple):
    """One topic."""

    name: str
    kinds: NAMES = ()  # types that its nodes have
    publishers: NAMES = ()  # names of nodes
    subscribers: NAMES = ()
    rate: float = 0.0  # [Hz]; 0: nothing came


class ScanHeard(NamedTuple):
    """The newest scan, and how it is mounted."""

    frame: str
    ages: Tuple[float, ...]  # [s] from the stamps to when scans came
    ranges: Array  # (n) [m]
    mounting: Optional[Mounting]  # by the file, or else by tf
    by_tf: Optional[Mounting]
    fault: str  # why tf tells none


class OdometryHeard(NamedTuple):
    """What the odometry says."""

    frame: str
    child: str
    ages: Tuple[float, ...]  # [s]
    is_valid: bool  # whether its numbers are poses
    contradiction: str  # with what was commanded; empty: none
    is_tested: bool  # whether enough was commanded to tell
    is_linked: bool  # whether tf leads from its child to the base, or they are one


class View(NamedTuple):
    """A scan, and where the robot was by its odometry then."""

    pose: Pose
    points: Array  # (n, 2) [m] in the frame of the laser


class Heard(NamedTuple):
    """All of it."""

    seconds: float  # for which it was listened
    scan: Topic
    odom: Topic
    cmd_vel: Topic
    optional: Dict[str, Topic]
    scan_heard: Optional[ScanHeard]
    odometry_heard: Optional[OdometryHeard]
    views: List[View]
    others: Dict[str, NAMES]  # topics that could be meant, by type
    map_odom: NAMES  # nodes that tell map -> odom
    clock_fault: str  # what is wrong with the clock, or empty
    runs_on: bool  # whether it drove on a second after the last command
    mode: Optional[int] = None  # of a Create
