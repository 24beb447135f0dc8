"""Blows that do one everyday thing over and over: what each time leaves behind adds up."""

import contextlib
import math
from typing import Callable, NamedTuple

from geometry_msgs.msg import Pose2D
from nav_msgs.msg import Odometry
from roscpp.srv import GetLoggers

from rumba_msg.srv import Kill, Spawn
from stress import goals, growth, page, wire, world
from stress.blows import robots
from stress.blows.blow import some_member
from stress.failure import Failure
from stress.scenarios import PAGE_PORT

BATCHES = 4  # the first one does not count: something is loaded once
AT_ONCE = 20  # goals, before their results are waited for
NEAR = 0.2  # [m] from the robot to the target of a goal
ENDS_WITHIN = 30.0  # [s] for the goals of a batch


class Deed(NamedTuple):
    """Something that is done over and over."""

    what: str  # for a person
    times: int  # in a batch
    prepare: Callable  # of the ground and a random generator: a context with a function that does a batch
    fits: Callable  # whether it can be done on a ground


def again(ground, chance, blow):
    """One thing many times, after which nothing may have grown each time."""
    deed = chance.choice([deed for deed in DEEDS if deed.fits(ground)])
    blow.say(f'{BATCHES} times {deed.times} {deed.what}', inputs=BATCHES * deed.times)
    if ground.cleaner is not None:
        goals.cancel_all(ground)  # a plan takes memory meanwhile, and gives it back
    held = []
    with deed.prepare(ground, chance) as do:
        for _ in range(BATCHES):
            do(deed.times)
            held.append(growth.held(ground.everybody))
    growth.check(held, deed.times, deed.what)


@contextlib.contextmanager
def _refused_goals(ground, _chance):
    with goals.client(ground, 'go_to') as client:
        def do(times):
            for number in range(1, times + 1):
                client.send(target=Pose2D(math.nan, math.nan, math.nan))
                if number % AT_ONCE == 0:
                    client.await_results(ENDS_WITHIN)
        yield do


@contextlib.contextmanager
def _goals(ground, chance):
    with goals.client(ground, 'go_to') as client:
        def do(times):
            truth = ground.read('/rumba/ground_truth', Odometry).pose.pose.position
            for _ in range(times):
                client.send(target=Pose2D(truth.x + chance.uniform(-NEAR, NEAR), truth.y, math.nan))
            goals.cancel_all(ground)
            client.await_results(ENDS_WITHIN)
        yield do


@contextlib.contextmanager
def _subscribers(ground, chance):
    topic, kind, _, publishers = chance.choice([entry for entry in ground.topics() if entry[3]])
    member = ground.members[chance.choice(publishers)]

    def do(times):
        for _ in range(times):
            ground.listen(topic, kind, member).close()
    yield do


@contextlib.contextmanager
def _calls(ground, chance):
    name = f'{some_member(ground, chance).name}/get_loggers'

    def do(times):
        for _ in range(times):
            ground.call(name, GetLoggers)
    yield do


@contextlib.contextmanager
def _robots(ground, chance):
    def do(times):
        for _ in range(times):
            come = None
            while come is None or not come.success:  # most poses are in walls
                come = ground.call(f'{ground.world.name}/spawn', Spawn, '', robots.some_pose(chance))
            gone = ground.call(f'{ground.world.name}/kill', Kill, come.name)
            if not gone.success:
                raise Failure('kill', 'world', f'the robot {come.name} cannot be removed: {gone.message}')
    yield do


@contextlib.contextmanager
def _resets(ground, _chance):
    def do(times):
        for _ in range(times):
            world.trigger(ground, 'reset')
        ground.memory = None
    yield do


@contextlib.contextmanager
def _visits(_ground, _chance):
    def do(times):
        for _ in range(times):
            page.get(PAGE_PORT, '/', wire.PATIENCE)
            with page.Client(PAGE_PORT, wire.PATIENCE) as client:
                client.subscribe('/rumba/battery_state', 'sensor_msgs/BatteryState')
                client.next()
    yield do


def _has_page(ground):
    return any(member.role.pulse == 'page' for member in ground.members.values())


DEEDS = (
    Deed('goals that are refused', 60, _refused_goals, lambda ground: ground.cleaner is not None),
    Deed('goals', 20, _goals, lambda ground: ground.cleaner is not None),
    Deed('subscribers that come and go', 60, _subscribers, lambda _: True),
    Deed('calls of a service', 60, _calls, lambda _: True),
    Deed('robots that come and go', 4, _robots, world.has_services),
    Deed('resets', 8, _resets, world.has_services),
    Deed('visits of the page', 40, _visits, _has_page),
)
