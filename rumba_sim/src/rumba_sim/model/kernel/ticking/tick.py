"""What happens in one tick, in this order: drive, collide, count, sweep, dock, drain."""

from rumba_sim.model.kernel import Array, Record, Triple
from rumba_sim.model.kernel.ground import look_down, stand
from rumba_sim.model.kernel.motion import lead, move
from rumba_sim.model.kernel.sensors.bumper import touch
from rumba_sim.model.kernel.sensors.dock import at_contacts
from rumba_sim.model.kernel.sweeping.brush import brush
from rumba_sim.model.kernel.ticking.energy import battery_current, charge_after, load
from rumba_sim.model.kernel.ticking.wheels import count, drive


def advance(robots: Array, constants: Array, obstacles: Array, docks: Array, field: Array, cells: Array,
            samples: Array, dirt: Array, tallies: Array, noise: Array, tick: int, ticks: int) -> None:
    """Simulate `ticks` ticks; the first of them has the number `tick`.

    Args, apart from those of the package:
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
            toward_x, toward_y = move(robots, me, k, obstacles, field, cells, now)
            traction = stand(robot, k, cells) if k.has_layers else k.floor_traction
            if k.has_cliffs:
                look_down(robot, k, cells)
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
        if k.has_cliffs:
            look_down(robot, k, cells)
        count(robot, k, traction, noise[me, tick % noise.shape[1]])
        touch(robots, me, k, obstacles, field, tick, 0.0, 0.0)
        work(robot, k, docks, samples, dirt, tally, start)


def work(robot: Record, k: Record, docks: Array, samples: Array, dirt: Array, tally: Record, start: Triple) -> None:
    """Sweep, dock and use energy in a tick that began with the pose `start`."""
    brush(robot, k, samples, dirt, tally, start)
    robot.docked = at_contacts(robot, k, docks)
    robot.current = battery_current(robot.charge, k, load(robot, k), robot.docked)
    robot.charge = charge_after(robot.charge, k, robot.current, k.dt)
