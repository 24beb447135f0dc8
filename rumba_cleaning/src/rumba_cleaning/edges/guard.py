"""Keeps the wheels on the floor, whatever a behaviour commands.

Before a command is given, it is simulated: if the robot could not stop before the edge of a known cliff, and on floor
that its sensors have seen, it drives more slowly, or not at all (D. Fox, W. Burgard, S. Thrun, The Dynamic Window
Approach to Collision Avoidance, 1997: a velocity is admissible if the robot can stop before the obstacle).
"""

import math
from typing import Callable, List, Optional, Protocol, Tuple

import numpy as np

from rumba_cleaning.behaviour import Command, Observation
from rumba_cleaning.edges.cliff_map import SPARE, CliffMap
from rumba_cleaning.edges.compiled_preview import ROUNDING, Wheels
from rumba_cleaning.edges.departure import SLOW
from rumba_cleaning.edges.preview import Preview, faster, goes_back, part_of
from rumba_cleaning.edges.rear import Rear
from rumba_cleaning.edges.release import RESERVE, Release
from rumba_cleaning.edges.slip import Alignment, Slip, along_contacts, slipped
from rumba_cleaning.edges.trail import Trail
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import RobotConfig

SHARES = (0.6, 0.3)  # of a command that are tried, after the whole and a slow one, before the robot stops; our choice
LONGEST = 0.3  # [s] the same, at most, by the time since the last one: in a longer step the node was busy
AT_REST = 0.02  # [m/s] of both wheels
CREEP = 1e-4  # [m] by which an edge may come nearer to the middle of a robot that is too near already: rounding

# The sensors see an edge in time for wheels that are no faster (a corner of 90 degrees is seen 0.08 m before a wheel is
# there, and such a robot brakes within 0.07 m), and all of the floor before wheels in bends that are no tighter.
SAFE_SPEED = 0.35  # [m/s]
SAFE_CURVATURE = 2.0  # [1/m]
# In tighter bends the inner sensor of one side looks 0.17 m ahead along the circle of the outer wheel, or up to 0.03 m
# inside that, and the outer one beside it 0.09 m ahead: a wheel that is no faster stops within 0.12 m.
TIGHT = 3.3  # [1/m]
SWIFT_SPEED = 0.38  # [m/s]
# A floor with one cliff that the map does not show may have others. Wheels that are no faster than this drive 0.029 m
# until the next reading and stop within 0.047 m; a corner of 90 degrees that comes between two sensors is seen 0.08 m
# ahead.
FOUND_SPEED = 0.29  # [m/s]
WARY = 0.5  # [m] from such a cliff: its edge may have any shape where it was not seen yet
WARY_SPEED = 0.25  # [m/s] so near: in 0.06 m the robot stops, whatever the shape is
GUESS = 3  # cells beside known floor that are taken to be floor too, elsewhere, by a robot that keeps these limits
ON_TRAIL = 2  # cells, back along its trail: points of the way of a wheel are known, what it passed between them is not
# Without a map, a robot forgets, and comes to every edge as if it had never seen it: faster ones fell down the stairs
# of the apartment, one of them in a tight bend.
RECENT_SPEED = 0.25  # [m/s] of its wheels, in any bend
RECENT_GUESS = 1  # cells as GUESS: without these, what it has forgotten holds it beside edges, until it gives up
TURN_RATE = 1.0  # [rad/s] of a robot that turns along a wall by which it slides, near such a cliff; our choice

BESIDE = 0.017  # [m] from a wheel out to where the outer sensor looks, as that of the usual robot
FLAT = 0.1  # sine of the angle of outer sensors that no distance brings before the wheels

Sides = Tuple[bool, bool]  # left and right
NONE, BOTH = (False, False), (True, True)


def why_it_creeps(robot: RobotConfig) -> str:
    """One line for a robot whose cliff sensors do not look at the floor before its wheels; empty for others."""
    half, cliff = 0.5 * robot.drive.wheel_base, robot.cliff
    aside = math.sin(min(cliff.outer_angle, 0.5 * math.pi))
    if cliff.distance * aside >= half:
        return ''
    cure = f'cliff/distance of {math.ceil(100.0 * (half + BESIDE) / aside) / 100.0:.2f} m' if aside > FLAT else (
        'a larger cliff/outer_angle')
    return (f'drive/wheel_base is {robot.drive.wheel_base:g} m and cliff/distance {cliff.distance:g} m: no cliff '
            f'sensor sees the floor before the wheels, so the robot creeps on new floor; {cure} would do')


class Knowledge(Protocol):
    """What a guard needs of the context of a robot."""

    robot: RobotConfig
    cliff_map: CliffMap
    has_map: bool

    def sense(self, observation: Observation) -> Observation:
        """Remember what the cliff sensors see; what the robot observes by it."""


