"""Keeps the wheels on the floor, whatever a behaviour commands.

Before a command is given, it is simulated: if the robot could not stop before the edge of a known cliff, and on floor
that its sensors have seen, it drives more slowly, or not at all (D. Fox, W. Burgard, S. Thrun, The Dynamic Window
Approach to Collision Avoidance, 1997: a velocity is admissible if the robot can stop before the obstacle).
"""

import math
from typing import Callable, List, Optional, Tuple

import numpy as np

from rumba_cleaning.behaviour import Command, Observation
from rumba_cleaning.behaviours.compiled_guard import HOLD_STEPS, ROUNDING, path
from rumba_cleaning.behaviours.rear import Rear
from rumba_cleaning.behaviours.slip import NO_SLIP, Slip, along_contacts, slipped
from rumba_cleaning.behaviours.trail import Trail
from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.footing import FAR
from rumba_sim.model.geometry import Pose
from rumba_sim.model.kernel import Array

SHARES = (0.6, 0.3)  # of a command that are tried, after the whole and a slow one, before the robot stops; our choice
LONGEST = 0.3  # [s] the same, at most, by the time since the last one: in a longer step the node was busy
SPARE = 0.02  # [m] from a wheel to an edge: a cell of a fine map; an edge that was seen is known no better
AT_REST = 0.02  # [m/s] of both wheels
CREEP = 1e-4  # [m] by which an edge may come nearer to the middle of a robot that is too near already: rounding

# The sensors see an edge in time for wheels that are no faster (a corner of 90 degrees is seen 0.08 m before a wheel is
# there, and such a robot brakes within 0.07 m), and all of the floor before wheels in bends that are no tighter.
SAFE_SPEED = 0.35  # [m/s]
SAFE_CURVATURE = 2.0  # [1/m]
WARY_SPEED = 0.25  # [m/s] near a cliff that the map does not show: in 0.06 m the robot stops, whatever its shape is
SLOW = 0.1  # [m/s] near such a cliff: no faster in bends, unless all of the floor in them is known
TIGHT = 3.3  # [1/m] in tighter bends the sensors of one side look along the circle of the outer wheel, ...
SWIFT_SPEED = 0.38  # [m/s] ... 0.17 m ahead of it: a wheel that is no faster stops within 0.12 m

RELEASE = 2.0  # [s] held by edges, after which the guard looks for a way out itself
WAYS_OUT = [(v, w) for v in (0.0, -SLOW, SLOW) for w in (0.25, -0.25, 0.5, -0.5, 1.0, -1.0)]  # [m/s], [rad/s]
AHEAD = 50  # [steps of a path] that it is looked at: 1 s
RESERVE = 0.01  # [m] from a wheel to an edge on it
AWAY = 0.04  # [m] from both wheels to edges: out of there
GAIN = 3e-3  # [m] that it brings at least
ELSEWHERE = 0.3  # [m] from where edges held the robot

Wheels = Tuple[float, float]  # left and right
Sides = Tuple[bool, bool]  # left and right
NONE, BOTH = (False, False), (True, True)


