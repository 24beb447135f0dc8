"""What robots and movers do in one tick (drive, collide, count, drain, sweep), and what laser and infrared see.

This is plain Python that `compiled` hands to numba as a whole: it uses only numbers, arrays and records, and imports
only math and NumPy. Uncompiled, the same functions give the same results about a hundred times slower.

Units: [m], [rad], [s], [A], [Ah]. Arguments that many functions share:
    k: the record of constants (`constants.Constants`).
    robots: array of records of type ROBOT.
    field: float64 (rows + 1, columns + 1), clearance at the corners of the cells.
    cells: uint8 (rows, columns), the bits BLOCKED, CLIFF and CARPET of each cell.
    samples: uint8 (n * rows, n * columns), the bits SWEEPABLE and REACHABLE, and how often the brush passed, of the
        sample point in each of the n x n squares of a cell.
    dirt: float32 (rows, columns), dirt on the samples of each cell in the beginning.
    skips: uint8 (rows, columns), how many cells a beam may skip from anywhere in a cell, or IN_WALL
        (`FloorPlan.skips`).
    obstacles: array of records of type OBSTACLE, which the map does not show.
    docks: float64 (docks, 3), pose of a robot that stands at the contacts of each and faces it [m, rad].
    stops: float64 (all stops of all movers, 6), the columns X, Y, THETA, TRAVEL, LEAST and MOST of each stop.
In arrays of cells row 0 lies at the lowest y.
"""

import math
from typing import Any, Tuple

import numpy as np

Record = Any  # an element of an array of one of the record types below
Array = Any  # numpy.ndarray
Triple = Tuple[float, float, float]

BLOCKED, CLIFF, CARPET = 1, 2, 4  # bits of a cell
SWEEPABLE, REACHABLE, PASS = 1, 2, 4  # bits of a sample; the bits from PASS on count how often the brush passed it
MOST_PASSES = 63  # that fit into a byte; after so many no dirt is left
BEND = 0.15  # [rad] turns are swept in pieces of at most this: the brush is up to 0.3 % longer or shorter in them
STRIDE = 0.03  # [m] the floor is swept in strides of about this: sweeping in each tick takes several times longer
TURN_STRIDE = 0.12  # [rad] the same in turns: less than BEND, so that each stride is swept in one piece
LEFT, RIGHT = 1, 2  # bits of the bumper
NO_BEAM, FORCE_FIELD, GREEN_BUOY, RED_BUOY = 0, 1, 4, 8  # rumba_msg/DockStatus
INNER, OUTER = 0.26, 1.57  # [rad] how far the left receiver sees to the right and to the left
NEVER = -1
TOUCH = 0.0005  # [m] a smaller gap is a contact
PUSH = 0.0001  # [m] a push leaves this gap, so that rounding cannot leave an overlap
PUSHES = 8  # how often a robot is pushed in one tick before it stays where it was
IN_WALL = 255  # instead of what a beam may skip: there is a wall
NUDGE = 1e-7  # [cells] that carries a beam across a border; a beam with less drift per cell is parallel to the border

ROBOT = np.dtype((np.record, np.dtype([(name, 'f8') for name in (
    'x', 'y', 'theta', 'left_speed', 'right_speed', 'command_v', 'command_w', 'left_scale', 'right_scale',
    'left_path', 'right_path', 'odom_x', 'odom_y', 'odom_theta', 'odom_v', 'odom_w', 'charge', 'current', 'distance',
    'brush_time', 'contact_angle', 'swept_x', 'swept_y', 'swept_theta', 'swept_distance')] + [
        (name, 'i8') for name in ('command_tick', 'left_ticks', 'right_ticks', 'bumps', 'alone_until')] + [
            (name, 'u1') for name in ('bumper', 'brushes_up', 'docked', 'fallen', 'sweeps')], align=True)))
# A disc has a radius, and halves that are 0; a box has halves, and a radius that is 0. `reach` is the distance from its
# centre to its farthest point. A mover has `stops` stops from row `first` of the array of stops on; it has left number
# `stop` of them, `moved` [ticks] ago, or stands there for `rest` ticks more; it has reached stops `visits` times. For
# `waited` ticks a robot has been in its way; `is_back` while it goes back, for lack of patience. It has turned back
# `retreats` times on the way to the same stop, and is `behind` stops before the one from which that way leads.
OBSTACLE = np.dtype((np.record, np.dtype([(name, 'f8') for name in (
    'x', 'y', 'theta', 'cos', 'sin', 'half_length', 'half_width', 'radius', 'reach', 'moved')] + [
        (name, 'i8') for name in (
            'first', 'stops', 'stop', 'rest', 'visits', 'waited', 'retreats', 'behind', 'key')] + [
                (name, 'u1') for name in ('is_back', 'is_seen')], align=True)))
X, Y, THETA = 0, 1, 2  # columns of a stop and of a dock: its pose [m, rad]
TRAVEL = 3  # [ticks] that the way from the stop before takes
LEAST, MOST = 4, 5  # [ticks] shortest and longest pause
PATIENCE = 5.0  # [s] that a mover waits for a robot before it turns back: it shall not hold a robot for ever
HALVINGS = 10  # of the last step of a mover before a contact, which is then known to a thousandth of the step
TALLY = np.dtype((np.record, np.dtype([('swept', 'i8'), ('dirt', 'f8')], align=True)))


