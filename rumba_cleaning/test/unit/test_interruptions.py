"""A mission that was stopped, or that a person drove elsewhere, goes on with what it knows of the floor."""

import pytest
from drivers import drive_by_hand, run
from missions import mission, percent_swept, states, until

from rumba_cleaning.behaviour import Status
from rumba_cleaning.control import steps
from rumba_cleaning.mission.stages import State
from rumba_cleaning.outcome import Outcome
from rumba_sim.model.common.errors import CommandError
from rumba_sim.model.common.geometry import Pose


@pytest.mark.thorough(except_for=['elsewhere1-boustrophedon'])
@pytest.mark.parametrize('strategy', ['boustrophedon', 'bounce'])
@pytest.mark.parametrize('elsewhere', [None, Pose(0.5, 2.7, 1.0)])
def test_stopped_and_resumed_it_goes_on_with_what_it_knows_of_the_floor(elsewhere, strategy):
    world, behaviour = mission(strategy=strategy, target=0.9)
    until(behaviour, world, 0.5)
    behaviour.stop()
    if elsewhere is not None:
        world.teleport('rumba', elsewhere)
    behaviour.resume()
    run(behaviour, world, seconds=1.0)
    assert behaviour.state is State.CLEANING
    assert 45.0 < percent_swept(behaviour) < 60.0
    run(behaviour, world, seconds=6000.0)
    assert behaviour.status is Status.SUCCEEDED and behaviour.message.startswith('90.')
    assert world.floor.coverage >= 0.88 and world.robots['rumba'].is_docked


def test_resumed_at_the_dock_it_leaves_it_again_and_counts_its_charges_on():
    world, behaviour = mission(drain=25.0)
    for _ in steps(behaviour, world, seconds=6000.0):
        if behaviour.state is State.CHARGING and behaviour.charging_time > 100.0:
            break
    behaviour.stop()
    world.robots['rumba'].state['charge'] = 0.99 * world.robots['rumba'].config.battery.capacity
    behaviour.resume()
    assert states(behaviour, world)[:2] == [State.UNDOCKING, State.CLEANING]
    assert behaviour.charges == 1 and 100.0 < behaviour.charging_time < 102.0


def test_resumed_on_its_way_home_it_goes_on_home():
    world, behaviour = mission(target=0.3)
    for _ in steps(behaviour, world):
        if behaviour.state is State.RETURNING:
            break
    behaviour.stop()
    behaviour.resume()
    assert states(behaviour, world) == [State.CLEANING, State.RETURNING, State.DOCKING, State.IDLE]
    assert behaviour.status is Status.SUCCEEDED and percent_swept(behaviour) < 32.0


def test_the_memory_is_for_one_run():
    world, behaviour = mission(target=0.9)
    until(behaviour, world, 0.4)
    behaviour.stop()
    behaviour.resume()
    run(behaviour, world, seconds=1.0)
    behaviour.restart()
    run(behaviour, world, seconds=1.0)
    assert percent_swept(behaviour) < 5.0


def test_what_is_forgotten_is_not_resumed():
    world, behaviour = mission(target=0.9)
    until(behaviour, world, 0.4)
    behaviour.stop()
    behaviour.resume()
    behaviour.forget()
    run(behaviour, world, seconds=1.0)
    assert percent_swept(behaviour) < 5.0


def test_a_mission_that_never_began_or_is_under_way_may_be_resumed():
    world, behaviour = mission(target=0.2)
    behaviour.resume()
    run(behaviour, world, seconds=5.0)
    behaviour.resume()
    run(behaviour, world)
    assert behaviour.status is Status.SUCCEEDED


def test_a_mission_that_has_ended_cannot_be_resumed():
    world, behaviour = mission(target=0.2)
    run(behaviour, world)
    with pytest.raises(CommandError, match=r'^a mission that has ended cannot be resumed: 20\.. % swept$'):
        behaviour.resume()


@pytest.mark.thorough(except_for=['0.4-0.6-12.0-boustrophedon'])
@pytest.mark.parametrize('strategy', ['boustrophedon', 'bounce'])
@pytest.mark.parametrize('v, w, seconds', [(0.3, 0.0, 0.5), (0.0, 1.5, 0.5), (0.4, 0.6, 12.0)])
def test_driven_by_a_person_now_and_then_it_still_meets_its_target(strategy, v, w, seconds):
    world, behaviour = mission(strategy=strategy, target=0.9)
    for number, _ in enumerate(steps(behaviour, world, seconds=6000.0), 1):
        if number % 301 == 0 and behaviour.status is Status.RUNNING:
            drive_by_hand(behaviour, world, v, w, seconds)
    assert behaviour.status is Status.SUCCEEDED and behaviour.outcome is Outcome.SUCCEEDED
    assert world.floor.coverage >= 0.9 and world.robots['rumba'].is_docked


def test_what_a_person_drives_over_does_not_count_as_swept():
    world, behaviour = mission(start=Pose(0.5, 0.5, 0.0))
    run(behaviour, world, seconds=10.0)
    world.robots['rumba'].brushes_up = True
    before = percent_swept(behaviour)
    drive_by_hand(behaviour, world, 0.3, 0.3, 20.0)
    run(behaviour, world, seconds=0.2)
    assert before <= percent_swept(behaviour) < before + 0.5


def test_moved_while_a_person_drives_it_cleans_from_there():
    world, behaviour = mission()
    until(behaviour, world, 0.5)
    drive_by_hand(behaviour, world, 0.2, 0.0, 0.5)
    world.teleport('rumba', Pose(0.5, 2.7, 1.0))
    drive_by_hand(behaviour, world, 0.2, 0.0, 0.5)
    run(behaviour, world)
    assert behaviour.status is Status.SUCCEEDED and world.floor.coverage >= 0.97


@pytest.mark.thorough
def test_charges_that_a_person_cuts_short_are_not_in_vain():
    world, behaviour = mission(start=Pose(0.4, 0.4, 0.0), charge=0.3, drain=60.0)
    for charges in range(1, 6):
        for observation, _ in steps(behaviour, world, seconds=1000.0):
            if behaviour.state is State.CHARGING and observation.is_docked and observation.state_of_charge > 0.4:
                break
        drive_by_hand(behaviour, world, -0.2, 0.0, 3.0)
        assert behaviour.charges == charges
    run(behaviour, world, seconds=20000.0)
    assert behaviour.status is Status.SUCCEEDED, behaviour.message


def test_driven_off_the_contacts_while_it_charges_it_goes_on():
    world, behaviour = mission(drain=30.0)
    for _ in steps(behaviour, world, seconds=9000.0):
        if behaviour.state is State.CHARGING and behaviour.charging_time > 50.0:
            break
    drive_by_hand(behaviour, world, -0.2, 0.0, 5.0)
    assert 50.0 < behaviour.charging_time < 56.0
    assert states(behaviour, world, 9000.0)[:2] == [State.CHARGING, State.CLEANING]
    assert behaviour.status is Status.SUCCEEDED and world.robots['rumba'].is_docked