class Guard:
    """Watches what a robot sees and what it is commanded; a controller, for the behaviour that is in charge."""

    def __init__(self, context: Knowledge) -> None:
        """Guard the robot of a context."""
        self._safe_speed, self._swift_speed, self._wary_guess = (
            (SAFE_SPEED, SWIFT_SPEED, 0) if context.has_map else (RECENT_SPEED, RECENT_SPEED, RECENT_GUESS))
        self._context, self._cliff_map = context, context.cliff_map
        self._acceleration = context.robot.drive.acceleration
        self._preview = Preview(context.robot.drive)
        self._clear = self._preview.half + SPARE  # [m] from the middle to an edge: the robot can turn on the spot
        self._rear = Rear(context.robot.drive.radius)
        self._trail, self._alignment = Trail(self._preview.half), Alignment()
        self._release = Release(self._cliff_map, self._preview, self._clear, self._wary_guess)
        self.rest()

    def rest(self) -> None:
        """The robot stands still, or somebody else drives it."""
        self._speeds: Wheels = (0.0, 0.0)  # [m/s] of the wheels, when the last command was given
        self._command = Command(0.0, 0.0)  # the last one
        self._last: Optional[Pose] = None
        self._alignment.forget()
        self._held = NONE  # the side on which an edge kept the robot from what it was to do
        self._rear.rest()
        self._trail.forget()
        self._is_on_trail = False  # whether the last command leads back along it
        self._release.rest()

    @property
    def held_time(self) -> float:
        """For how long edges have kept the robot, about where it is, from what it was to do [s]."""
        return self._release.held_time

    def stand_by(self, observation: Observation) -> Observation:
        """Watch while a person drives; what the robot observes, as what decides gets it."""
        self.rest()
        return self._context.sense(observation)

    def step(self, decide: Callable[[Observation], Command], observation: Observation) -> Command:
        """The command that is decided on, or one that does not lead over an edge.

        What decides gets the observation; if an edge stopped the robot, as if the cliff sensors saw it.
        """
        observation = self._context.sense(observation)
        dt = min(observation.dt, LONGEST)
        self._rear.watch(self._last, observation, 0.5 * sum(self._speeds) * dt)
        left, right = self._held
        if left or right:
            far_left, near_left, near_right, far_right = observation.cliffs
            observation = observation._replace(
                is_held=True, cliffs=(far_left or left, near_left, near_right, far_right or right))
        command = self._along_walls(self._on_trail(decide(observation), observation.pose), observation)
        self._speeds = self._preview.after(self._speeds, self._preview.wanted(self._command), dt)
        self._command = self._admitted(observation, command)
        is_held = self._held != NONE and faster(self._speeds) == 0.0
        if is_held:
            self._cliff_map.close_holes(observation.pose.x, observation.pose.y)
        if self._release.is_due(observation.pose, is_held, dt):
            self._command = self._way_out(observation, command) or self._command
        self._last = observation.pose
        return self._command

    def _on_trail(self, command: Command, pose: Pose) -> Command:
        """Have a robot that backs off go back by the way that it came, once it has met a cliff that no map shows.

        Straight back from a bend, a wheel comes where no sensor has looked, or nearer to an edge beside the way.
        """
        left, right = self._speeds
        is_braking = (left + right > 0.0 or abs(right - left) > AT_REST) and not self._is_on_trail
        is_back = command.v < 0.0 and not is_braking and bool(self._cliff_map.seen)
        motion = self._trail.back(pose) if is_back else None
        self._is_on_trail = motion is not None
        if motion is None:
            self._trail.note(pose)
            return command
        ahead, turn = motion
        share = -command.v / max(abs(ahead) + self._preview.half * abs(turn), ROUNDING)
        return command._replace(v=share * ahead, w=share * turn)

    def _along_walls(self, command: Command, observation: Observation) -> Command:
        """Have a robot that slides along a wall, near a cliff that the map does not show, turn along the wall first.

        Otherwise its wheels would lead it away from the wall as it backs off, over floor that no sensor has seen.
        """
        if command.v <= 0.0 or not self._is_wary(observation.pose):
            self._alignment.forget()
            return command
        turn = self._alignment.turn(observation.pose, self._slipped(observation), 0.5 * sum(self._speeds))
        return command._replace(v=0.0, w=math.copysign(TURN_RATE, turn)) if turn else command

    def _way_out(self, observation: Observation, command: Command) -> Optional[Command]:
        """What the release commands, with the brushes as they are to be."""
        found = self._release.way_out(observation.pose, self._speeds, lambda wanted: self._slips(observation, wanted),
                                      not self._rear.is_closed(observation))
        return found and found._replace(brushes_up=command.brushes_up)

    def _admitted(self, observation: Observation, command: Command) -> Command:
        self._held = NONE
        pose, preview = observation.pose, self._preview
        is_wary, wanted = self._is_wary(pose), preview.wanted(command)
        if faster(wanted) > WARY_SPEED and is_wary:
            command = preview.limited(command, WARY_SPEED)
            wanted = preview.wanted(command)
        fastest = max(faster(self._speeds), faster(wanted))
        braking = fastest * LONGEST + 0.5 * fastest ** 2 / self._acceleration
        is_near = self._cliff_map.clearance_at(pose.x, pose.y) <= self._clear + braking
        must_know = is_wary or not (self._sees_ahead(wanted) and self._sees_ahead(self._speeds))
        if not (is_near or must_know) or fastest == 0.0:
            return command
        if is_near and goes_back(wanted) and self._rear.is_closed(observation, self._is_on_trail):
            self._held = BOTH if faster(self._speeds) < AT_REST else NONE
            return command._replace(v=0.0, w=0.0)
        found, slips = [], self._slips(observation, wanted)
        for slower in (command, *self._slower(command)):
            found.append(self._edges(pose, preview.wanted(slower), slips, is_near, must_know))
            if found[-1] == NONE:
                return slower
        if faster(self._speeds) < AT_REST:
            self._held = found[0]
        return command._replace(v=0.0, w=0.0)

    def _slower(self, command: Command) -> List[Command]:
        """What may do where a command would lead too near to an edge, in the order in which to try it.

        In a bend, a wheel may cut inside the way of its sensor: once it has turned, the robot drives behind that. And
        once it heads away from an edge that it came too near to, it drives on.
        """
        limited = [self._preview.limited(command, limit) for limit in self._limits()]
        spot = self._preview.limited(command._replace(v=0.0), WARY_SPEED)
        on_the_spot = [spot] if self._preview.moves(spot) else []
        parts = [part_of(command, share) for share in SHARES]
        is_mostly_turn = abs(command.w) * self._preview.half > abs(command.v)
        return limited + (on_the_spot + parts if is_mostly_turn else parts + on_the_spot)

    def _is_wary(self, pose: Pose) -> bool:
        """Whether a cliff that the map does not show is near."""
        return bool(self._cliff_map.seen) and self._cliff_map.clearance_at(pose.x, pose.y) < WARY

    def _limits(self) -> Tuple[float, float]:
        """How fast a wheel may be where no floor is known, in a tight bend and otherwise [m/s]."""
        if self._cliff_map.seen:
            return min(FOUND_SPEED, self._safe_speed), min(FOUND_SPEED, self._safe_speed)
        return self._swift_speed, self._safe_speed

    def _sees_ahead(self, speeds: Wheels) -> bool:
        """Whether the cliff sensors see the floor under the wheels before it is too late, with no need to remember."""
        left, right = speeds
        return min(left, right) >= 0.0 and max(left, right) <= self._limits()[1] and (
            left + right == 0.0 or self._preview.curvature(speeds) <= SAFE_CURVATURE)

    def _slips(self, observation: Observation, wanted: Wheels) -> List[Slip]:
        """How the robot may slide after a command: as it did last, and, if it drives forward, along what it touches."""
        fastest = max(faster(self._speeds), faster(wanted))
        pushes = max(sum(wanted), sum(self._speeds)) > 0.0
        return [self._slipped(observation), *(along_contacts(observation, fastest) if pushes else [])]

    def _slipped(self, observation: Observation) -> Slip:
        """How the robot slid since the observation before."""
        last = self._last if observation.dt < LONGEST else None
        return slipped(last, observation, 0.5 * sum(self._speeds))

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
        middle, left, right = self._preview.path(pose, self._speeds, wanted, slip)
        if is_near:
            near = [self._cliff_map.clearances(line) for line in (middle, left, right)]
            spare = RESERVE if self._is_on_trail else SPARE
            least = [min(line[0], limit) for line, limit in zip(near, (self._clear, spare, spare))]
            if (near[0] < least[0] - CREEP).any():
                worst = int(np.argmin(near[0]))
                return bool(near[1][worst] <= near[2][worst]), bool(near[2][worst] <= near[1][worst])
            over = bool((near[1] < least[1]).any()), bool((near[2] < least[2]).any())
            if any(over):
                return over
        if must_know:
            guess = self._guess(pose, wanted)
            return not self._cliff_map.are_known(left[1:], *guess), not self._cliff_map.are_known(right[1:], *guess)
        return NONE

    def _guess(self, pose: Pose, wanted: Wheels) -> Tuple[int, bool]:
        """How many cells beside known floor are taken to be floor too, and whether only beside what a sensor saw.

        They are fewer where it is easier to fall.
        """
        is_wary = self._is_wary(pose)
        if max(wanted) > self._limits()[self._preview.curvature(wanted) < TIGHT] + ROUNDING:
            return 0, is_wary
        if self._is_on_trail:
            return ON_TRAIL, False
        if not is_wary:
            return GUESS, False
        is_creeping = -ROUNDING <= sum(wanted) <= 2.0 * SLOW
        return self._wary_guess if is_creeping else 0, True