def advance(robots: Array, constants: Array, obstacles: Array, docks: Array, field: Array, cells: Array,
            samples: Array, dirt: Array, tallies: Array, noise: Array, tick: int, ticks: int) -> None:
    """Simulate `ticks` ticks; the first of them has the number `tick`.

    Args, apart from those above:
        constants: array of one record `k`.
        tallies: array of one record of type TALLY.
        noise: float64 (robots, any, 2), standard normal; tick t uses row t modulo the number of rows.
    """
    k, tally = constants[0], tallies[0]
    for now in range(tick, tick + ticks):
        for me in range(len(robots)):
            robot = robots[me]
            drive(robot, k, now)
            start = robot.x, robot.y, robot.theta
            toward_x, toward_y = move(robots, me, k, obstacles, field, now)
            traction = stand(robot, k, cells) if k.has_layers else k.floor_traction
            count(robot, k, traction, noise[me, now % noise.shape[1]])
            touch(robots, me, k, obstacles, field, now, toward_x, toward_y)
            work(robot, k, docks, samples, dirt, tally, start)


def follow(robots: Array, constants: Array, obstacles: Array, docks: Array, field: Array, cells: Array, samples: Array,
           dirt: Array, tallies: Array, noise: Array, tick: int, led: Array) -> None:
    """Simulate one tick in which something else moves the robots.

    Args, apart from those of `advance`:
        led: float64 (robots, 4): x, y and theta after the tick, and 1 if the wheels turned on the way, 0 if the robot
            was carried.
    """
    k, tally = constants[0], tallies[0]
    for me in range(len(robots)):
        robot = robots[me]
        start = lead(robot, k, led[me])
        traction = stand(robot, k, cells) if k.has_layers else k.floor_traction
        count(robot, k, traction, noise[me, tick % noise.shape[1]])
        touch(robots, me, k, obstacles, field, tick, 0.0, 0.0)
        work(robot, k, docks, samples, dirt, tally, start)


def work(robot: Record, k: Record, docks: Array, samples: Array, dirt: Array, tally: Record, start: Triple) -> None:
    """Sweep, dock and use energy in a tick that began with the pose `start`."""
    brush(robot, k, samples, dirt, tally, start)
    robot.docked = at_contacts(robot, k, docks)
    robot.current = battery_current(robot.charge, k, load(robot, k), robot.docked)
    robot.charge = charge_after(robot.charge, k, robot.current, k.dt)


# --- geometry -----------------------------------------------------------------------------------------------------

def wrap(angle: float) -> float:
    """The same direction in (-pi, pi]."""
    return angle if -math.pi < angle <= math.pi else math.pi - (math.pi - angle) % (2.0 * math.pi)


def arc(x: float, y: float, theta: float, distance: float, turn: float) -> Triple:
    """The pose after an exact arc of length `distance` that changes the heading by `turn`."""
    half = 0.5 * turn
    chord = distance * (math.sin(half) / half) if abs(half) > 1e-6 else distance
    return x + chord * math.cos(theta + half), y + chord * math.sin(theta + half), wrap(theta + turn)


def interpolated(field: Array, u: float, v: float) -> Triple:
    """Bilinear interpolation between the corners of a cell: the value at (u, v) [cells], and its slopes along u and v.

    All are 0 outside the grid and if a coordinate is NaN.
    """
    if not (0.0 <= u < field.shape[1] - 1 and 0.0 <= v < field.shape[0] - 1):
        return 0.0, 0.0, 0.0
    column, row = int(u), int(v)
    u, v = u - column, v - row
    lower = field[row, column + 1] - field[row, column]
    upper = field[row + 1, column + 1] - field[row + 1, column]
    left = field[row + 1, column] - field[row, column]
    along_u = lower + v * (upper - lower)
    return field[row, column] + u * along_u + v * left, along_u, left + u * (upper - lower)


def interpolated_at(field: Array, left: float, bottom: float, resolution: float, points: Array) -> Array:
    """The values of `interpolated` at points [m], map frame.

    Args:
        field: float64 (rows + 1, columns + 1).
        left, bottom: of the grid [m], map frame.
        resolution: of the grid [m].
        points: float64 (any, 2) [m].

    Returns:
        float64 (any)
    """
    values = np.empty(len(points))
    for index in range(len(points)):
        values[index] = interpolated(field, (points[index, 0] - left) / resolution,
                                     (points[index, 1] - bottom) / resolution)[0]
    return values


def clearance(k: Record, field: Array, x: float, y: float) -> Triple:
    """Distance to the nearest wall, and its gradient along x and y."""
    gap, along_u, along_v = interpolated(field, (x - k.origin_x) / k.resolution, (y - k.origin_y) / k.resolution)
    return gap, along_u / k.resolution, along_v / k.resolution


def cell_bits(k: Record, cells: Array, x: float, y: float) -> int:
    """The byte of the cell that contains a point; outside the map everything is BLOCKED."""
    u, v = (x - k.origin_x) / k.resolution, (y - k.origin_y) / k.resolution
    if 0.0 <= u < cells.shape[1] and 0.0 <= v < cells.shape[0]:
        return int(cells[int(v), int(u)])
    return BLOCKED


# --- motion -------------------------------------------------------------------------------------------------------

def drive(robot: Record, k: Record, now: int) -> None:
    """Change the speeds of the wheels toward the last command, as far as the limits allow."""
    v, w = 0.0, 0.0
    if robot.command_tick != NEVER and now - robot.command_tick < k.timeout_ticks and robot.charge > 0.0 and (
            not robot.fallen):
        v = min(max(robot.command_v, -k.max_speed), k.max_speed)
        w = min(max(robot.command_w, -k.max_turn_rate), k.max_turn_rate)
    left, right = v - 0.5 * w * k.wheel_base, v + 0.5 * w * k.wheel_base
    fastest = max(abs(left), abs(right))
    if fastest > k.max_speed:  # both by the same factor, so that the arc stays the same
        left, right = left * k.max_speed / fastest, right * k.max_speed / fastest
    robot.left_speed = approach(robot.left_speed, left, k)
    robot.right_speed = approach(robot.right_speed, right, k)


