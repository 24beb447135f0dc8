"""The obstacles that move from stop to stop; they wait for robots, and turn back in the end."""

import math

from rumba_sim.model.kernel import Array, Record
from rumba_sim.model.kernel.geometry import wrap
from rumba_sim.model.kernel.hashing import scrambled
from rumba_sim.model.kernel.motion import PUSH
from rumba_sim.model.kernel.obstacles import is_near, outside
from rumba_sim.model.kernel.records import LEAST, MOST, THETA, TRAVEL, X, Y

PATIENCE = 5.0  # [s] that a mover waits for a robot before it turns back: it shall not hold a robot for ever
HALVINGS = 10  # of the last step of a mover before a contact, which is then known to a thousandth of the step


def go(obstacles: Array, stops: Array, robots: Array, k: Record) -> None:
    """Let the movers among the obstacles go on for one tick; they stop at robots, wait, and turn back in the end."""
    for index in range(len(obstacles)):
        mover = obstacles[index]
        if mover.stops == 0:
            continue
        if mover.rest > 0:
            mover.rest -= 1
            continue
        travel = stops[mover.first + (mover.stop + 1) % mover.stops, TRAVEL]
        before = mover.moved
        moved = max(before - 1.0, 0.0) if mover.is_back else min(before + 1.0, travel)
        if is_blocked(mover, stops, robots, k, before, moved):
            moved = farthest(mover, stops, robots, k, before, moved)
            mover.waited += 1
        else:
            mover.waited = 0
        put_between(mover, stops, moved)
        if mover.waited * k.dt >= PATIENCE:
            turn_round(mover)
        elif moved == (0.0 if mover.is_back else travel):
            arrive(mover, stops)


def turn_round(mover: Record) -> None:
    """Let a mover that lost patience go the other way: back by one stop more each time that it meets the robot there.

    Not beyond the end of a way to and fro, nor by more than half of a loop: farther on, they lead to the robot again.
    """
    mover.waited, mover.is_back = 0, not mover.is_back
    if mover.is_back:
        mover.retreats = min(mover.retreats + 1, mover.stops // 2)


def arrive(mover: Record, stops: Array) -> None:
    """Let a mover pause at the next stop, or where it goes back to; it passes stops on its way back."""
    if mover.is_back and mover.behind + 1 < mover.retreats and not is_at_end(mover, stops):
        mover.moved = stops[mover.first + mover.stop, TRAVEL]
        mover.stop = (mover.stop + mover.stops - 1) % mover.stops
        mover.behind += 1
        return
    if mover.is_back:
        mover.is_back = False
    else:
        mover.stop, mover.moved = (mover.stop + 1) % mover.stops, 0.0
        if mover.behind == 0:
            mover.retreats = 0
        mover.behind = max(mover.behind - 1, 0)
    mover.visits += 1
    mover.rest = pause(mover, stops)


def is_at_end(mover: Record, stops: Array) -> bool:
    """Whether the way turns at the last stop of a mover: it leads there from the place to which it leads next."""
    before = stops[mover.first + (mover.stop + mover.stops - 1) % mover.stops]
    after = stops[mover.first + (mover.stop + 1) % mover.stops]
    return bool(before[X] == after[X] and before[Y] == after[Y])


def farthest(mover: Record, stops: Array, robots: Array, k: Record, before: float, moved: float) -> float:
    """How far a mover can move [ticks of its way], from `before` and not up to `moved`, until it meets a robot."""
    free = before
    for _ in range(HALVINGS):
        middle = 0.5 * (free + moved)
        if is_blocked(mover, stops, robots, k, before, middle):
            moved = middle
        else:
            free = middle
    return free


def is_blocked(mover: Record, stops: Array, robots: Array, k: Record, before: float, moved: float) -> bool:
    """Whether a mover comes too near to a robot if it moves on from `before` to `moved` [ticks of its way].

    A mover that touches a robot may move away from it.
    """
    for index in range(len(robots)):
        x, y = robots[index].x, robots[index].y
        put_between(mover, stops, before)
        if is_near(mover, x, y, 3.0 * k.radius):  # no point of a mover moves by more than a radius in a tick
            gap_before = outside(mover, x, y)[0]
            put_between(mover, stops, moved)
            gap = outside(mover, x, y)[0]
            if gap < k.radius + PUSH and gap < gap_before:
                return True
    return False


def put_between(mover: Record, stops: Array, moved: float) -> None:
    """Put a mover where it is `moved` [ticks of its way] after it left its last stop."""
    here, there = stops[mover.first + mover.stop], stops[mover.first + (mover.stop + 1) % mover.stops]
    share = moved / there[TRAVEL]
    mover.moved = moved
    mover.x = here[X] + share * (there[X] - here[X])
    mover.y = here[Y] + share * (there[Y] - here[Y])
    mover.theta = wrap(here[THETA] + share * wrap(there[THETA] - here[THETA]))
    mover.cos, mover.sin = math.cos(mover.theta), math.sin(mover.theta)


def pause(mover: Record, stops: Array) -> int:
    """How long a mover stands at the stop that it has reached [ticks]: by a hash of its key and of its visits."""
    stop = stops[mover.first + mover.stop]
    return int(stop[LEAST] + scrambled(mover.key, mover.visits) / 0x100000000 * (stop[MOST] - stop[LEAST]) + 0.5)
