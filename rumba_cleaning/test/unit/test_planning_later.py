"""While a plan is being made elsewhere, a behaviour stands still and says so; it ignores plans that it no longer needs.

The executor of these tests works only when it is told to.
"""

import concurrent.futures
import time

import numpy as np
import pytest
from drivers import Later, context_of, run, with_box
from rooms import RADIUS, crooked, quiet, room

from rumba_cleaning.behaviour import STOP, Observation, Status
from rumba_cleaning.behaviours.dock import Dock
from rumba_cleaning.behaviours.go_to import GoTo
from rumba_cleaning.control import steps
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.mission.stages import State
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.strategies.boustrophedon import Boustrophedon
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.world import World

START, TARGET = Pose(0.4, 0.4, 1.0), Pose(3.5, 2.4, -2.0)
PLAN = crooked(dock=Pose(4.0 - RADIUS - 0.01, 1.2, 0.0))
SEEN = Observation(0.1, START)
STOP_BRUSHES_DOWN = STOP._replace(brushes_up=False)
MAKERS = {
    'boustrophedon': Boustrophedon,
    'go_to': lambda context: GoTo(context, TARGET),
    'dock': Dock,
}


def planning(make, plan=PLAN, truth=None):
    """A behaviour that has asked for its first plan, its world, and what makes its plans."""
    world = World(truth or plan, quiet())
    world.spawn('rumba', START)
    later = Later()
    context = context_of(plan, world, executor=later)
    context.swept.begin(START.x, START.y)
    behaviour = make(context)
    assert later.tasks == []
    assert behaviour.step(SEEN) == STOP
    return behaviour, world, later


def moves(command):
    """Whether a command moves the robot."""
    return command.v != 0.0 or command.w != 0.0


@pytest.mark.parametrize('name', MAKERS)
def test_it_stands_still_until_the_plan_is_made(name):
    behaviour, _, later = planning(MAKERS[name])
    for _ in range(10):
        assert behaviour.step(SEEN) == STOP
        assert (behaviour.status, behaviour.message) == (Status.RUNNING, 'planning')
    assert len(later.tasks) == 1
    later.work()
    assert moves(behaviour.step(SEEN))
    assert behaviour.message.endswith('to go')


@pytest.mark.parametrize('name', MAKERS)
@pytest.mark.parametrize('end', ['stop', 'restart'])
def test_what_was_asked_for_before_a_restart_is_ignored(name, end):
    behaviour, _, later = planning(MAKERS[name])
    end_of_old = later.begin()
    getattr(behaviour, end)()
    behaviour.step(SEEN)
    end_of_old()
    assert behaviour.step(SEEN) == STOP and behaviour.message == 'planning'
    later.work()
    assert moves(behaviour.step(SEEN))


@pytest.mark.parametrize('name', MAKERS)
def test_what_is_stopped_before_its_plan_was_begun_needs_no_plan(name):
    behaviour, _, later = planning(MAKERS[name])
    future, _ = later.tasks[0]
    behaviour.stop()
    assert future.cancelled()


@pytest.mark.parametrize('name', MAKERS)
def test_an_exception_while_planning_is_raised_by_the_step(name):
    behaviour, _, later = planning(MAKERS[name])
    later.tasks[0][0].set_exception(RuntimeError('no idea'))
    with pytest.raises(RuntimeError, match='no idea'):
        behaviour.step(SEEN)


def test_a_target_that_no_path_leads_to_fails_when_that_is_known():
    plan = room(4.0, 3.0, boxes=[(1.9, 0.0, 2.1, 3.0)])
    behaviour, _, later = planning(MAKERS['go_to'], plan)
    later.work()
    assert behaviour.step(SEEN) == STOP
    assert (behaviour.status, behaviour.outcome) == (Status.FAILED, Outcome.NO_PATH)


def test_between_two_rounds_it_waits_with_its_brushes_as_they_were():
    plan = room(1.2, 1.0)
    behaviour, world, later = planning(Boustrophedon, plan)
    later.work()
    waiting = []
    for _, command in steps(behaviour, world):
        if behaviour.message == 'planning':
            waiting.append(command)
            if len(waiting) % 5 == 0:
                later.work()
    assert waiting and set(waiting) == {STOP_BRUSHES_DOWN}
    assert behaviour.status is Status.SUCCEEDED


def test_it_waits_for_the_path_around_an_obstacle():
    plan = room(5.0, 2.0)
    behaviour, world, later = planning(Boustrophedon, plan, with_box(plan, (2.0, 0.5, 2.4, 1.5)))
    later.work()
    waited = 0
    for _, command in steps(behaviour, world, seconds=200.0):
        if later.tasks:
            assert (command, behaviour.message) == (STOP_BRUSHES_DOWN, 'planning')
            waited += 1
            if waited == 10:
                break
    assert waited == 10
    later.work()
    assert moves(behaviour.step(Observation(0.1, world.robots['rumba'].pose)))


def test_a_mission_waits_for_the_lengths_of_the_paths_to_its_dock():
    world = World(PLAN, quiet())
    world.spawn('rumba', brushes_up=True)
    world.step()
    later = Later()
    mission = Mission(context_of(PLAN, world, executor=later), 'boustrophedon', 0.98)
    waited = []
    for _, command in steps(mission, world, seconds=5.0):
        waited.append((command, mission.state, mission.message))
    assert set(waited) == {(STOP, State.IDLE, 'planning')}
    later.work()
    run(mission, world, seconds=1.0)
    assert mission.state is State.UNDOCKING


def test_a_mission_that_plans_in_another_thread_meets_its_target():
    with concurrent.futures.ThreadPoolExecutor(1) as executor:
        world = World(PLAN, quiet())
        world.spawn('rumba', brushes_up=True)
        world.step()
        mission = Mission(context_of(PLAN, world, executor=executor), 'boustrophedon', 0.98)
        for _ in steps(mission, world, seconds=36000.0):
            if 'planning' in mission.message:
                time.sleep(0.01)  # else this thread leaves the other one no time
    assert mission.status is Status.SUCCEEDED and world.robots['rumba'].is_docked
    assert world.floor.coverage >= 0.98


def test_a_plan_made_later_is_the_same_plan():
    swept = []
    for executor in (None, Later()):
        world = World(PLAN, quiet())
        world.spawn('rumba', START)
        context = context_of(PLAN, world, executor=executor)
        context.swept.begin(START.x, START.y)
        behaviour = Boustrophedon(context)
        behaviour.step(SEEN)
        if executor is not None:
            executor.work()
        run(behaviour, world, seconds=60.0)
        swept.append(world.floor.cells.copy())
    assert np.array_equal(*swept)