def approach(speed: float, wanted: float, k: Record) -> float:
    """The speed of a wheel after one tick of acceleration toward the wanted speed."""
    if abs(wanted) < k.dead_band:
        wanted = 0.0
    change = k.acceleration * k.dt
    return min(max(wanted, speed - change), speed + change)


def move(robots: Array, me: int, k: Record, obstacles: Array, field: Array, now: int) -> Tuple[float, float]:
    """Move a robot as its wheels turn for one tick; it slides along obstacles and never enters them.

    Returns the vector from where the robot is now to where its wheels led: (0, 0) if nothing was in the way.
    """
    robot = robots[me]
    distance = 0.5 * (robot.left_speed + robot.right_speed) * k.dt
    turn = (robot.right_speed - robot.left_speed) / k.wheel_base * k.dt
    if distance == 0.0:
        robot.theta = wrap(robot.theta + turn)
        return 0.0, 0.0
    to_x, to_y, robot.theta = arc(robot.x, robot.y, robot.theta, distance, turn)
    x, y = settle(robots, me, k, obstacles, field, now, to_x, to_y)
    robot.distance += math.hypot(x - robot.x, y - robot.y)
    robot.x, robot.y = x, y
    return to_x - x, to_y - y


def lead(robot: Record, k: Record, to: Array) -> Triple:
    """Put a robot at the pose `to` within one tick, and set the speeds of its wheels to match.

    `to` is a row of `led` of `follow`. Returns the pose from which the brush sweeps in this tick.
    """
    from_x, from_y, from_theta = robot.x, robot.y, robot.theta
    robot.x, robot.y, robot.theta = to[0], to[1], to[2]
    if to[3] == 0.0:
        robot.left_speed = robot.right_speed = 0.0
        return to[0], to[1], to[2]
    turn = wrap(to[2] - from_theta)
    along = from_theta + 0.5 * turn
    distance = (to[0] - from_x) * math.cos(along) + (to[1] - from_y) * math.sin(along)
    robot.left_speed = (distance - 0.5 * turn * k.wheel_base) / k.dt
    robot.right_speed = (distance + 0.5 * turn * k.wheel_base) / k.dt
    robot.distance += abs(distance)
    return from_x, from_y, from_theta


def halted(robot: Record, k: Record, field: Array, v: float) -> float:
    """The part of a forward speed `v` that does not drive a robot into a wall within one tick."""
    gap, along_x, along_y = clearance(k, field, robot.x, robot.y)
    nearer = -v * k.dt * (along_x * math.cos(robot.theta) + along_y * math.sin(robot.theta))
    if nearer <= 0.0 or gap - nearer >= k.reach:
        return v
    return v * max(gap - k.reach, 0.0) / nearer


def settle(robots: Array, me: int, k: Record, obstacles: Array, field: Array, now: int, x: float,
           y: float) -> Tuple[float, float]:
    """Where a robot ends that moves to (x, y): pushed out of all that is there, or where it was if that fails."""
    for _ in range(PUSHES):
        gap, along_x, along_y = clearance(k, field, x, y)
        free = gap >= k.reach
        if not free:
            slope = math.hypot(along_x, along_y)
            if slope < 1e-6:
                break
            push = (k.reach + PUSH - gap) / slope
            x, y = x + push * along_x, y + push * along_y
        if len(obstacles) > 0:
            gap, along_x, along_y = nearest_obstacle(obstacles, x, y, k.radius)
            if gap < k.radius:
                free = False
                push = k.radius + PUSH - gap
                x, y = x + push * along_x, y + push * along_y
        if now >= robots[me].alone_until:
            other, distance = nearest(robots, me, k, now, x, y)
            if other >= 0 and distance < 2.0 * k.radius:
                if distance < 1e-6:
                    break
                free = False
                push = (2.0 * k.radius + PUSH - distance) / distance
                x, y = x + push * (x - robots[other].x), y + push * (y - robots[other].y)
        if free:
            if math.hypot(x - robots[me].x, y - robots[me].y) > max_displacement(k):
                break
            return x, y
    return robots[me].x, robots[me].y


def max_displacement(k: Record) -> float:
    """The farthest that a robot may move in one tick: a push may double what it drives."""
    return 2.0 * (k.max_speed * k.dt + PUSH)


def nearest(robots: Array, me: int, k: Record, now: int, x: float, y: float) -> Tuple[int, float]:
    """Index of the other robot that is nearest to (x, y), -1 if there is none, and its distance.

    Sets `alone_until`: before that tick no other robot can come near, so that robots far apart need not search.
    """
    other, square = -1, math.inf
    for index in range(len(robots)):
        if index != me:
            dx, dy = robots[index].x - x, robots[index].y - y
            if dx * dx + dy * dy < square:
                other, square = index, dx * dx + dy * dy
    distance = math.sqrt(square)
    if other < 0:
        robots[me].alone_until = now + 1000
    else:
        # Both robots may approach each other, and this one may still be pushed away from (x, y).
        robots[me].alone_until = now + int((distance - 2.0 * k.radius - TOUCH) / (2.0 * max_displacement(k))) - 1
    return other, distance


