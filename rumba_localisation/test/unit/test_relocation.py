"""A robot that was carried away is looked for on its own map, honestly, and a little at each scan."""


import numpy as np
import pytest
from rooms import crooked, room
from scans import error
from test_mapper import drive, scan, world_of

from rumba_localisation.mapping import relocation
from rumba_localisation.mapping.mapper import Mapper
from rumba_localisation.mapping.mapper_config import MapperConfig
from rumba_localisation.mapping.relocation import Relocation
from rumba_sim.model.common.geometry import Pose


def map_of(plan, start, corners, seed=1):
    """A world and the map that its robot has made of it."""
    world, mapper = world_of(plan, start, seed), Mapper(start)
    for _ in drive(world, mapper, corners):
        pass
    return world, mapper


def looked_for(world, mapper, there, corners, search=None):
    """Carry the robot away, and have it drive while it is looked for; what is found, and where the robot then is."""
    search, robot = search or Relocation(mapper.grid, mapper.noise, mapper.correction), world.robots['rumba']
    world.teleport('rumba', there)
    scans = []

    class Looking:
        """Stands for the mapper."""

        def observe(self, odometry, seen):
            """Use each fourth scan."""
            scans.append(seen)
            self.found = search.observe(odometry, seen) if len(scans) % 4 == 0 else None
    looking = Looking()
    for _ in drive(world, looking, corners):
        if looking.found is not None:
            return looking.found, robot.pose
    return None, robot.pose


@pytest.mark.parametrize('there', [Pose(1.0, 2.5, 2.0), Pose(3.0, 1.2, -1.0)])
def test_a_place_that_no_other_is_like_is_found(there):
    world, mapper = map_of(crooked(0.02), Pose(0.6, 1.2, 0.0), [(2.0, 1.3), (2.2, 2.6), (1.0, 2.6), (0.6, 1.2)])
    found, true = looked_for(world, mapper, there, [(2.2, 2.4), (1.0, 2.5), (2.2, 2.4), (1.0, 2.5)])
    assert max(error(found.pose, true)) < 0.05


def test_of_two_places_that_are_alike_the_one_is_found_where_the_robot_was_before():
    plan = room(4.0, 2.6, 0.02)  # looks the same after half a turn
    world, mapper = map_of(plan, Pose(0.6, 0.8, 0.0), [(3.4, 0.8), (3.4, 1.8), (0.6, 1.8), (0.6, 0.8)])
    found, true = looked_for(world, mapper, world.robots['rumba'].pose, [(1.0, 1.8), (1.0, 0.8), (3.2, 0.8)])
    assert max(error(found.pose, true)) < 0.05


def test_between_places_that_are_alike_none_is_chosen():
    plan = room(4.0, 2.6, 0.02)  # looks the same after half a turn
    world, mapper = map_of(plan, Pose(0.6, 0.8, 0.0), [(3.4, 0.8), (3.4, 1.8), (0.6, 1.8), (0.6, 0.8)])
    found, _ = looked_for(world, mapper, Pose(2.5, 1.8, 3.0), [(1.0, 1.8), (1.0, 0.8), (3.2, 0.8), (3.2, 1.8)])
    assert found is None


def test_nothing_is_found_where_the_map_has_nothing():
    world, mapper = map_of(crooked(0.02), Pose(0.6, 1.2, 0.0), [(2.0, 1.3), (0.6, 1.2)])
    other = world_of(room(9.0, 7.0, 0.05, [(3.0, 3.0, 4.0, 3.5), (6.0, 1.0, 6.5, 2.0)]), Pose(1.0, 1.0, 0.0))
    found, _ = looked_for(other, mapper, Pose(1.0, 1.5, 0.0), [(5.0, 2.5), (5.0, 5.5), (1.0, 5.5)])
    assert found is None and world is not other


def test_a_robot_that_comes_back_to_floor_that_the_map_shows_is_found():
    world, mapper = map_of(crooked(0.02), Pose(0.6, 1.2, 0.0), [(2.0, 1.3), (2.2, 2.6), (1.0, 2.6), (0.6, 1.2)])
    other = world_of(room(9.0, 7.0, 0.05, [(3.0, 3.0, 4.0, 3.5), (6.0, 1.0, 6.5, 2.0)]), Pose(1.0, 1.0, 0.0))
    search = Relocation(mapper.grid, mapper.noise, mapper.correction)
    found, _ = looked_for(other, mapper, Pose(1.0, 1.5, 0.0), [(5.0, 2.5), (5.0, 5.5)], search)
    assert found is None
    corners = [(2.2, 2.4), (1.0, 2.5), (2.2, 2.4), (1.0, 2.5)]
    found, true = looked_for(world, mapper, Pose(1.0, 2.5, 2.0), corners, search)
    assert max(error(found.pose, true)) < 0.05


def test_on_a_map_too_small_for_a_place_to_be_tried_nothing_is_found():
    world, mapper = world_of(crooked(0.05), Pose(0.6, 1.2, 0.0)), Mapper(config=MapperConfig(delta=0.2))
    mapper.observe(Pose(0.0, 0.0, 0.0), scan(world))
    mapper.grid.odds[:] = 1.0
    search = Relocation(mapper.grid, mapper.noise, mapper.correction)
    assert search.observe(Pose(0.0, 0.0, 0.0), scan(world)) is None


def test_no_scan_tries_more_places_than_it_may(monkeypatch):
    tried = []
    look_around = relocation.compiled_matching.look_around
    monkeypatch.setattr(relocation, 'AT_ONCE', 20)
    monkeypatch.setattr(relocation.compiled_matching, 'look_around',
                        lambda *given: tried.append(len(given[6])) or look_around(*given))
    world, mapper = map_of(crooked(0.05), Pose(0.6, 1.2, 0.0), [(2.0, 1.3), (0.6, 1.2)])
    tried.clear()
    search = Relocation(mapper.grid, mapper.noise, mapper.correction)
    for number in range(40):
        search.observe(Pose(0.01 * number, 0.0, 0.0), scan(world))
    assert max(tried) <= 20 and len(tried) > 3
    places = sum(tried)
    assert places == pytest.approx(np.count_nonzero(mapper.grid.odds < 0.0) * (mapper.grid.resolution / 0.15) ** 2,
                                   rel=0.3)