class Guard:
    """Watches what a robot sees and what it is commanded; a controller, for the behaviour that is in charge.

    Attributes:
        held_time: for how long edges have kept the robot, about where it is, from what it was to do [s].
    """

    def __init__(self, context: Context, safe_speed: float = SAFE_SPEED) -> None:
        """Guard the robot of a context.

        Args:
            context: of the robot.
            safe_speed: of its wheels, at which it need not remember the floor ahead [m/s].
        """
        self._safe_speed = safe_speed
        self._ground, self._footing = context.ground, context.footing
        self._drive = context.robot.drive
        self._half = 0.5 * context.robot.drive.wheel_base
        self._clear = self._half + SPARE  # [m] from the middle to an edge: the robot can turn on the spot
        self._rear = Rear(context.robot.drive.radius)
        self._trail = Trail(self._half)
        self.rest()

    def rest(self) -> None:
        """The robot stands still, or somebody else drives it."""
        self._speeds: Wheels = (0.0, 0.0)  # [m/s] of the wheels, when the last command was given
        self._command = Command(0.0, 0.0)  # the last one
        self._last: Optional[Pose] = None
        self._held = NONE  # the side on which an edge kept the robot from what it was to do
        self._rear.rest()
        self._trail.forget()
        self._is_on_trail = False  # whether the last command leads back along it
        self._go_on()

    def _go_on(self) -> None:
        """Edges do not hold the robot."""
        self._held_at: Optional[Pose] = None
        self._leaves_at = RELEASE  # after what `held_time` it looks for a way out
        self._is_leaving = False  # whether it is on a way out
        self.held_time = 0.0

    def see(self, observation: Observation) -> None:
        """Remember what the cliff sensors see, and show it to the ground."""
        footing = self._footing
        before = len(footing.seen)
        footing.note(observation.pose, observation.cliffs, observation.is_docked)
        for x, y in footing.seen if before and not self._ground.has_marks else footing.seen[before:]:
            self._ground.mark(x, y, SPARE)

    def stand_by(self, observation: Observation) -> None:
        """Watch while a person drives."""
        self.rest()
        self.see(observation)

    def step(self, decide: Callable[[Observation], Command], observation: Observation) -> Command:
        """The command that is decided on, or one that does not lead over an edge.

        What decides gets the observation; if an edge stopped the robot, as if the cliff sensors saw it.
        """
        self.see(observation)
        self._rear.watch(observation, 0.5 * sum(self._speeds) * min(observation.dt, LONGEST))
        left, right = self._held
        if left or right:
            far_left, near_left, near_right, far_right = observation.cliffs
            observation = observation._replace(cliffs=(far_left or left, near_left, near_right, far_right or right))
        command = self._on_trail(decide(observation), observation.pose)
        change = self._drive.acceleration * min(observation.dt, LONGEST)
        (left_speed, right_speed), (left_goal, right_goal) = self._speeds, self._wanted(self._command)
        self._speeds = (min(max(left_goal, left_speed - change), left_speed + change),
                        min(max(right_goal, right_speed - change), right_speed + change))
        self._command = self._admitted(observation, command)
        self._note_held(observation)
        if self._is_leaving:
            self._command = self._way_out(observation, command) or self._command
        self._last = observation.pose
        return self._command

    def _on_trail(self, command: Command, pose: Pose) -> Command:
        """Have a robot that backs off where an edge may be anywhere go back by the way that it came.

        Straight back from a bend, a wheel comes where no sensor has looked, or nearer to an edge beside the way.
        """
        is_braking = sum(self._speeds) > 0.0 and not self._is_on_trail
        is_back = command.v < 0.0 and not is_braking and self._is_wary(pose)
        motion = self._trail.back(pose) if is_back else None
        self._is_on_trail = motion is not None
        if motion is None:
            self._trail.note(pose)
            return command
        ahead, turn = motion
        share = -command.v / max(abs(ahead) + self._half * abs(turn), ROUNDING)
        return command._replace(v=share * ahead, w=share * turn)

    def _note_held(self, observation: Observation) -> None:
        """Measure for how long edges have held the robot, about where it is, and decide when to look for a way out."""
        pose, at = observation.pose, self._held_at
        if at is not None and math.hypot(pose.x - at.x, pose.y - at.y) > ELSEWHERE:
            self._go_on()
        if self._held != NONE and _faster(self._speeds) == 0.0:
            self._held_at = self._held_at or pose
            self.held_time += min(observation.dt, LONGEST)
        if self.held_time > self._leaves_at:
            self._is_leaving = True
            self._leaves_at = self.held_time + RELEASE

    def _way_out(self, observation: Observation, command: Command) -> Optional[Command]:
        """The slow command that brings the wheels farther from edges than others; None: there is none, or no need."""
        pose = observation.pose
        best, most = None, self._ways(pose, (0.0, 0.0), NO_SLIP)[0]
        reserve = min(most - CREEP, RESERVE)
        most = math.inf if most > AWAY else most + GAIN
        is_closed = self._rear.is_closed(observation)
        for v, w in WAYS_OUT:
            if v < 0.0 and is_closed:
                continue
            slow = command._replace(v=v, w=w)
            wanted = self._wanted(slow)
            ends, leasts = zip(*(self._ways(pose, wanted, slip) for slip in self._slips(observation, wanted)))
            if min(ends) > most and min(leasts) >= reserve:
                best, most = slow, min(ends)
        self._is_leaving = best is not None
        return best

    def _ways(self, pose: Pose, wanted: Wheels, slip: Slip) -> Tuple[float, float]:
        """How near to an edge a wheel is in the end, after a command, and at the least [m]; 0 over unknown floor."""
        _, left, right = self._path(pose, wanted, slip, AHEAD)
        if not self._footing.are_known(np.concatenate([left, right]), 1):
            return 0.0, 0.0
        near = np.minimum(self._footing.clearances(left), self._footing.clearances(right))
        return float(near[-1]), float(near.min())

    def _admitted(self, observation: Observation, command: Command) -> Command:
        self._held = NONE
        pose, wanted = observation.pose, self._wanted(command)
        if _faster(wanted) > WARY_SPEED and self._is_wary(pose):
            command = self._limited(command, WARY_SPEED)
            wanted = self._wanted(command)
        fastest = max(_faster(self._speeds), _faster(wanted))
        braking = fastest * LONGEST + 0.5 * fastest ** 2 / self._drive.acceleration
        is_near = self._footing.clearance_at(pose.x, pose.y) <= self._clear + braking
        must_know = self._is_wary(pose) or not (self._sees_ahead(wanted) and self._sees_ahead(self._speeds))
        if not (is_near or must_know) or fastest == 0.0:
            return command
        if is_near and sum(wanted) < 0.0 and self._rear.is_closed(observation, self._is_on_trail):
            self._held = BOTH if _faster(self._speeds) < AT_REST else NONE
            return command._replace(v=0.0, w=0.0)
        found, slips = [], self._slips(observation, wanted)
        limited = [self._limited(command, limit) for limit in (SWIFT_SPEED, self._safe_speed)]
        # In a bend, a wheel may cut inside the way of its sensor: once it has turned, the robot drives behind that.
        turns = self._is_wary(pose) and command.w != 0.0
        on_the_spot = [self._limited(command._replace(v=0.0), WARY_SPEED)] if turns else []
        for slower in (command, *limited, *(_part_of(command, share) for share in SHARES), *on_the_spot):
            found.append(self._edges(pose, self._wanted(slower), slips, is_near, must_know))
            if found[-1] == NONE:
                return slower
        if _faster(self._speeds) < AT_REST:
            self._held = found[0]
        return command._replace(v=0.0, w=0.0)

    def _is_wary(self, pose: Pose) -> bool:
        """Whether a cliff that the map does not show is near: its edge may have any shape where it was not seen yet."""
        return bool(self._footing.seen) and self._footing.clearance_at(pose.x, pose.y) < FAR

    def _sees_ahead(self, speeds: Wheels) -> bool:
        """Whether the cliff sensors see the floor under the wheels before it is too late, with no need to remember."""
        left, right = speeds
        return min(left, right) >= 0.0 and max(left, right) <= self._safe_speed and (
            left + right == 0.0 or _curvature(speeds, self._half) <= SAFE_CURVATURE)

    def _slips(self, observation: Observation, wanted: Wheels) -> List[Slip]:
        """How the robot may slide after a command: as it did last, and, if it drives forward, along what it touches."""
        last = self._last if observation.dt < LONGEST else None
        fastest = max(_faster(self._speeds), _faster(wanted))
        pushes = max(sum(wanted), sum(self._speeds)) > 0.0
        return [slipped(last, observation, 0.5 * sum(self._speeds)),
                *(along_contacts(observation, fastest) if pushes else [])]

    # --- what a command leads to ----------------------------------------------------------------------------------

    def _edges(self, pose: Pose, wanted: Wheels, slips: List[Slip], is_near: bool, must_know: bool) -> Sides:
        """Whether an edge is too near on the left and on the right, before the robot can stop after a command.

        Args:
            pose: where the robot is.
            wanted: the speeds of the wheels that are commanded [m/s].
            slips: how it may slide.
            is_near: whether any cliff is near.
            must_know: whether the wheels may only go where the robot knows that there is floor.
        """
        left = right = False
        for slip in slips:
            is_left, is_right = self._edge(pose, wanted, slip, is_near, must_know)
            left, right = left or is_left, right or is_right
        return left, right

    def _edge(self, pose: Pose, wanted: Wheels, slip: Slip, is_near: bool, must_know: bool) -> Sides:
        """As `_edges`, for a robot that slides in one way."""
        middle, left, right = self._path(pose, wanted, slip)
        if is_near:
            near = [self._footing.clearances(line) for line in (middle, left, right)]
            least = [min(line[0], limit) for line, limit in zip(near, (self._clear, SPARE, SPARE))]
            if (near[0] < least[0] - CREEP).any():
                worst = int(np.argmin(near[0]))
                return bool(near[1][worst] <= near[2][worst]), bool(near[2][worst] <= near[1][worst])
            over = bool((near[1] < least[1]).any()), bool((near[2] < least[2]).any())
            if any(over):
                return over
        if must_know:
            guess = self._guess(pose, wanted)
            return not self._footing.are_known(left[1:], *guess), not self._footing.are_known(right[1:], *guess)
        return NONE

    def _guess(self, pose: Pose, wanted: Wheels) -> Tuple[int, bool]:
        """How many cells beside known floor are taken to be floor too, and whether only beside what a sensor saw.

        They are fewer where it is easier to fall.
        """
        is_wary = self._is_wary(pose)
        limit = self._safe_speed if _curvature(wanted, self._half) < TIGHT else SWIFT_SPEED
        if max(wanted) > limit + ROUNDING:
            return 0, is_wary
        if self._is_on_trail:
            return 1, False  # points of the way of a wheel are known, and cells that it passed between them are not
        if not is_wary:
            return 2, False
        return int(-ROUNDING <= sum(wanted) <= 2.0 * SLOW), True

    def _path(self, pose: Pose, wanted: Wheels, slip: Slip, hold: int = HOLD_STEPS) -> Array:
        """Where the robot, its left and its right wheel are after a command, until it has stopped: see `path`."""
        return path(pose, self._speeds, wanted, slip, self._half, self._drive.acceleration, hold)

    def _limited(self, command: Command, speed: float) -> Command:
        """The same bend, with the outer wheel no faster than a speed [m/s]."""
        asked = abs(command.v) + abs(command.w) * self._half  # more than the drive can do, perhaps
        return command if asked <= speed else _part_of(command, speed / asked)

    def _wanted(self, command: Command) -> Wheels:
        """The speeds of the wheels that a command asks for, within the limits of the drive [m/s]."""
        drive = self._drive
        v = min(max(command.v, -drive.max_speed), drive.max_speed)
        w = min(max(command.w, -drive.max_turn_rate), drive.max_turn_rate)
        left, right = v - w * self._half, v + w * self._half
        share = min(1.0, drive.max_speed / max(abs(left), abs(right), 1e-9))
        return share * left, share * right


def _part_of(command: Command, share: float) -> Command:
    """The same bend at a share of the speed."""
    return command._replace(v=share * command.v, w=share * command.w)


def _faster(speeds: Wheels) -> float:
    """Speed of the faster wheel, forward or back [m/s]."""
    left, right = speeds
    return max(abs(left), abs(right))


def _curvature(speeds: Wheels, half: float) -> float:
    """Curvature of the path of a robot whose wheels are so fast [m/s], and `half` [m] off its middle [1/m]."""
    left, right = speeds
    return abs(right - left) / (half * max(abs(left + right), ROUNDING))
