"""Blows on the world through its services: spawn, kill, pause, step, reset, teleport, tuning."""

from common.ros_session import wait_until
from geometry_msgs.msg import Pose2D

from rumba_msg.msg import SimulatorState
from rumba_msg.srv import Kill, Spawn, Step, Teleport
from stress import wire, world
from stress.failure import Failure

ROBOTS = 8
FORGOTTEN_WITHIN = 15.0  # [s] by all nodes
POSES = 60
STEPS = (1, 7, 100, 2000)
SPEEDS = (0.0, 1e-300, 5e-324, 0.0005, 0.1, 1.0, 100.0, 1e6, -1.0, float('nan'), float('inf'))
BOX = 12.0  # [m] around which poses are


def spawn_and_kill(ground, chance, blow):
    """Robots come and go; of those that came nothing remains."""
    blow.say(f'{ROBOTS} robots come and go', faults=1)
    simulator = ground.world.name
    come = []
    for _ in range(ROBOTS):
        answer = ground.call(f'{simulator}/spawn', Spawn, '', some_pose(chance))
        if answer.success:
            come.append(answer.name)
    for name in come:
        answer = ground.call(f'{simulator}/kill', Kill, name)
        if not answer.success:
            raise Failure('kill', 'world', f'the robot {name} cannot be removed: {answer.message}')
    try:
        wait_until(lambda: not _topics_of(ground, come), FORGOTTEN_WITHIN)
    except TimeoutError:
        left = sorted(_topics_of(ground, come))
        raise Failure('kill', 'world', f'topics of robots that are gone: {left}') from None


def _topics_of(ground, robots):
    """Topics of robots of which a node still knows."""
    return {name for name, _, subscribers, publishers in ground.topics()
            if name.split('/')[1] in robots and (subscribers or publishers)}


def some_pose(chance):
    """A pose in or around the walls."""
    return Pose2D(chance.uniform(0.0, BOX), chance.uniform(0.0, BOX), chance.uniform(-7.0, 7.0))


def pause_and_step(ground, chance, blow):
    """Pause, steps that are counted, resume."""
    blow.say('pause, steps, resume', faults=1)
    world.trigger(ground, 'pause')
    before = ground.read(world.STATE, SimulatorState)
    if not before.is_paused:
        raise Failure('time', 'world', 'runs after a call of pause')
    ticks = chance.choice(STEPS)
    answer = ground.call(f'{ground.world.name}/step', Step, ticks)
    after = ground.read(world.STATE, SimulatorState)
    if not answer.success or after.tick != before.tick + ticks:
        raise Failure('time', 'world', f'{ticks} ticks led from {before.tick} to {after.tick}: {answer.message}')
    world.trigger(ground, 'resume')


def reset(ground, chance, blow):
    """Everything as at the start."""
    blow.say('reset', faults=1)
    answer = world.trigger(ground, 'reset')
    if not answer.success:
        raise Failure('reset', 'world', answer.message)
    ground.memory = None


def teleport(ground, chance, blow):
    """Poses near and far, many of them in walls."""
    blow.say(f'{POSES} times teleported', inputs=POSES)
    for robot in ground.scenario.robots:
        name = f'/{robot}/teleport'
        with wire.Service(ground.ask_master('lookupService', name), name, Teleport) as service:
            for _ in range(POSES):
                service.call(Teleport._request_class(some_pose(chance)))


def tune_speed(ground, chance, blow):
    """Speeds of any size, and then the one of before."""
    speeds = [chance.choice(SPEEDS) for _ in range(4)]
    blow.say(f'speed {", ".join(map(str, speeds))}', faults=1, inputs=len(speeds))
    for speed in speeds:
        world.tune(ground, speed=speed)