def touch(robots: Array, me: int, k: Record, obstacles: Array, field: Array, now: int, toward_x: float,
          toward_y: float) -> None:
    """Press the switches of the bumper if a wall, an obstacle or a robot touches the front.

    (toward_x, toward_y) points to what stopped the robot; (0, 0) if nothing did.
    """
    robot = robots[me]
    robot.contact_angle = math.nan
    pressed = press(robot, k, toward_x, toward_y) if toward_x != 0.0 or toward_y != 0.0 else 0
    gap, along_x, along_y = clearance(k, field, robot.x, robot.y)
    if gap < k.reach + PUSH + TOUCH:
        pressed |= press(robot, k, -along_x, -along_y)
    for index in range(len(obstacles)):
        if is_near(obstacles[index], robot.x, robot.y, k.radius + PUSH + TOUCH):
            gap, along_x, along_y = outside(obstacles[index], robot.x, robot.y)
            if gap < k.radius + PUSH + TOUCH:
                pressed |= press(robot, k, -along_x, -along_y)
    if now >= robot.alone_until:
        _, distance = nearest(robots, me, k, now, robot.x, robot.y)
        if distance < 2.0 * k.radius + PUSH + TOUCH:
            for other in range(len(robots)):
                x, y = robots[other].x - robot.x, robots[other].y - robot.y
                if other != me and math.hypot(x, y) < 2.0 * k.radius + PUSH + TOUCH:
                    pressed |= press(robot, k, x, y)
    if pressed and not robot.bumper:
        robot.bumps += 1
    robot.bumper = pressed


def press(robot: Record, k: Record, toward_x: float, toward_y: float) -> int:
    """The switches that a contact in this direction presses; updates `contact_angle` if it is nearer to the front."""
    angle = wrap(math.atan2(toward_y, toward_x) - robot.theta)
    if not abs(angle) >= abs(robot.contact_angle):  # true also if there was no contact yet: NaN
        robot.contact_angle = angle
    if abs(angle) > k.bumper_half:
        return 0
    return (LEFT if angle >= -k.overlap_half else 0) | (RIGHT if angle <= k.overlap_half else 0)


def stand(robot: Record, k: Record, cells: Array) -> float:
    """Mark a robot as fallen if a wheel is over a cliff; returns the traction of its wheels."""
    x, y = -0.5 * k.wheel_base * math.sin(robot.theta), 0.5 * k.wheel_base * math.cos(robot.theta)
    left, right = cell_bits(k, cells, robot.x + x, robot.y + y), cell_bits(k, cells, robot.x - x, robot.y - y)
    if (left | right) & CLIFF:
        robot.fallen = True
    return k.carpet_traction if left & right & CARPET else k.floor_traction


def count(robot: Record, k: Record, traction: float, noise: Array) -> None:
    """Count the encoder ticks of both wheels, with slip, scale and noise, and update the odometry from them alone."""
    left, right = robot.left_speed * k.dt, robot.right_speed * k.dt
    left = left / traction * robot.left_scale + k.noise * math.sqrt(abs(left)) * noise[0]
    right = right / traction * robot.right_scale + k.noise * math.sqrt(abs(right)) * noise[1]
    robot.odom_v, robot.odom_w = 0.5 * (left + right) / k.dt, (right - left) / k.wheel_base / k.dt
    robot.left_path += left
    robot.right_path += right
    left_ticks = math.floor(robot.left_path * k.ticks_per_metre)
    right_ticks = math.floor(robot.right_path * k.ticks_per_metre)
    left = (left_ticks - robot.left_ticks) / k.ticks_per_metre
    right = (right_ticks - robot.right_ticks) / k.ticks_per_metre
    robot.left_ticks, robot.right_ticks = left_ticks, right_ticks
    if left != 0.0 or right != 0.0:
        robot.odom_x, robot.odom_y, robot.odom_theta = arc(
            robot.odom_x, robot.odom_y, robot.odom_theta, 0.5 * (left + right), (right - left) / k.wheel_base)


# --- obstacles ----------------------------------------------------------------------------------------------------

def is_near(obstacle: Record, x: float, y: float, within: float) -> bool:
    """Whether an obstacle may be nearer than `within` to (x, y): false if the circle around it is not."""
    dx, dy, far = x - obstacle.x, y - obstacle.y, obstacle.reach + within
    return bool(dx * dx + dy * dy < far * far)


def outside(obstacle: Record, x: float, y: float) -> Triple:
    """Distance from an obstacle to (x, y), negative inside it, and the direction away from it as a unit vector."""
    dx, dy = x - obstacle.x, y - obstacle.y
    u, v = obstacle.cos * dx + obstacle.sin * dy, obstacle.cos * dy - obstacle.sin * dx
    beyond_u, beyond_v = abs(u) - obstacle.half_length, abs(v) - obstacle.half_width
    if beyond_u <= 0.0 and beyond_v <= 0.0:
        gap = max(beyond_u, beyond_v)
        along_u, along_v = (1.0, 0.0) if beyond_u > beyond_v else (0.0, 1.0)
    else:
        along_u, along_v = max(beyond_u, 0.0), max(beyond_v, 0.0)
        gap = math.hypot(along_u, along_v)
        along_u, along_v = along_u / gap, along_v / gap
    along_u, along_v = math.copysign(along_u, u), math.copysign(along_v, v)
    return (gap - obstacle.radius, obstacle.cos * along_u - obstacle.sin * along_v,
            obstacle.sin * along_u + obstacle.cos * along_v)


def nearest_obstacle(obstacles: Array, x: float, y: float, within: float) -> Triple:
    """What `outside` answers for the nearest obstacle; (`within`, 0, 0) if none is nearer than that."""
    least, away_x, away_y = within, 0.0, 0.0
    for index in range(len(obstacles)):
        if is_near(obstacles[index], x, y, least):
            gap, along_x, along_y = outside(obstacles[index], x, y)
            if gap < least:
                least, away_x, away_y = gap, along_x, along_y
    return least, away_x, away_y


