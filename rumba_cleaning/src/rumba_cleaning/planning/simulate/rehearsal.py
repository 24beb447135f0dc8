"""A rehearsal of a route: how the robot would drive along it, what it would sweep, and what edits would change.

A drive on paper goes exactly along the route. A robot cuts corners and swings out of them: what it leaves there is half
of all that a plan leaves, and rehearsals foresee it to about 0.1 % of the floor.
"""

from functools import cached_property
from typing import List, NamedTuple, Sequence

import numpy as np

from rumba_cleaning.behaviours.follower import drive_of
from rumba_cleaning.belief.context import Context
from rumba_cleaning.edges.guard import SWIFT_SPEED
from rumba_cleaning.planning.simulate import compiled_changes, compiled_passes, compiled_rehearsal
from rumba_cleaning.planning.simulate.compiled_passes import BEFORE, Passes
from rumba_cleaning.planning.simulate.compiled_rehearsal import ALONG, COLUMNS, DT, LEFT, RIGHT, Walls
from rumba_cleaning.route import Route, lengths_along
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.compiling.jit import plain
from rumba_sim.model.kernel import Array
from rumba_sim.model.kernel.sweeping.samples import SWEEPABLE

NEAR = 1.2  # times a price: large judges more edits again, small may miss some that become worth it; our choice
NO_PATH = np.zeros((0, 2))  # as that of an edit


class Edit(NamedTuple):
    """Part of a route that is replaced."""

    first: int  # the waypoint before that part
    last: int  # the one after it
    path: Array  # float64 (any, 2) [m] that replaces it
    seconds: float = 0.0  # that the route takes longer
    area: float = 0.0  # [m^2] that is swept more

    def place(self, route: Route) -> bytes:
        """A key of the replaced part and its replacement: equal for edits of routes that are alike there."""
        return bytes(route.waypoints[[self.first, self.last]].tobytes() + self.path.tobytes())

    def is_near(self, price: float) -> bool:
        """Whether it would be worth it at a price near to a given one [s/m^2]."""
        return max(price * NEAR * self.area, price / NEAR * self.area) > self.seconds


class Rehearsal:
    """A drive along a route from a pose, on a floor without obstacles that the ground does not show.

    The wheels are no faster than the guard lets them be in bends over floor that the robot has not seen. What was swept
    before must stay as it is in the context as long as the rehearsal is asked.

    Attributes:
        route: what is followed.
        swept: the floor afterwards.
        is_complete: whether the robot would get to the end.
        seconds: that it takes.
        turned: by how much the robot turns, to and fro [rad].
        reached: when each waypoint is reached: float64 (waypoints) [s].
    """

    def __init__(self, context: Context, pose: Pose, route: Route) -> None:
        """Drive along the route."""
        ground = context.ground
        self.route = route
        self._speed = context.config.speed
        drive = drive_of(context.robot.drive)
        self._drive = drive._replace(max_speed=min(drive.max_speed, SWIFT_SPEED))
        self._walls = Walls(ground.plan.clearance, ground.plan.origin, ground.plan.resolution, ground.reach)
        begin = np.zeros(COLUMNS)
        begin[:3] = pose
        self.is_complete, self._trace = compiled_rehearsal.rehearse(
            route.waypoints, route.speeds, plain(self._drive), plain(self._walls), begin, True, np.inf)
        self._trace[:, ALONG] = np.maximum.accumulate(self._trace[:, ALONG])
        self._before, self.swept = context.swept, context.swept.copy()
        brush = self.swept.brush
        compiled_passes.sweep_trace(brush, brush.samples, self._trace, self._speed)
        self._square = self.swept.reachable_area / max(self.swept.reachable, 1)  # [m^2] of a sample
        self.turned = float(np.abs(self._trace[:, RIGHT] - self._trace[:, LEFT]).sum()) * DT / drive.wheel_base
        self.seconds = (len(self._trace) - 1) * DT
        self._lengths = lengths_along(route.waypoints)
        self._rows = np.minimum(np.searchsorted(self._trace[:, ALONG], self._lengths), len(self._trace) - 1)
        self.reached = self._rows * DT

    @property
    def alone(self) -> Array:
        """What is swept until each waypoint is reached, and at no other time: float64 (waypoints) [m^2]."""
        first, last = self._passes
        rows = first[(first == last) & (first > BEFORE)]
        counts = np.cumsum(np.bincount(rows + 1, minlength=len(self._trace)))
        return np.asarray(counts[self._rows] * self._square)

    @cached_property
    def _passes(self) -> Passes:
        """When each sample is passed."""
        return compiled_passes.passed(self._before.brush, self._trace, self._speed)

    def judged(self, edits: Sequence[Edit]) -> List[Edit]:
        """Edits with what each costs and brings, if it were the only one; without those that lead astray."""
        if not edits:
            return []
        seconds, samples = compiled_changes.changes(
            *self.route, self._lengths, plain(self._drive), plain(self._walls), self._speed, self._trace,
            self.swept.brush, plain(self._passes), np.full_like(self.swept.brush.samples, SWEEPABLE),
            np.array([edit[:2] for edit in edits]),
            np.concatenate([NO_PATH, *(edit.path for edit in edits)]),
            np.cumsum([0, *(len(edit.path) for edit in edits)]))
        return [edit._replace(seconds=time, area=count * self._square)
                for edit, time, count in zip(edits, seconds.tolist(), samples.tolist()) if np.isfinite(time)]
