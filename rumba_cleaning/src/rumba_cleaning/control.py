"""Has the robots of a world follow behaviours, in process, at the control rate."""

from typing import Iterator, Tuple

import numpy as np

from rumba_cleaning.behaviour import Behaviour, Command, Observation, Status
from rumba_cleaning.pose_source import PoseSource, truth
from rumba_sim.model.simulation.robot import FIRST
from rumba_sim.model.simulation.world import World

STEP_RATE = 50  # [Hz]
CONTROL_TICKS = 5  # from one observation to the next
CONTROL_DT = CONTROL_TICKS / STEP_RATE  # [s]


def observe(world: World, name: str, dt: float, source: PoseSource = truth) -> Observation:
    """What a robot of a world knows now, `dt` [s] after the observation before.

    Pose and charge are those that messages tell, bit for bit: the charge is a float32.
    """
    robot = world.robots[name]
    pose, covariance, scan, silence = source(world, name)
    return Observation(dt, pose, robot.bumper, world.cliffs(name), float(np.float32(robot.battery.state_of_charge)),
                       robot.is_docked, world.infrared(name), robot.has_fallen, covariance, scan, silence)


def act(behaviour: Behaviour, world: World, name: str, dt: float,
        source: PoseSource = truth) -> Tuple[Observation, Command]:
    """Have a robot take one step of a behaviour, `dt` [s] after the step before; returns what it saw, and does."""
    robot = world.robots[name]
    observation = observe(world, name, dt, source)
    command = behaviour.step(observation)
    robot.brushes_up = command.brushes_up
    robot.command(command.v, command.w, world.tick)
    return observation, command


def steps(behaviour: Behaviour, world: World, name: str = FIRST, seconds: float = 600.0,
          source: PoseSource = truth) -> Iterator[Tuple[Observation, Command]]:
    """Have a robot follow a behaviour until that ends or the time [s] is up; yields what it sees, and what it does."""
    end = world.time + seconds
    dt = 0.0
    while behaviour.status is Status.RUNNING and world.time < end:
        yield act(behaviour, world, name, dt, source)
        world.step(CONTROL_TICKS)
        dt = CONTROL_DT