def keep_clear(obstacles: Array, k: Record, field: Array) -> None:
    """Reduce the clearance at the corners of the cells to the distance from obstacles, where that is smaller."""
    for row in range(field.shape[0]):
        for column in range(field.shape[1]):
            x, y = k.origin_x + column * k.resolution, k.origin_y + row * k.resolution
            field[row, column] = max(nearest_obstacle(obstacles, x, y, field[row, column])[0], 0.0)


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


# --- floor --------------------------------------------------------------------------------------------------------

def brush(robot: Record, k: Record, samples: Array, dirt: Array, tally: Record, start: Triple) -> None:
    """Sweep the floor if the brush works, stride by stride; `start` is the pose at the beginning of the tick.

    `swept_x`, `swept_y` and `swept_theta` are the pose up to which the floor is swept.
    """
    works = not robot.brushes_up and robot.charge > 0.0
    if robot.sweeps and (not works or is_reversing(robot, start)):
        sweep(k, samples, dirt, tally, (robot.swept_x, robot.swept_y, robot.swept_theta), start)
        robot.sweeps = False
    if not works:
        return
    robot.brush_time += k.dt
    if not robot.sweeps:
        robot.sweeps = True
        robot.swept_x, robot.swept_y, robot.swept_theta = start
        robot.swept_distance = robot.distance
    if robot.distance - robot.swept_distance >= STRIDE or abs(wrap(robot.theta - robot.swept_theta)) >= TURN_STRIDE:
        end = robot.x, robot.y, robot.theta
        sweep(k, samples, dirt, tally, (robot.swept_x, robot.swept_y, robot.swept_theta), end)
        robot.swept_x, robot.swept_y, robot.swept_theta = end
        robot.swept_distance = robot.distance


def is_reversing(robot: Record, start: Triple) -> bool:
    """Whether a robot went back, in a tick that began with the pose `start`, over floor that is not swept yet."""
    return bool((start[0] - robot.swept_x) * (robot.x - start[0])
                + (start[1] - robot.swept_y) * (robot.y - start[1]) < 0.0)


def sweep_moves(constants: Array, samples: Array, dirt: Array, tallies: Array, starts: Array, ends: Array) -> None:
    """As `sweep`, for callers that are not compiled: for them, one call takes longer than the sweeping.

    Args:
        constants, tallies: one record each, in arrays.
        samples, dirt: as for `sweep`.
        starts, ends: poses (x [m], y [m], theta [rad]) between which the brush passes, float64 (any, 3) each.
    """
    for move in range(len(starts)):
        sweep(constants[0], samples, dirt, tallies[0], (starts[move, 0], starts[move, 1], starts[move, 2]),
              (ends[move, 0], ends[move, 1], ends[move, 2]))


def sweep(k: Record, samples: Array, dirt: Array, tally: Record, start: Triple, end: Triple) -> None:
    """Clean what the brush, a segment across the middle of the robot, passes over from one pose to another.

    The brush passes over a sample point if the point changes from one side of the line through the brush to the other
    while it is at most half the brush's width from the middle. Each pass takes the same share of the dirt.
    """
    turn = wrap(end[2] - start[2])
    pieces = 1 + int(abs(turn) / BEND)
    before = start
    for piece in range(1, pieces):
        share = piece / pieces
        after = (start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1]),
                 start[2] + share * turn)
        pass_over(k, samples, dirt, tally, before, after)
        before = after
    pass_over(k, samples, dirt, tally, before, end)


def pass_over(k: Record, samples: Array, dirt: Array, tally: Record, start: Triple, end: Triple) -> None:
    """Let the brush pass from one pose to another; the headings differ by BEND at most.

    Only samples near the brush in the middle of this movement are looked at: line by line (rows, or columns if the
    brush lies more along x), and in each line from the first to the last that the brush can pass. Lengths inside this
    function are in squares of samples.
    """
    x, y, cos, sin = to_squares(k, start)
    to_x, to_y, to_cos, to_sin = to_squares(k, end)
    half = 0.5 * k.brush_width / k.sample_pitch
    turn, distance = abs(wrap(end[2] - start[2])), math.hypot(to_x - x, to_y - y)
    middle_cos, middle_sin = cos + to_cos, sin + to_sin
    is_upright = abs(middle_cos) >= abs(middle_sin)  # the lines are rows
    slope = -middle_sin / middle_cos if is_upright else -middle_cos / middle_sin  # of the brush, from line to line
    steep = math.sqrt(1.0 + slope * slope)
    middle_x, middle_y = 0.5 * (x + to_x), 0.5 * (y + to_y)
    middle_line, middle_across = (middle_y, middle_x) if is_upright else (middle_x, middle_y)
    count, length = (samples.shape[0], samples.shape[1]) if is_upright else (samples.shape[1], samples.shape[0])
    lines = half / steep + 0.5 * (distance + turn * half)
    swept, taken, cells = 0, 0.0, dirt.shape[0] / samples.shape[0]
    for line in range(max(int(middle_line - lines), 0), min(int(middle_line + lines) + 1, count)):
        off = line + 0.5 - middle_line
        centre = middle_across + slope * off
        margin = 0.505 * (distance + turn * (abs(off) + 0.5) * steep) * steep + 0.5 * abs(slope)
        for across in range(max(int(centre - margin), 0), min(int(centre + margin) + 1, length)):
            row, column = (line, across) if is_upright else (across, line)
            u, v = sample_point(row, column)
            ahead = (u - x) * cos + (v - y) * sin
            ahead_after = (u - to_x) * to_cos + (v - to_y) * to_sin
            beside = (v - y) * cos - (u - x) * sin
            beside_after = (v - to_y) * to_cos - (u - to_x) * to_sin
            crosses = (ahead > 0.0) != (ahead_after > 0.0)
            is_within = abs(ahead * beside_after - ahead_after * beside) <= half * abs(ahead - ahead_after)
            fresh, share = clean(k, samples, row, column, int(crosses) & int(is_within))
            swept, taken = swept + fresh, taken + share * float(dirt[int(v * cells), int(u * cells)])
    tally.swept += swept
    tally.dirt -= taken


