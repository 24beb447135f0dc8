"""The world of a ground: what is true in it, read from its topics, and its services."""

import contextlib
import math
import time
from typing import Dict, NamedTuple

from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState
from std_srvs.srv import Empty, Trigger

from rumba_msg.msg import CleaningStatus, SimulatorState
from rumba_msg.srv import Kill
from stress import wire
from stress.failure import Failure
from stress.scenarios import SPEED

STATE = '/simulator/state'
TURTLE_POSE = '/turtle1/pose'  # of the body of the robot
LARGEST = 1e3  # [m] coordinates in a map, at most
CURRENT = 6.0  # [A] more than all loads together, and more than the charger gives
ROUNDING = 1e-3  # [Ah]
MOVES_WITHIN = 15.0  # [s] of the wall clock until the next tick


class RobotReading(NamedTuple):
    """One robot."""

    pose: tuple  # [m, m, -, -] position and two parts of the quaternion
    charge: float  # [Ah]
    capacity: float  # [Ah]
    coverage: float
    distance: float  # [m]
    time: float  # [s] with the brushes down


class Reading(NamedTuple):
    """What is true at one moment."""

    tick: int
    seconds: float  # of simulated time
    robots: Dict[str, RobotReading]


def read(ground):
    """What is true now.

    Raises:
        wire.WireError: the world does not tell.
    """
    state = ground.read(STATE, SimulatorState)
    return Reading(state.tick, state.tick / state.step_rate,
                   {name: _robot(ground, name) for name in names(ground)})


def names(ground):
    """Names of the robots, as the topics tell."""
    ending = '/battery_state'
    return [topic[1:-len(ending)] for topic, _, _, publishers in ground.topics()
            if topic.endswith(ending) and ground.world.name in publishers]


def _robot(ground, name, patience=wire.PATIENCE):
    truth = ground.read(f'/{name}/ground_truth', Odometry, timeout=patience).pose.pose
    battery = ground.read(f'/{name}/battery_state', BatteryState, timeout=patience)
    cleaning = ground.read(f'/{name}/cleaning_status', CleaningStatus, timeout=patience)
    return RobotReading((truth.position.x, truth.position.y, truth.orientation.z, truth.orientation.w),
                        battery.charge, battery.capacity, cleaning.coverage, cleaning.distance, cleaning.time)


# --- is it sane? ------------------------------------------------------------------------------------------------------

def check(ground):
    """Ask whether the world is sane, goes on, and has kept what it had at the last look.

    Raises:
        Failure: it is not.
        wire.WireError: it does not tell.
    """
    _moves(ground)
    now = read(ground)
    for name, robot in now.robots.items():
        _check_robot(name, robot)
    if ground.memory is not None:
        _compare(ground.memory, now)
    ground.memory = now


def check_robots(ground, patience):
    """Ask whether the robots of a world are sane that may tell nothing, because it was asked to.

    Raises:
        Failure: one is not.
    """
    with contextlib.suppress(wire.WireError):
        for name in names(ground):
            _check_robot(name, _robot(ground, name, patience))


def _moves(ground):
    with ground.listen(STATE, SimulatorState) as states:
        first = states.next()
        if first.is_paused:
            raise Failure('time', 'world', 'is paused, and nobody asked for that')
        end = time.monotonic() + MOVES_WITHIN
        while states.next().tick <= first.tick:
            if time.monotonic() > end:
                raise Failure('time', 'world', f'stands still at tick {first.tick}, speed {first.speed:g}')


def _check_robot(name, robot):
    for what, is_right in (
            ('pose', all(map(math.isfinite, robot.pose)) and max(map(abs, robot.pose)) < LARGEST),
            ('charge', 0.0 <= robot.charge <= robot.capacity < math.inf),
            ('coverage', 0.0 <= robot.coverage <= 1.0),
            ('distance', 0.0 <= robot.distance < math.inf),
            ('time', 0.0 <= robot.time < math.inf)):
        if not is_right:
            raise Failure('sane', 'world', f'{what} of {name} is {getattr(robot, what)}, capacity {robot.capacity}')


def _compare(before, now):
    if now.tick < before.tick:
        raise Failure('lost', 'world', f'the tick went from {before.tick} back to {now.tick}')
    for name, old in before.robots.items():
        new = now.robots.get(name)
        if new is None:
            raise Failure('lost', 'world', f'the robot {name} is gone')
        for what in ('coverage', 'distance', 'time'):
            if getattr(new, what) < getattr(old, what):
                raise Failure('lost', 'world',
                              f'{what} of {name} fell from {getattr(old, what)} to {getattr(new, what)}')
        # A second more, since the messages are not of the same moment.
        bound = CURRENT * (now.seconds - before.seconds + 2.0) / 3600.0 + ROUNDING
        if abs(new.charge - old.charge) > bound:
            raise Failure('lost', 'world', f'charge of {name} jumped from {old.charge} to {new.charge} Ah in '
                          f'{now.seconds - before.seconds:.1f} s')


# --- what is done to it -----------------------------------------------------------------------------------------------

def has_services(ground):
    """Whether the world is the simulator, which can be paused and tuned."""
    return ground.world.role.program == 'simulator'


def trigger(ground, service):
    """Call a service without a request, such as `reset`, below the name of the world's node."""
    return ground.call(f'{ground.world.name}/{service}', Trigger)


def tune(ground, **values):
    """Change numbers that can change at run time; returns those in force."""
    config = Config(doubles=[DoubleParameter(name, float(value)) for name, value in values.items()])
    answer = ground.call(f'{ground.world.name}/tuning/set_parameters', Reconfigure, config)
    return {parameter.name: parameter.value for parameter in answer.config.doubles}


def tidy(ground):
    """Let the world go on as at first if a blow made it stand still, or put robots or turtles into it."""
    if not has_services(ground):
        _remove_turtles(ground)
        return
    state = ground.read(STATE, SimulatorState)
    if state.speed != SPEED:
        tune(ground, speed=SPEED)
    if state.is_paused:
        trigger(ground, 'resume')
    for name in set(names(ground)) - set(ground.scenario.robots):
        answer = ground.call(f'{ground.world.name}/kill', Kill, name)
        if not answer.success:
            raise Failure('kill', 'world', f'the robot {name} cannot be removed: {answer.message}')


def _remove_turtles(ground):
    """Reset turtlesim if there are turtles that are no robots: it moves, and publishes, each of them."""
    poses = {topic for topic, kind, _, publishers in ground.topics() if kind._type == 'turtlesim/Pose' and publishers}
    if poses - {TURTLE_POSE}:
        ground.call('/reset', Empty)
