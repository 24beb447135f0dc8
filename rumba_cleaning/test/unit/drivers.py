"""Has robots of a world do what behaviours or people say."""

import math
from concurrent.futures import Executor, Future

import numpy as np
from rooms import inside

from rumba_cleaning.behaviour import Behaviour, Command
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.control import CONTROL_DT, CONTROL_TICKS, observe, steps
from rumba_cleaning.pose_source import truth
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import OCCUPIED, FloorPlan
from rumba_sim.model.simulation.obstacle import Obstacle


def context_of(plan, world, seed=1, executor=None, **changes):
    """What a robot of a world, whose floor may differ from the plan, knows."""
    return Context(plan, world.config, CleaningConfig(**changes), seed, executor)


class Always(Behaviour):
    """Gives one command."""

    def __init__(self, v, w):
        self.command = Command(v, w)

    def update(self, observation):
        return self.command


def run(behaviour, world, name='rumba', seconds=600.0, source=truth):
    """Step a behaviour until it ends or the time is up; returns the seconds that this took."""
    start = world.time
    for _ in steps(behaviour, world, name, seconds, source):
        pass
    return world.time - start


def drive_by_hand(behaviour, world, v, w, seconds, name='rumba'):
    """Have a person drive a robot at v [m/s] and w [rad/s] for a time [s] while its behaviour stands by."""
    for _ in range(round(seconds / CONTROL_DT)):
        behaviour.stand_by(observe(world, name, CONTROL_DT))
        world.robots[name].command(v, w, world.tick)
        world.step(CONTROL_TICKS)


def guarded(guard, world, decide, seconds=math.inf, source=truth):
    """Have a guard watch what is decided for the robot rumba; what it commands, after each has been carried out."""
    robot, end = world.robots['rumba'], world.time + seconds
    while world.time < end - 0.5 * CONTROL_DT:
        command = guard.step(decide, observe(world, 'rumba', CONTROL_DT, source))
        robot.command(command.v, command.w, world.tick)
        world.step(CONTROL_TICKS)
        yield command


def with_cliffs(plan, *boxes):
    """The plan with cliffs in boxes (left, bottom, right, top) [m]."""
    cliff = np.any([inside(box, plan.rows, plan.columns, plan.resolution) for box in boxes], axis=0)
    return FloorPlan(plan.name, plan.occupancy, plan.resolution, plan.origin, cliff=cliff, dock=plan.dock)


def with_box(plan, box):
    """The plan with something in the box (left, bottom, right, top) [m] that it does not show."""
    left, bottom, right, top = box
    (row, column), (last_row, last_column) = plan.cell(left, bottom), plan.cell(right, top)
    occupancy = plan.occupancy.copy()
    occupancy[row:last_row, column:last_column] = OCCUPIED
    return FloorPlan(plan.name, occupancy, plan.resolution, plan.origin, cliff=plan.cliff, carpet=plan.carpet,
                     dock=plan.dock, start=plan.start)


def slanted_gap(gap, angle):
    """Obstacles that leave only a gap [m], slanted by an angle [rad], between the halves of a floor of 4 x 2.4 m."""
    away = 0.5 * gap + 1.0
    return [Obstacle(name, Pose(2.0 - side * math.sin(angle), 1.2 + side * math.cos(angle), angle), 0.5, length=0.2,
                     width=2.0) for name, side in (('one', away), ('other', -away))]


class Later(Executor):
    """Keeps what is submitted until it is told to work.

    Attributes:
        tasks: futures with their functions, in the order in which they were submitted.
    """

    def __init__(self):
        self.tasks = []

    def submit(self, fn, /, *args, **kwargs):
        """Keep a function; returns its future."""
        future = Future()
        self.tasks.append((future, lambda: fn(*args, **kwargs)))
        return future

    def begin(self):
        """Begin with all that is kept: it cannot be cancelled any more. Returns what ends it."""
        begun = [(future, call) for future, call in self.tasks if future.set_running_or_notify_cancel()]
        self.tasks = []

        def end():
            for future, call in begun:
                future.set_result(call())
        return end

    def work(self):
        """Do all that is kept."""
        self.begin()()