def to_squares(k: Record, pose: Triple) -> Tuple[float, float, float, float]:
    """The position of a pose in squares of samples from the corner of the floor, and cosine and sine of its heading."""
    return ((pose[0] - k.origin_x) / k.sample_pitch, (pose[1] - k.origin_y) / k.sample_pitch,
            math.cos(pose[2]), math.sin(pose[2]))


def sample_point(row: int, column: int) -> Tuple[float, float]:
    """The sample point of a square (row, column) of the floor, along x and along y [squares].

    It lies anywhere in its square, as a hash of row and column says (stratified sampling). So a strip of floor contains
    points in proportion to its area whatever its heading; points in the middles of the squares would form lines.
    """
    bits = scrambled(row, column)
    return column + (bits & 0xFFFF) / 65536.0, row + (bits >> 16) / 65536.0


def scrambled(one: int, other: int) -> int:
    """A hash of two whole numbers from 0 to 2^31: 32 bits."""
    bits = (one * 0x9E3779B1 + other * 0x85EBCA77) & 0xFFFFFFFF
    bits = ((bits ^ (bits >> 15)) * 0x2C1B3C6D) & 0xFFFFFFFF
    return bits ^ (bits >> 13)


def clean(k: Record, samples: Array, row: int, column: int, passes: int) -> Tuple[int, float]:
    """Count 1 or 0 more passes over the sample of a square (row, column).

    There are no branches in it: the processor could not foresee where the border of what the brush passes lies.

    Returns:
        How many more samples are swept, and the share of the first dirt that is taken.
    """
    sample = int(samples[row, column])
    before = sample // PASS
    passes &= sample // SWEEPABLE & int(before < MOST_PASSES)
    samples[row, column] = sample + PASS * passes
    passes &= sample // REACHABLE
    return passes & int(before == 0), passes * k.takes[before]


# --- reach --------------------------------------------------------------------------------------------------------

def mark_reachable(field: Array, resolution: float, stands: Array, reach: float, half: float, samples: Array) -> int:
    """Set the bit REACHABLE of all samples that the brush can reach; returns how many these are.

    Args, apart from those above:
        resolution: side of a cell [m].
        stands: bool (2 * rows + 1, 2 * columns + 1), where a robot can stand and drive to: at the corners of the cells,
            in the middle of their sides, and at their centres.
        reach: clearance that a robot needs [m].
        half: half the width of the brush [m].
    """
    squares, count = samples.shape[0] // (field.shape[0] - 1), 0
    for row in range(samples.shape[0]):
        for column in range(samples.shape[1]):
            if samples[row, column] & SWEEPABLE:
                across, up = sample_point(row, column)
                if is_reachable(field, resolution, stands, reach, half, across / squares, up / squares):
                    samples[row, column] |= REACHABLE
                    count += 1
    return count


def is_reachable(field: Array, resolution: float, stands: Array, reach: float, half: float, u: float,
                 v: float) -> bool:
    """Whether the point (u, v) [cells] lies within `half` of a position at which a robot can stand.

    The nearest such position is usually up the slope of the clearance. If that leads nowhere, all positions nearby are
    tried: around each of them a robot can stand as far as its clearance is larger than it needs.
    """
    gap, along_u, along_v = interpolated(field, u, v)
    if reach - gap > half:
        return False
    slope = math.hypot(along_u, along_v)
    away = max(reach - gap, 0.0) / resolution / slope if slope > 0.0 else 0.0
    to_u, to_v = u + away * along_u, v + away * along_v
    if interpolated(field, to_u, to_v)[0] >= reach - PUSH and stands_beside(stands, to_u, to_v):
        return True
    size = int(math.ceil(2.0 * half / resolution)) + 2
    row, column = int(round(2.0 * v)), int(round(2.0 * u))
    for i in range(max(row - size, 0), min(row + size + 1, stands.shape[0])):
        for j in range(max(column - size, 0), min(column + size + 1, stands.shape[1])):
            if stands[i, j]:
                spare = interpolated(field, 0.5 * j, 0.5 * i)[0] - reach
                if math.hypot(0.5 * j - u, 0.5 * i - v) * resolution - spare <= half:
                    return True
    return False


def stands_beside(stands: Array, u: float, v: float) -> bool:
    """Whether a robot can stand at one of the four positions of `stands` around the point (u, v) [cells]."""
    i, j = int(2.0 * v), int(2.0 * u)
    if not (0 <= i < stands.shape[0] - 1 and 0 <= j < stands.shape[1] - 1):
        return False
    return bool(stands[i, j] or stands[i, j + 1] or stands[i + 1, j] or stands[i + 1, j + 1])


# --- energy -------------------------------------------------------------------------------------------------------

def load(robot: Record, k: Record) -> float:
    """Sum of the loads [A]: electronics, wheels at their speed, brushes."""
    wheels = 0.5 * (abs(robot.left_speed) + abs(robot.right_speed))
    current = k.idle_current
    if wheels > 0.0:
        current += k.wheel_current_slow + (k.wheel_current - k.wheel_current_slow) * wheels / k.wheel_speed
    if not robot.brushes_up:
        current += k.brush_current
    return current


