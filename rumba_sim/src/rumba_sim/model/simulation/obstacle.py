"""What an obstacle is that the map does not show: a disc or a box that stands, walks, or opens and closes."""

from typing import NamedTuple, Sequence, Tuple

from rumba_sim.model.common.geometry import Pose, hypot

LASER_HEIGHT = 0.106  # [m] of the laser over the floor: what is lower is not seen


class Stop(NamedTuple):
    """A place to which a mover goes, and where it may pause."""

    pose: Pose  # [m, rad] in the map frame
    travel: float  # [s] that the way from the stop before takes
    least: float = 0.0  # [s] shortest pause
    most: float = 0.0  # [s] longest pause; each is drawn between both


class Obstacle(NamedTuple):
    """A disc, if its radius is not 0, or a box."""

    name: str
    pose: Pose  # of its centre, where a mover begins [m, rad], map frame
    height: float  # [m]
    radius: float = 0.0  # [m] of a disc
    length: float = 0.0  # [m] of a box, along its x axis
    width: float = 0.0  # [m] of a box, along its y axis
    stops: Tuple[Stop, ...] = ()  # of a mover, which goes from each to the next, and from the last to the first

    @property
    def reach(self) -> float:
        """Distance from its centre to its farthest point [m]."""
        return self.radius + 0.5 * hypot(self.length, self.width)

    @property
    def is_seen(self) -> bool:
        """Whether the laser sees it."""
        return self.height > LASER_HEIGHT


def walk(waypoints: Sequence[Pose], speed: float, is_loop: bool, least: float, most: float) -> Tuple[Stop, ...]:
    """The stops of a mover that goes along waypoints.

    Args:
        waypoints: at least two [m, rad], map frame.
        speed: [m/s] of its centre.
        is_loop: whether it goes from the last waypoint to the first; else it goes back the way that it came.
        least, most: limits of its pauses at each waypoint [s].
    """
    poses = [*waypoints, *([] if is_loop else waypoints[-2:0:-1])]
    return tuple(Stop(pose, hypot(pose.x - before.x, pose.y - before.y) / speed, least, most)
                 for before, pose in zip([poses[-1], *poses], poses))


def door(closed: Pose, opened: Pose, closed_for: float, open_for: float, moves_for: float) -> Tuple[Stop, ...]:
    """The stops of a door, which slides or swings from one pose to the other in a straight line.

    Args:
        closed, opened: [m, rad], map frame.
        closed_for, open_for: how long it stands in either pose [s].
        moves_for: how long it moves from one to the other [s].
    """
    return (Stop(closed, moves_for, closed_for, closed_for), Stop(opened, moves_for, open_for, open_for))
