"""How a robot that edges hold gets away from them, if the behaviour that is in charge finds no way."""

from typing import Callable, Iterable, Optional, Tuple

import numpy as np

from rumba_cleaning.behaviour import Command
from rumba_cleaning.edges.cliff_map import CliffMap
from rumba_cleaning.edges.compiled_preview import HOLD_STEPS, Wheels
from rumba_cleaning.edges.departure import SLOW, Departure, Search
from rumba_cleaning.edges.preview import Preview
from rumba_cleaning.edges.slip import NO_SLIP, Slip
from rumba_sim.model.common.geometry import Pose, hypot

# All figures below are our choice.
PATIENCE = 2.0  # [s] held by edges, after which it looks for a way out
LONG = 10.0  # [s] the same, after which, each time, it turns as far as it must and drives away
WAYS_OUT = [(v, w) for v in (0.0, -SLOW, SLOW) for w in (0.25, -0.25, 0.5, -0.5, 1.0, -1.0)]  # [m/s], [rad/s]
AHEAD = 50  # [steps of a path] that it is looked at: 1 s
RESERVE = 0.01  # [m] from a wheel to an edge on it
CREEP = 1e-4  # [m] by which an edge may come nearer all the same: rounding
GAIN = 3e-3  # [m] that it brings at least
ELSEWHERE = 0.3  # [m] from where edges held the robot

Ways = Callable[[Command, int], Tuple[float, float]]  # of a command for so many steps: as `Release._ways`


class Release:
    """Watches one robot.

    Attributes:
        held_time: for how long edges have kept the robot, about where it is, from what it was to do [s].
    """

    def __init__(self, cliff_map: CliffMap, preview: Preview, clear: float, guess: int) -> None:
        """Watch a robot.

        Args:
            cliff_map: what it knows of the floor.
            preview: of its commands.
            clear: from its middle to an edge, with which it can turn on the spot [m].
            guess: how many cells beside floor that it knows it takes for floor too.
        """
        self._cliff_map, self._preview, self._clear, self._guess = cliff_map, preview, clear, guess
        self._search = Search(cliff_map, preview.drive)
        self.rest()

    def rest(self) -> None:
        """Edges do not hold the robot."""
        self._held_at: Optional[Pose] = None
        self._leaves_at = PATIENCE  # after what `held_time` it looks for a way out
        self._is_leaving = False  # whether it is on one
        self._most = 0.0  # [m] from an edge to a wheel, of what it has gained on that way
        self._fruitless = 0.0  # [s] since it gained that
        self._departure: Optional[Departure] = None  # that it has decided on
        self._departs_at = LONG  # after what `held_time` it looks for one
        self.held_time = 0.0

    def is_due(self, pose: Pose, is_held: bool, seconds: float) -> bool:
        """Whether to look for a way out, at a pose to which it came so long after the one before [s]."""
        at = self._held_at
        if at is not None and hypot(pose.x - at.x, pose.y - at.y) > ELSEWHERE:
            self.rest()
        if is_held:
            self._held_at = self._held_at or pose
            self.held_time += seconds
        self._fruitless += seconds
        if self.held_time > self._leaves_at:
            self._is_leaving, self._most, self._fruitless = True, 0.0, 0.0
            self._leaves_at = self.held_time + PATIENCE
        return self._is_leaving

    def way_out(self, pose: Pose, speeds: Wheels, slips: Callable[[Wheels], Iterable[Slip]],
                may_back: bool) -> Optional[Command]:
        """The command that leads away from edges; None: there is none.

        Args:
            pose: of the robot.
            speeds: of its wheels [m/s].
            slips: tells how it may slide with wheels that are to be so fast [m/s].
            may_back: whether there is nothing behind it.
        """
        now = self._ways(pose, speeds, (0.0, 0.0), NO_SLIP, AHEAD)[0]
        reserve = min(now - CREEP, RESERVE)

        def ways(command: Command, steps: int) -> Tuple[float, float]:
            wanted = self._preview.wanted(command)
            ends, leasts = zip(*(self._ways(pose, speeds, wanted, slip, steps) for slip in slips(wanted)))
            return min(ends), min(leasts)

        if self._departure is None and self.held_time > self._departs_at:
            self._departure = self._search.find(pose, reserve, self._clear, self._guess)
            self._departs_at = self.held_time + LONG
        if now > self._most + GAIN:
            self._most, self._fruitless = now, 0.0
        best = self._departing(pose, reserve, may_back, ways) or self._nudge(now, reserve, may_back, ways)
        self._is_leaving = best is not None
        return best

    def _departing(self, pose: Pose, reserve: float, may_back: bool, ways: Ways) -> Optional[Command]:
        """The next command of a departure, as long as it is safe."""
        if self._departure is None:
            return None
        command = self._departure.command(pose)
        if ways(command, HOLD_STEPS)[1] < reserve or command.v < 0.0 and not may_back:
            self._departure = None
            return None
        return command

    def _nudge(self, now: float, reserve: float, may_back: bool, ways: Ways) -> Optional[Command]:
        """The slow command that brings the wheels farther from edges than others, if it gains enough on now [m].

        None for a robot that gained nothing by such commands for a while: it pushes against something.
        """
        if self._fruitless > PATIENCE:
            return None
        best, most = None, now + GAIN
        for command in (Command(v, w) for v, w in WAYS_OUT if v >= 0.0 or may_back):
            end, least = ways(command, AHEAD)
            if end > most and least >= reserve:
                best, most = command, end
        return best

    def _ways(self, pose: Pose, speeds: Wheels, wanted: Wheels, slip: Slip, steps: int) -> Tuple[float, float]:
        """How near to an edge a wheel is in the end, after a command for so many steps, and at the least [m].

        0 over unknown floor, once the robot has met a cliff that no map shows.
        """
        _, left, right = self._preview.path(pose, speeds, wanted, slip, steps)
        if self._cliff_map.seen and not self._cliff_map.are_known(np.concatenate([left, right]), self._guess):
            return 0.0, 0.0
        near = np.minimum(self._cliff_map.clearances(left), self._cliff_map.clearances(right))
        return float(near[-1]), float(near.min())