def battery_current(charge: float, k: Record, load: float, on_dock: bool) -> float:
    """Current into the battery [A], negative while it discharges; the charger tapers as the battery fills."""
    if not on_dock:
        return -load if charge > 0.0 else 0.0
    if charge >= k.capacity:
        return 0.0
    taper = (1.0 - charge / k.capacity) / (1.0 - k.taper_start)
    return max(k.trickle_current, k.charge_current * min(1.0, taper))


def charge_after(charge: float, k: Record, current: float, dt: float) -> float:
    """Charge [Ah] after a current [A] flowed for dt [s]."""
    return min(max(charge + current * k.drain * dt / 3600.0, 0.0), k.capacity)


# --- dock ---------------------------------------------------------------------------------------------------------

def at_contacts(robot: Record, k: Record, docks: Array) -> bool:
    """Whether charging contacts are closed: they open at a larger distance than they close."""
    farthest = k.release_distance if robot.docked else k.contact_distance
    widest = k.release_angle if robot.docked else k.contact_angle
    for dock in range(len(docks)):
        if math.hypot(robot.x - docks[dock, X], robot.y - docks[dock, Y]) <= farthest and (
                abs(wrap(robot.theta - docks[dock, THETA])) <= widest):
            return True
    return False


def infrared(robots: Array, me: int, constants: Array, docks: Array, skips: Array) -> Tuple[int, int, int]:
    """Sums of the beams of all docks that the three receivers get: omnidirectional, front left, front right."""
    omni, left, right = NO_BEAM, NO_BEAM, NO_BEAM
    for dock in range(len(docks)):
        beams = beams_of(docks[dock], robots[me], constants[0], skips)
        omni, left, right = omni | beams[0], left | beams[1], right | beams[2]
    return omni, left, right


def beams_of(dock: Array, robot: Record, k: Record, skips: Array) -> Tuple[int, int, int]:
    """The same of one dock, a row of `docks`.

    It sends from the wall in front of a docked robot, opposite to the heading of that robot.
    """
    from_x = dock[X] + k.radius * math.cos(dock[THETA])
    from_y = dock[Y] + k.radius * math.sin(dock[THETA])
    dx, dy = robot.x - from_x, robot.y - from_y
    distance = math.hypot(dx, dy)
    if distance < 1e-6 or cast(k, skips, from_x, from_y, dx / distance, dy / distance, distance) < distance:
        return NO_BEAM, NO_BEAM, NO_BEAM
    beams = FORCE_FIELD if distance <= k.halo else NO_BEAM
    # Positive if a robot that faces the dock is to the right of its axis.
    off_axis = wrap(math.atan2(dy, dx) - dock[THETA] - math.pi)
    if distance <= k.buoy_range:
        if -k.buoy_overlap_half <= off_axis <= k.buoy_half:
            beams |= GREEN_BUOY
        if -k.buoy_half <= off_axis <= k.buoy_overlap_half:
            beams |= RED_BUOY
    bearing = wrap(math.atan2(-dy, -dx) - robot.theta)
    left = beams if -INNER <= bearing <= OUTER else NO_BEAM
    right = beams if -OUTER <= bearing <= INNER else NO_BEAM
    return beams, left, right


# --- cliff sensors --------------------------------------------------------------------------------------------------

def cliffs(robots: Array, me: int, constants: Array, cells: Array, distance: float, angles: Array,
           seen: Array) -> None:
    """Whether there is no floor under each cliff sensor of the robot with index `me`.

    Args, apart from those above:
        distance: of the sensors from the centre of the robot [m].
        angles: float64 (sensors), from straight ahead [rad].
        seen: bool (sensors), receives the answer.
    """
    robot, k = robots[me], constants[0]
    for sensor in range(len(angles)):
        along = robot.theta + angles[sensor]
        seen[sensor] = k.has_layers and cell_bits(
            k, cells, robot.x + distance * math.cos(along), robot.y + distance * math.sin(along)) & CLIFF != 0


# --- laser --------------------------------------------------------------------------------------------------------

def cast(k: Record, skips: Array, x: float, y: float, along_x: float, along_y: float, limit: float) -> float:
    """Distance from (x, y) along a unit vector to the first wall, at most `limit`."""
    u, v, far = (x - k.origin_x) / k.resolution, (y - k.origin_y) / k.resolution, limit / k.resolution
    distance = 0.0
    while distance < far:
        after = beam_step(skips, u, v, along_x, along_y, distance)
        if after == distance:
            return distance * k.resolution
        distance = after
    return limit


def cast_all(k: Record, skips: Array, x: float, y: float, along: Array, ranges: Array) -> None:
    """The same along many unit vectors, at most `range_max`: `ranges`, float64 (beams), receives the distances.

    The beams take their steps in turn. What one reads of the map does not depend on the others, so that the processor
    waits for many cells at once: this takes half as long as beam after beam.
    """
    u, v, far = (x - k.origin_x) / k.resolution, (y - k.origin_y) / k.resolution, k.range_max / k.resolution
    ranges[:] = 0.0
    under_way = np.arange(len(ranges))
    left = len(ranges)
    while left > 0:
        going, left = left, 0
        for place in range(going):
            beam = under_way[place]
            distance = beam_step(skips, u, v, along[beam, 0], along[beam, 1], ranges[beam])
            if ranges[beam] < distance < far:
                under_way[left] = beam
                left += 1
            ranges[beam] = distance
    for beam in range(len(ranges)):
        ranges[beam] = min(ranges[beam] * k.resolution, k.range_max)


