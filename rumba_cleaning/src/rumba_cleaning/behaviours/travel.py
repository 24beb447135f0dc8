"""Drives along a route, and notices what is in the way.

`Travel` is a controller, not a behaviour: a behaviour makes one for each route, and throws it away when it is no longer
ON.
"""

import enum
import math
from typing import Optional

from rumba_cleaning.behaviour import Command, Observation, direction
from rumba_cleaning.behaviours import recoil
from rumba_cleaning.behaviours.follower import Follower
from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.route import Ahead, Route
from rumba_sim.model.common.geometry import Pose

KNOWN = 0.03  # [m] if a known obstacle is so near to the body, a contact is a contact with that: three errors of a pose
OBSTACLE = 0.05  # [m] radius that is assumed for what a contact reveals; `Ground` makes it larger if it is met again
TALL = 0.2  # [m] from there, within which the laser sees what is not low: the bumper tells the side alone
GAP = 0.02  # [m] from the body to that: one cell of a fine map
PATIENCE = 4.0  # [s] without progress, which is longer than any turn takes: the robot is stuck
PROGRESS = 0.01  # [m]: more than the noise of a pose
AHEAD = 0.5  # [m] of the route, in which the laser looks for obstacles: the robot stops within a fifth of that
LONGEST = 0.5  # [s] of one observation that count as waiting: in a longer one the node was busy, not the robot


class Going(enum.Enum):
    """How a travel goes."""

    ON = 'on the way'
    ARRIVED = 'at the end of the route'
    BLOCKED = 'something unknown is in the way: the ground shows it now, and another route is needed'
    LOST = 'far off the route: another route is needed'


class Travel:
    """Follows one route.

    Attributes:
        going: how it goes; what `command` answers is of use only while it is ON.
        route: what it follows.
    """

    def __init__(self, context: Context, route: Route) -> None:
        """Follow a route."""
        self._context = context
        self._follower = Follower(route, context.robot.drive)
        self.route = route
        self._back = 0.0  # [s] still to back off
        self._leaves = False  # the route, after that
        self._nearest = math.inf  # [m] least distance that was left
        self._waited = 0.0  # [s] since then
        self._is_first = True  # command
        self._was_touching = True  # a contact that exists at the start was dealt with before
        self.going = Going.ON

    @property
    def remaining(self) -> float:
        """Distance left [m]."""
        return self._follower.remaining

    @property
    def ahead(self) -> Ahead:
        """The route, and how far the robot has come."""
        return Ahead(self.route, self.remaining)

    def rest(self) -> Optional[Route]:
        """What is left of the route, if it has to be left; None if nothing is.

        It begins behind the obstacle if one is in the way, and at the point that was reached if the robot is lost.
        """
        return self._follower.rest_from_here() if self.going is Going.LOST else self._follower.rest()

    def command(self, observation: Observation, brushes_up: bool) -> Command:
        """What to do now; where the route is faster than the cleaning speed, the brushes are up in any case."""
        brushes_up = brushes_up or self._follower.speed > self._context.config.speed
        if self._is_first and self._is_at_edge(observation):
            self._back = recoil.time_back(observation)
        self._is_first = False
        if self._back > 0.0:
            self._back -= observation.dt
            if self._back <= 0.0 and self._leaves:
                self.going = Going.BLOCKED
            return Command(-recoil.SPEED, 0.0, brushes_up)
        is_blocked = self._is_blocked(observation)
        sees_obstacle = not is_blocked and self._sees_obstacle(observation)
        if is_blocked or sees_obstacle and any(observation.contact):  # else it would stay, and find the same way again
            self._back, self._leaves = recoil.time_back(observation), True
            return Command(-recoil.SPEED, 0.0, brushes_up)
        if sees_obstacle:
            self.going = Going.BLOCKED
            return Command(0.0, 0.0, brushes_up)
        v, w = self._follower.velocity(observation.pose, observation.dt)
        if self._follower.is_lost:
            self.going = Going.LOST
        elif self._follower.is_done:
            self.going = Going.ARRIVED
        return Command(v, w, brushes_up)

    def _sees_obstacle(self, observation: Observation) -> bool:
        """Whether the laser sees something in the way that the ground does not show; has it show that."""
        context = self._context
        context.look(observation)
        if context.sight is None:
            return False
        points = context.sight.in_way(observation.pose, self._follower.ahead(AHEAD), context.ground.reach)
        is_news = not context.ground.shows(points)
        if is_news:
            context.show_seen()
        return is_news

    def _is_at_edge(self, observation: Observation) -> bool:
        """Whether an edge is in the way: the map does not show all that were seen, or the robot is held by one.

        Beside edges that the map shows, a route leads by design, and the guard keeps the wheels on the floor.
        """
        return any(observation.cliffs) and (observation.is_held or bool(self._context.cliff_map.seen))

    def _is_blocked(self, observation: Observation) -> bool:
        """Whether something is in the way that the ground does not show; marks it."""
        is_at_edge = self._is_at_edge(observation)
        left, right = observation.contact if is_at_edge else observation.bumper
        touches = (left or right) and not self._was_touching
        self._was_touching = left or right
        if self._follower.remaining < self._nearest - PROGRESS:
            self._nearest, self._waited = self._follower.remaining, 0.0
        else:
            self._waited += min(observation.dt, LONGEST)
        if not (left or right):
            self._context.ground.leave_out(*observation.pose[:2], self._context.robot.drive.radius)
        is_stuck = self._waited > PATIENCE
        if is_stuck or touches and (is_at_edge or not _is_known(self._context.ground, observation.pose)):
            mark(self._context, observation.pose, direction(left, right), touches)
            return True
        return False


def mark(context: Context, pose: Pose, angle: float, touches: bool = True) -> None:
    """Remember an obstacle that the body touches at an angle from its front [rad], or is taken to touch.

    What the bumper finds and the laser does not see is low, and stays: a person, a pet or a robot is higher.
    """
    away = context.robot.drive.radius + GAP + OBSTACLE
    x, y = pose.x + away * math.cos(pose.theta + angle), pose.y + away * math.sin(pose.theta + angle)
    is_low = context.sight is not None and not context.sight.is_seen(x, y, TALL)
    context.ground.mark(x, y, OBSTACLE, stays=touches and is_low)


def _is_known(ground: Ground, pose: Pose) -> bool:
    """Whether the ground shows an obstacle that a robot here touches; an edge presses no switch of the bumper."""
    node, most = ground.node(pose.x, pose.y), ground.reach + KNOWN
    is_edge = ground.clearance[node] >= ground.plan.safe_clearance[node] and ground.plan.clearance[node] >= most
    return bool(ground.clearance[node] < most) and not is_edge
