"""The dock of the fake Create, and how its firmware finds it: by three receivers of infrared, and the bumper.

The dock sends a red buoy into the left half of the field before it, as seen by a robot that faces it, and a green one
into the right half, which overlap about its axis, and a force field around it (iRobot Create 2 Open Interface, on the
characters of the home base). A receiver on top of the robot gets all of them, one on each front side what comes from
there.
"""

import enum
import math
from typing import NamedTuple

import numpy as np

FORCE_FIELD, GREEN, RED, BASE = 1, 4, 8, 160
DEPTH, WIDTH = 0.05, 0.16  # [m] of the body of the dock, which stands at a wall
HALF, OVERLAP = math.radians(30), math.radians(5)  # of the field of both buoys; of each beyond the axis
FAR, NEAR = 2.5, 0.5  # [m] reach of the buoys and of the force field
AHEAD, ASIDE = math.radians(4), math.radians(60)  # field of a front receiver: beyond straight ahead, and to its side
ON_CONTACTS, SIDEWAYS, ASKEW = 0.012, 0.03, 0.2  # [m], [m], [rad]
OFF_AXIS = math.radians(50)  # by which the firmware turns off the direction of the dock, to get onto its axis


class Received(NamedTuple):
    """What the receivers get."""

    omni: int  # the character
    left: bool
    right: bool


class Dock:
    """At the upper wall of a room: robots face up on it."""

    def __init__(self, x, wall):
        """Stand in the middle of x at a wall [m]."""
        self.sends = True
        self.front = np.array([x, wall - DEPTH])
        self.body = x - WIDTH / 2, wall - DEPTH, x + WIDTH / 2, wall

    def touches(self, pose, radius):
        """Whether the contacts of a robot are closed."""
        x, y, theta = pose
        return bool(self.front[1] - radius - y < ON_CONTACTS and abs(x - self.front[0]) < SIDEWAYS
                    and abs(math.remainder(theta - math.pi / 2, math.tau)) < ASKEW)

    def received(self, pose, walls):
        """What a robot receives; walls are in the way."""
        x, y, theta = pose
        away = self.front - (x, y)
        distance, direction = math.hypot(*away), math.atan2(away[1], away[0])
        if not self.sends or walls.ranges(x, y, np.array([direction]))[0] < distance:
            return Received(0, False, False)
        side = direction - math.pi / 2  # of the axis: the robot is on the right if it is positive
        code = FORCE_FIELD * (distance < NEAR)
        if distance < FAR and abs(side) < HALF:
            code += GREEN * (side > -OVERLAP) + RED * (side < OVERLAP)
        bearing = math.remainder(direction - theta, math.tau)
        return Received(BASE + code if code else 0, bool(code and -AHEAD < bearing < ASIDE),
                        bool(code and -ASIDE < bearing < AHEAD))


class Phase(enum.Enum):
    """What the firmware does."""

    LOOK = 'turn until both front receivers get a beam'
    ASIDE = 'turn off the direction of the dock, towards its axis'
    CROSS = 'drive to its axis'
    HOME = 'drive to the dock'
    BACK = 'back off'
    STRAY = 'drive where it looks, as no beam came all around'


class Firmware:
    """Decides ten times a second, until somebody sees that the robot charges."""

    def __init__(self):
        self.phase, self.since, self.goal = Phase.LOOK, None, 0.0
        self.turned = 0.0  # [rad] without a beam
        self.last = 0.0  # heading
        self.pressed = 0

    def enter(self, phase, guess, goal=0.0):
        """Begin with something else."""
        self.phase, self.since, self.goal, self.turned, self.pressed = phase, guess.copy(), goal, 0.0, 0

    def step(self, received, bumped, guess):
        """The next velocity, [m/s] and [rad/s], by what is received and by the odometry."""
        if self.since is None:
            self.enter(Phase.LOOK, guess)
        driven, heading = math.hypot(*(guess - self.since)[:2]), guess[2]
        beams = received.omni & 15 if received.omni else 0
        both = beams & RED and beams & GREEN
        faces = received.left and received.right
        self.pressed = self.pressed + 1 if any(bumped) else 0
        if self.phase is Phase.BACK:
            if driven < self.goal:
                return -0.1, 0.0
            self.enter(Phase.LOOK, guess)
        if self.phase is Phase.LOOK:
            if faces and both:
                self.enter(Phase.HOME, guess)
            elif faces and beams & (RED | GREEN):
                self.enter(Phase.ASIDE, guess, heading + (OFF_AXIS if beams & GREEN else -OFF_AXIS))
            else:
                self.turned += abs(heading - self.last) if self.last else 0.0
                self.last = heading
                if self.turned > 1.2 * math.tau:
                    self.enter(Phase.STRAY, guess)
                return 0.0, -0.5 if received.right and not received.left else 0.5
        if self.phase is Phase.ASIDE:
            error = math.remainder(self.goal - heading, math.tau)
            if abs(error) > 0.05:
                return 0.0, math.copysign(max(0.2, min(0.7, 2 * abs(error))), error)
            self.enter(Phase.CROSS, guess)
        if self.phase is Phase.CROSS:
            if both or driven > 1.0:
                self.enter(Phase.LOOK, guess)
            elif self.pressed:
                self.enter(Phase.BACK, guess, 0.25)
            return 0.1, 0.0
        if self.phase is Phase.STRAY:
            if self.pressed:
                self.enter(Phase.BACK, guess, 0.3)
            elif beams & (RED | GREEN) or driven > 2.0:
                self.enter(Phase.LOOK, guess)
            return 0.2, 0.0
        return self.home(received, both, guess)

    def home(self, received, both, guess):
        """Drive along the axis, with the beam between the front receivers; what is no contact is backed off from."""
        if self.pressed > 10:
            self.enter(Phase.BACK, guess, 0.35)
        elif not both and not received.omni & FORCE_FIELD:
            self.enter(Phase.LOOK, guess)
        speed = 0.05 if received.omni & FORCE_FIELD else 0.15
        return speed, 0.3 * (int(received.left) - int(received.right))
