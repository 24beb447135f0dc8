"""Many worlds in one call: each of them is what it would be alone, bit for bit."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rooms import PLANS, crooked, gaps, room

from rumba_sim.model.common.config import updated
from rumba_sim.model.common.errors import CommandError, WorldError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.compiling import batch
from rumba_sim.model.compiling.compiled import many
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.noise import NOISE_TICKS
from rumba_sim.model.simulation.obstacle import Obstacle, walk
from rumba_sim.model.simulation.world import World
from rumba_sim.model.simulation.worlds import Worlds, world_with_a_robot

FLOORS = [crooked(dock=Pose(3.8, 1.0, 0.0), cliff=(3.6, 2.6, 4.0, 3.0), carpet=(0.0, 0.0, 1.0, 1.0)),
          crooked(0.02), gaps(0.05), room(2.0, 1.5, 0.1, dock=Pose(1.8, 0.7, 0.0), further_docks=[Pose(0.2, 0.7, 3.1)])]
POST = Obstacle('post', Pose(1.0, 1.0, 0.0), height=0.3, radius=0.05)
CAT = Obstacle('cat', Pose(0.3, 0.3, 0.0), height=0.3, radius=0.1, stops=walk(
    [Pose(0.3, 0.3, 0.0), Pose(1.5, 1.2, 0.0), Pose(0.5, 1.2, 0.0)], 0.5, True, 0.0, 1.0))
KINDS = st.lists(st.tuples(
    st.integers(0, len(FLOORS) - 1), st.integers(0, 5), st.sampled_from([(), (CAT,)]), st.floats(0.1, 0.5),
    st.floats(0.1, 0.3), st.floats(1.0, 500.0), st.sampled_from([10.0, 50.0])), min_size=1, max_size=6)
ACTIONS = st.lists(st.tuples(
    st.sampled_from(['drive', 'drive', 'sense', 'reset', 'obstacle', 'settings', 'alone', 'move', 'again']),
    st.integers(0, 5), st.floats(-0.5, 0.5), st.floats(-1.9, 1.9), st.integers(0, 600)), max_size=8)


def config(speed=0.5, brush=0.17, drain=1.0, beams=24):
    """A robot of its own kind."""
    return updated(RobotConfig(), {'drive': {'max_speed': speed}, 'brush': {'width': brush},
                                   'battery': {'drain': drain}, 'laser': {'beams': beams}}, 'test')


def built(kinds):
    """Worlds of different floors, seeds, obstacles, settings and step rates."""
    worlds = []
    for floor, seed, obstacles, speed, brush, drain, rate in kinds:
        world = World(FLOORS[floor], config(speed, brush, drain), rate, seed, obstacles)
        world.spawn('rumba')
        worlds.append(world)
    return worlds


def do(world, action, kind, v, w, ticks):
    """Something that happens to one world between the steps."""
    try:
        if action == 'reset':
            world.reset()
        elif action == 'obstacle':
            (world.remove_obstacle if 'post' in world.obstacles.items else world.add_obstacle)(
                'post' if 'post' in world.obstacles.items else POST)
        elif action == 'settings':
            world.config = config(0.1 + abs(v) / 2.0, 0.2, 10.0)
        elif action == 'alone':
            world.step(ticks)
        elif action == 'move':
            world.teleport('rumba', Pose(1.0 + v, 0.5 + abs(w) / 4.0, w))
    except WorldError as error:
        return str(error)
    return ''


@settings(max_examples=30, deadline=None)
@given(KINDS, ACTIONS, st.integers(1, 3))
def test_each_world_is_as_if_it_were_alone_whatever_happens_to_any_of_them(kinds, actions, threads):
    worlds, alone, left = Worlds(built(kinds), threads), built(kinds), []
    for action, number, v, w, ticks in actions:
        which = number % len(alone)
        if action == 'again':
            left.append((worlds[which], alone[which]))
            worlds[which], alone[which] = built([kinds[0]])[0], built([kinds[0]])[0]
        assert do(worlds[which], action, number, v, w, ticks) == do(alone[which], action, number, v, w, ticks)
        speeds, turns = np.linspace(v, 0.4, len(alone)), np.linspace(-w, w, len(alone))
        up = np.arange(len(alone)) % 2 == number % 2
        worlds.command(speeds, turns, up)
        for world, *each in zip(alone, speeds, turns, up):
            world.robots['rumba'].command(*each[:2], world.tick)
            world.robots['rumba'].brushes_up = each[2]
            world.step(ticks)
        worlds.step(ticks)
        if action == 'sense':
            scans, infrared, cliffs = worlds.scan(), worlds.infrared(), worlds.cliffs()
            for index, world in enumerate(alone):
                np.testing.assert_array_equal(scans[index], world.scan('rumba'))
                assert tuple(infrared[index]) == world.infrared('rumba')
                assert list(cliffs[index]) == world.cliffs('rumba')
    assert [worlds[index].digest() for index in range(len(alone))] == [world.digest() for world in alone]
    for replaced, like in left:
        replaced.step(20)
        like.step(20)
        assert replaced.digest() == like.digest()
    np.testing.assert_array_equal(worlds.coverage, [world.floor.coverage for world in alone])
    np.testing.assert_array_equal(worlds.robots['x'], [world.robots['rumba'].pose.x for world in alone])


def test_movers_go_on_in_a_world_that_has_refused_an_obstacle():
    kinds = 2 * [(1, 0, (CAT,), 0.5, 0.25, 1.0, 10.0)]
    worlds, alone = Worlds(built(kinds)), built(kinds)
    worlds.step(12)
    on_the_robot = Obstacle('bin', worlds[0].robots['rumba'].pose, height=0.3, radius=0.05)
    with pytest.raises(WorldError, match='stands there$'):
        worlds[0].add_obstacle(on_the_robot)
    worlds.step(20)
    alone[0].step(32)
    assert worlds[0].digest() == worlds[1].digest() == alone[0].digest()


def test_robots_sweep_bump_and_sense_so_that_the_comparison_says_something():
    worlds = Worlds([world_with_a_robot(FLOORS[0], config(), seed=seed) for seed in range(20)])
    generator, cliffs, infrared = np.random.default_rng(3), 0, 0
    for _ in range(200):
        worlds.command(generator.uniform(0.0, 0.5, 20), generator.uniform(-1.9, 1.9, 20))
        worlds.step(10)
        cliffs, infrared = cliffs + worlds.cliffs().sum(), infrared + worlds.infrared().sum()
    assert worlds.coverage.min() > 0.01 and worlds.robots['bumps'].sum() > 20 and cliffs > 0 and infrared > 0
    assert len({worlds[index].digest() for index in range(20)}) == 20


@given(st.floats(-300.0, 300.0), st.one_of(st.floats(-4.0, 4.0), st.just(0.0)), st.integers(1, 200),
       st.integers(0, 40), st.integers(0, 40))
def test_the_points_of_a_line_that_lie_on_the_floor_are_found_without_trying_all(start, step, limit, first, more):
    inside = [n for n in range(first, first + more) if 0.0 <= start + n * step < limit]
    begin, end = batch.within(start, step, limit, first, first + more)
    assert first <= begin <= end <= first + more and set(range(begin, end)) <= set(inside)
    on_the_border = [n for n in inside if min(abs(start + n * step), abs(limit - start - n * step)) < 1e-9]
    assert set(inside) - set(range(begin, end)) <= set(on_the_border)


def test_a_map_of_the_surroundings_looks_where_the_robot_looks():
    """A robot at (1.5, 1) in a room of 4 x 3 m faces up; it has come from below, and only the left wall is near."""
    plan = room(4.0, 3.0, 0.05, [(0.0, 2.0, 1.0, 3.0)])
    world = World(plan, updated(config(), {'odometry': {'scale_error': 0.0}}, 'test'))
    world.spawn('rumba', Pose(1.5, 0.5, math.pi / 2.0))
    worlds = Worlds([world])
    for _ in range(34):
        worlds.command(np.full(1, 0.3), np.zeros(1))
        worlds.step(5)
    x, y, _ = world.robots['rumba'].pose
    fine, coarse = worlds.surroundings(20, [0.1, 0.4])[0].astype(float) / 255.0
    blocked, left = fine  # from 1 m on the left to 1 m on the right, from 1 m ahead to 1 m behind
    assert x == pytest.approx(1.5) and y == pytest.approx(1.5, abs=0.03)
    np.testing.assert_array_equal(blocked[:4, :4], 1.0)  # the box ahead on the left
    np.testing.assert_array_equal(blocked[:4, 6:], 0.0)
    np.testing.assert_array_equal(blocked[6:], 0.0)
    np.testing.assert_array_equal(left[13:18, 9:11] < 0.3, True)  # the trail behind, as wide as the brush
    np.testing.assert_array_equal(left[1:9, 9:11], 1.0)
    np.testing.assert_array_equal(left[13:18, [7, 12]] > 0.9, True)
    across = coarse[0][10]  # the left wall is 1.5 m away, the right one 2.5 m
    np.testing.assert_array_equal(across, [*6 * [1.0], across[6], *9 * [0.0], across[16], *3 * [1.0]])
    np.testing.assert_array_equal(coarse[0][[0, -1]], 1.0)  # outside the map there is no floor


@settings(max_examples=15, deadline=None)
@given(KINDS, st.lists(st.tuples(st.floats(-0.3, 0.5), st.floats(-1.9, 1.9), st.integers(1, 300),
                                 st.sampled_from(['', '', 'move', 'alone', 'reset'])), min_size=1, max_size=6))
def test_maps_that_were_kept_up_to_date_are_those_that_are_drawn_from_nothing(kinds, moves):
    worlds = Worlds(built(kinds))
    for v, w, ticks, action in moves:
        do(worlds[0], action, 0, v, w, 20)
        worlds.command(np.full(len(worlds), v), np.full(len(worlds), w))
        worlds.step(ticks)
        kept = worlds.surroundings(16, [0.05, 0.3])
    fresh = Worlds([worlds[index] for index in range(len(worlds))]).surroundings(16, [0.05, 0.3])
    np.testing.assert_array_equal(kept, fresh)


def test_sensors_can_be_asked_of_some_worlds_in_any_order():
    worlds, alone = (Worlds(built([(kind, seed, (), 0.4, 0.2, 1.0, 50.0) for seed, kind in enumerate((0, 3, 0, 2))]))
                     for _ in range(2))
    which = np.array([3, 0, 2])
    scans, infrared = worlds.scan(which), worlds.infrared(which)
    cliffs, maps = worlds.cliffs(which), worlds.surroundings(8, [0.1], which)
    for row, index in enumerate(which):
        np.testing.assert_array_equal(scans[row], alone[index].scan('rumba'))
        np.testing.assert_array_equal(infrared[row], alone.infrared()[index])
        np.testing.assert_array_equal(cliffs[row], alone.cliffs()[index])
        np.testing.assert_array_equal(maps[row], alone.surroundings(8, [0.1])[index])
    assert len(np.unique(scans, axis=0)) == 3


def test_worlds_may_take_steps_of_their_own():
    worlds, alone = Worlds(built(3 * [(0, 1, (), 0.4, 0.2, 1.0, 50.0)])), built([(0, 1, (), 0.4, 0.2, 1.0, 50.0)])[0]
    worlds.step(np.array([0, 300, 7]))
    alone.step(300)
    assert [worlds[index].tick for index in range(3)] == [0, 300, 7] and worlds[1].digest() == alone.digest()


def test_worlds_on_one_plan_share_what_never_changes():
    worlds = Worlds([world_with_a_robot(PLANS['crooked', 0.05], config(), seed=seed) for seed in range(3)])
    worlds.step(1)
    assert worlds[0].floor.cells.base is worlds[2].floor.cells.base
    assert np.shares_memory(worlds[0].floor.cells, worlds[2].floor.cells)
    assert not np.shares_memory(worlds[0].floor.sweep.samples, worlds[2].floor.sweep.samples)


def test_the_plain_functions_give_the_results_of_the_compiled_ones(monkeypatch):
    worlds, plain = (Worlds(built([(0, 1, (CAT,), 0.4, 0.2, 1.0, 50.0), (3, 2, (), 0.3, 0.2, 1.0, 50.0)]))
                     for _ in range(2))
    worlds.command(np.array([0.4, 0.3]), np.array([0.5, 0.0]))
    worlds.step(90)
    seen = worlds.scan(), worlds.infrared(), worlds.cliffs(), worlds.surroundings(6, [0.2])
    monkeypatch.setattr('rumba_sim.model.simulation.worlds.many', batch)
    plain.command(np.array([0.4, 0.3]), np.array([0.5, 0.0]))
    plain.step(90)
    for one, other in zip(seen, (plain.scan(), plain.infrared(), plain.cliffs(), plain.surroundings(6, [0.2]))):
        np.testing.assert_allclose(other, one, rtol=0.0, atol=1e-12)
    for name in ('x', 'y', 'theta', 'charge'):
        np.testing.assert_allclose(plain.robots[name], worlds.robots[name], rtol=0.0, atol=1e-12)


def test_every_function_of_the_batch_is_compiled():
    for name, function in vars(batch).items():
        if callable(function) and getattr(function, '__module__', '') == batch.__name__:
            assert getattr(many, name).py_func.__name__ == name, name


def test_a_step_over_the_end_of_the_drawn_noise_draws_more_for_each_world_at_its_own_time():
    worlds = Worlds([world_with_a_robot(FLOORS[3], config(), seed=1) for _ in range(3)])
    worlds[1].step(100)
    worlds.step(3 * NOISE_TICKS + 7)
    assert [worlds[index].tick for index in range(3)] == [775, 875, 775]
    assert worlds[0].digest() == worlds[2].digest() != worlds[1].digest()


def test_what_cannot_be_one_of_many_worlds_is_refused():
    world = world_with_a_robot(FLOORS[3], config())
    with pytest.raises(WorldError, match='no world'):
        Worlds([])
    with pytest.raises(WorldError, match='threads is 0'):
        Worlds([world], 0)
    with pytest.raises(WorldError, match='has 0 robots'):
        Worlds([world, World(FLOORS[3], config())])
    with pytest.raises(WorldError, match='laser/beams is 12 in one world and 24 in another'):
        Worlds([world, world_with_a_robot(FLOORS[3], config(beams=12))])
    worlds = Worlds([world])
    with pytest.raises(WorldError, match='has 0 robots'):
        worlds[0] = World(FLOORS[3], config())
    assert worlds[0] is world
    world.spawn('another')
    with pytest.raises(WorldError, match='has 2 robots'):
        worlds.step()


@pytest.mark.parametrize('v, w', [(math.nan, 0.0), (0.0, math.inf)])
def test_a_command_that_is_not_finite_leaves_all_worlds_as_they_were(v, w):
    worlds = Worlds([world_with_a_robot(FLOORS[3], config()) for _ in range(2)])
    worlds.command(np.array([0.2, 0.1]), np.zeros(2))
    with pytest.raises(CommandError, match='not a finite number'):
        worlds.command(np.array([0.3, v]), np.array([0.0, w]))
    assert worlds.robots['command_v'].tolist() == [0.2, 0.1]
