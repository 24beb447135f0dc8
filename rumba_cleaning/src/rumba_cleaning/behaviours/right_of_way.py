"""Keeps robots that share a floor out of each other's way: each gives way to the mates that come before it.

A robot waits while its way crosses that of a mate with precedence, and moves aside if it stands on that way; so of any
two robots one always goes on. One that finds no place aside, or touches something on its way there, soon drives on, and
its mate moves aside for it. A mate that does not move by itself is an obstacle like any other.
"""

import enum
from typing import List, Optional

import numpy as np
from scipy import spatial

from rumba_cleaning.behaviour import STOP, Command, Observation
from rumba_cleaning.behaviours.follower import Follower
from rumba_cleaning.belief import paths
from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.mates import Report, Task
from rumba_cleaning.belief.places import places_apart
from rumba_cleaning.route import Ahead, Route, lengths_along
from rumba_sim.model.common.geometry import Pose, hypot
from rumba_sim.model.kernel import Array

# All figures are our choice; each comment says what speaks for a larger and for a smaller value.
NEAR = 2.0  # [m] of a mate that is looked at: large is careful, small is fast
MINE, THEIRS = 0.35, 0.6  # [m] of the ways ahead that are compared: large waits early, small stops late
SPACING = 0.05  # [m] between the points that are compared: a fraction of GAP
GAP = 0.08  # [m] between two bodies that pass: large waits more often, small touches
CLOSER = 0.02  # [m] by which a way must come nearer to a robot to lead toward it: more than the noise of a pose
STANDING = 0.4  # [m] of the way ahead on which a mate without precedence stands: it is waited for, since it gives way
SHUT_IN = 5.0  # [s] that a robot waits which finds no place aside, and a mate for it, which moves aside then
PATIENCE = 30.0  # [s] that a robot waits or stands aside for one mate, then it goes on: a plan takes shorter
REFUGE = 2.5  # [m] to a place aside, at most: large finds one more often, small comes back sooner
TRIES = 12  # of such places, to which a path is looked for: large finds one more often, small saves time
MOVING = (Task.SEEKING, Task.SWEEPING, Task.RETURNING, Task.DOCKING)


class Duty(enum.Enum):
    """What a robot owes to a mate."""

    NONE = 'it may go on'
    WAIT = 'it lets the other robot pass'
    MOVE_ASIDE = 'it stands on the way of the other robot, or that cannot get off its own'


class RightOfWay:
    """Decides whether a robot may go on; a controller, for the behaviour that is in charge."""

    def __init__(self, context: Context) -> None:
        """Look out for the mates of a context."""
        self._context = context
        self._clear = 2.0 * context.robot.drive.radius + GAP
        self.rest()

    def rest(self) -> None:
        """The robot is free to go on."""
        self._follower: Optional[Follower] = None  # of the way aside
        self._waited, self._patience = 0.0, PATIENCE  # [s]

    def command(self, observation: Observation, ahead: Optional[Ahead]) -> Optional[Command]:
        """What to do for the sake of mates, or None if the robot may go on along its way."""
        pose = observation.pose
        mates = {name: report for name, report in self._context.mates.reports.items()
                 if report.task in MOVING and _distance(report.pose, pose) < NEAR}
        if not mates:
            self.rest()
            return None
        mine = _points(ahead, pose, MINE)
        duties = {name: self._duty(pose, mine, name, report) for name, report in mates.items()}
        in_way = [mates[name] for name, duty in duties.items() if duty is Duty.MOVE_ASIDE]
        if not in_way and Duty.WAIT not in duties.values():
            self.rest()
            return None
        self._waited += observation.dt
        if self._waited >= self._patience:
            return None
        command = self._aside(observation, in_way[0]) if in_way else STOP
        return command if self._waited < self._patience else None

    def _duty(self, pose: Pose, mine: Array, name: str, report: Report) -> Duty:
        """What the robot, at a pose and with a way (any, 2) [m] ahead, owes to one mate."""
        theirs = _points(report.ahead, report.pose, THEIRS)
        if self._context.mates.has_precedence(name) or report.task is Task.DOCKING:
            if self._leads_to(theirs, pose):
                return Duty.NONE if self._leaves(mine, theirs) else Duty.MOVE_ASIDE
            return Duty.WAIT if self._meet(mine, theirs) else Duty.NONE
        if not self._leads_to(mine[:int(STANDING / SPACING)], report.pose):
            return Duty.NONE
        return Duty.MOVE_ASIDE if self._waited > SHUT_IN else Duty.WAIT

    def _leads_to(self, way: Array, pose: Pose) -> bool:
        """Whether a way (any, 2) [m] leads toward a robot and too near to it."""
        away = np.hypot(*(way - pose[:2]).T)
        return bool(away.min() < min(self._clear, away[0] - CLOSER))

    def _leaves(self, mine: Array, theirs: Array) -> bool:
        """Whether the way of the robot leads off that of a mate, and away from it."""
        away = np.hypot(*(mine - theirs[0]).T)
        return bool(away.min() > away[0] - CLOSER and spatial.distance.cdist(mine[-1:], theirs).min() > self._clear)

    def _meet(self, mine: Array, theirs: Array) -> bool:
        """Whether two ways come too near to each other, nearer than the robots are now."""
        away = spatial.distance.cdist(mine, theirs)
        return bool(away.min() < min(self._clear, away[0, 0] - CLOSER))

    def _aside(self, observation: Observation, mate: Report) -> Command:
        """Toward a place where the robot is in nobody's way, or wait if there is none."""
        if self._follower is not None and any(observation.bumper):
            self._follower, self._patience = None, 0.0
            return STOP
        if self._follower is None:
            route = self._way_aside(observation.pose, mate)
            if route is None:
                self._patience = min(self._patience, SHUT_IN)
                return STOP
            self._follower = Follower(route, self._context.robot.drive)
        v, w = self._follower.velocity(observation.pose, observation.dt)
        if self._follower.is_done or self._follower.is_lost:
            self._follower = None
            return STOP
        return Command(v, w, brushes_up=True)

    def _way_aside(self, pose: Pose, mate: Report) -> Optional[Route]:
        """To the nearest place that is off the way of a mate and apart from all of them; None: there is none."""
        ground, speed = self._context.ground, self._context.config.speed
        taken = np.concatenate([_points(mate.ahead, mate.pose, 2.0 * THEIRS), *(
            [report.pose[:2]] for report in self._context.mates.reports.values())])
        for place in places_apart(ground, pose, REFUGE, taken, self._clear)[:TRIES]:
            path = paths.between(ground, np.array(pose[:2]), place)
            if path is not None and not self._leads_to(_resampled(path, 2.0 * REFUGE), mate.pose):
                return Route(path, np.full(len(path) - 1, speed))
        return None


def _distance(one: Pose, other: Pose) -> float:
    return hypot(one.x - other.x, one.y - other.y)


def _points(ahead: Optional[Ahead], pose: Pose, length: float) -> Array:
    """Points (1 or more, 2) [m] on the way of a robot, from where it is on, up to a length [m]."""
    if ahead is None:
        return np.array([pose[:2]])
    return _resampled(np.concatenate([[pose[:2]], ahead.rest().waypoints]), length)


def _resampled(path: Array, length: float) -> Array:
    """Points (2 or more, 2) [m] on a path, SPACING apart, up to a length [m]."""
    along = lengths_along(path)
    at = np.arange(0.0, min(length, along[-1]) + SPACING, SPACING)
    columns: List[Array] = [np.interp(at, along, path[:, axis]) for axis in (0, 1)]
    return np.stack(columns, axis=1)