def beam_step(skips: Array, u: float, v: float, along_x: float, along_y: float, distance: float) -> float:
    """How far a beam has come after another step, in cells; as far as before if it meets a wall or leaves the map.

    Far from walls it skips whole cells; near walls it goes from border to border of the cells, so that it meets the
    wall exactly.
    """
    column, row = u + distance * along_x, v + distance * along_y
    if not (0.0 <= column < skips.shape[1] and 0.0 <= row < skips.shape[0]):
        return distance
    skip = int(skips[int(row), int(column)])
    if skip == IN_WALL:
        return distance
    if skip > 0:
        return distance + skip
    return distance + min(to_border(column, along_x), to_border(row, along_y)) + NUDGE


def to_border(position: float, along: float) -> float:
    """Distance [cells] until one coordinate [cells], which grows by `along` per cell, reaches the border of its cell.

    It is infinite for a beam that is parallel to the border except for rounding: NUDGE would not carry it across.
    """
    if along > NUDGE:
        return (math.floor(position) + 1.0 - position) / along
    if along < -NUDGE:
        return (math.floor(position) - position) / along
    return math.inf


def scan(robots: Array, me: int, constants: Array, obstacles: Array, skips: Array, fan: Array, noise: Array,
         ranges: Array) -> None:
    """Measure with the laser of the robot with index `me`.

    Args, apart from those above:
        fan: float64 (beams, 2), directions of the beams as unit vectors in the frame of the robot.
        noise: float64 (beams), standard normal.
        ranges: float64 (beams), receives the measured distances.
    """
    robot, k = robots[me], constants[0]
    cos, sin = math.cos(robot.theta), math.sin(robot.theta)
    along = np.empty(fan.shape)
    for beam in range(len(ranges)):
        along[beam, 0] = cos * fan[beam, 0] - sin * fan[beam, 1]
        along[beam, 1] = sin * fan[beam, 0] + cos * fan[beam, 1]
    cast_all(k, skips, robot.x, robot.y, along, ranges)
    for other in range(len(robots)):
        if other != me:
            see_disc(robots[other].x - robot.x, robots[other].y - robot.y, k.radius, robot.theta, k, along, ranges)
    for index in range(len(obstacles)):
        obstacle = obstacles[index]
        if obstacle.is_seen and obstacle.radius > 0.0:
            see_disc(obstacle.x - robot.x, obstacle.y - robot.y, obstacle.radius, robot.theta, k, along, ranges)
        elif obstacle.is_seen:
            see_box(obstacle, robot, k, ranges)
    for beam in range(len(ranges)):
        if ranges[beam] < k.range_max:
            ranges[beam] += k.range_noise * noise[beam]
        if ranges[beam] >= k.range_max:
            ranges[beam] = math.inf
        elif ranges[beam] < k.range_min:
            ranges[beam] = -math.inf


def see_disc(dx: float, dy: float, radius: float, theta: float, k: Record, along: Array, ranges: Array) -> None:
    """Shorten the beams that hit a disc, such as another robot, which is (dx, dy) away from the laser.

    The beams have the directions `along`, float64 (beams, 2), unit vectors.
    """
    square = dx * dx + dy * dy
    if square >= (k.range_max + radius) ** 2 or square <= radius ** 2:
        return
    distance = math.sqrt(square)
    step = 2.0 * math.pi / len(ranges)
    half = math.asin(radius / distance)
    middle = wrap(math.atan2(dy, dx) - theta) + math.pi  # beam 0 points backward
    for beam in range(math.ceil((middle - half) / step), math.floor((middle + half) / step) + 1):
        index = beam % len(ranges)
        side = dx * along[index, 1] - dy * along[index, 0]
        ahead = dx * along[index, 0] + dy * along[index, 1]
        ranges[index] = min(ranges[index], ahead - math.sqrt(max(0.0, radius * radius - side * side)))


def see_box(box: Record, robot: Record, k: Record, ranges: Array) -> None:
    """Shorten the beams of a robot that hit a box: those between its outermost corners."""
    dx, dy = box.x - robot.x, box.y - robot.y
    if not is_near(box, robot.x, robot.y, k.range_max) or outside(box, robot.x, robot.y)[0] <= 0.0:
        return
    bearing, right, left = math.atan2(dy, dx), 0.0, 0.0
    for corner in range(4):
        u = box.half_length if corner & 1 else -box.half_length
        v = box.half_width if corner & 2 else -box.half_width
        off = wrap(math.atan2(dy + box.sin * u + box.cos * v, dx + box.cos * u - box.sin * v) - bearing)
        right, left = min(right, off), max(left, off)
    step = 2.0 * math.pi / len(ranges)
    middle = wrap(bearing - robot.theta) + math.pi  # beam 0 points backward
    u, v = -box.cos * dx - box.sin * dy, box.sin * dx - box.cos * dy
    for beam in range(math.ceil((middle + right) / step), math.floor((middle + left) / step) + 1):
        angle = robot.theta + beam * step - math.pi - box.theta
        enter_u, leave_u = crossing(u, math.cos(angle), box.half_length)
        enter_v, leave_v = crossing(v, math.sin(angle), box.half_width)
        edge = max(enter_u, enter_v)
        if 0.0 <= edge <= min(leave_u, leave_v):
            index = beam % len(ranges)
            ranges[index] = min(ranges[index], edge)


def crossing(position: float, along: float, half: float) -> Tuple[float, float]:
    """Distances along a beam at which one of its coordinates enters and leaves the interval from -half to half.

    `position` is the coordinate at the laser, and grows by `along` per metre. A beam along the border does not enter.
    """
    if abs(along) < NUDGE:
        return (-math.inf, math.inf) if abs(position) < half else (math.inf, -math.inf)
    one, other = (-half - position) / along, (half - position) / along
    return min(one, other), max(one, other)
