"""What bumper and cliff sensors find, and maps that are written and read again."""

import math

import numpy as np
import pytest
from rooms import crooked

from rumba_localisation.mapping.believed_plan import believed_plan
from rumba_localisation.mapping.findings import Findings
from rumba_localisation.mapping.grids import saving
from rumba_localisation.mapping.grids.grid import Grid
from rumba_localisation.noise import Noise
from rumba_localisation.scan import Scan
from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps import map_file
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, UNKNOWN, FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig

AWAY = RobotConfig().drive.radius + 0.02
QUIET = (False,) * 4


def findings():
    """Those of a robot that has found nothing yet."""
    return Findings(RobotConfig())


def grid_with_wall(x):
    """A grid with a wall along y, and floor before it."""
    grid = Grid()
    points = np.stack([np.full(300, x), np.linspace(-1.0, 1.0, 300)], axis=1)
    grid.add(Pose(0.0, 0.0, 0.0), Scan(points, np.empty((0, 2))), Noise())
    grid.measure()
    return grid


@pytest.mark.parametrize('bumper, angle', [((True, True), 0.0), ((True, False), 0.74), ((False, True), -0.74)])
def test_a_contact_with_nothing_that_the_map_shows_is_remembered_on_its_side(bumper, angle):
    found = findings()
    found.note(grid_with_wall(5.0), Pose(1.0, 0.2, 0.3), bumper, QUIET)
    assert found.touched == [pytest.approx((1.0 + AWAY * math.cos(0.3 + angle), 0.2 + AWAY * math.sin(0.3 + angle)))]


def test_a_contact_with_a_wall_of_the_map_is_none_with_something_else():
    found = findings()
    found.note(grid_with_wall(1.0 + AWAY), Pose(1.0, 0.0, 0.0), (True, True), QUIET)
    assert not found.touched


def test_what_is_found_twice_is_remembered_once():
    found = findings()
    for x in (1.0, 1.01):
        found.note(Grid(), Pose(x, 0.0, 0.0), (True, True), (True, False, False, False))
        found.note(Grid(), Pose(x, 0.0, 0.0), (False, False), QUIET)
    assert len(found.touched) == len(found.cliffs) == 1


def test_a_switch_that_stays_pressed_tells_nothing_new():
    found = findings()
    for x, is_left_pressed in ((1.0, True), (1.1, True), (1.2, False)):  # as the wheels have it, which slip
        found.note(Grid(), Pose(x, 0.0, 0.0), (is_left_pressed, True), QUIET)
    assert len(found.touched) == 1


@pytest.mark.parametrize('sides, is_known', [((-1.1, 1.1), True), ((1.1,), False), ((0.3,), True)])
def test_both_switches_are_pressed_by_what_the_map_shows_ahead_or_at_both_sides(sides, is_known):
    found, grid = findings(), Grid()
    legs = np.array([[AWAY * math.cos(side), AWAY * math.sin(side)] for side in sides])
    grid.add(Pose(0.0, 0.0, 0.0), Scan(legs, np.empty((0, 2))), Noise())
    grid.measure()
    found.note(grid, Pose(0.0, 0.0, 0.0), (True, True), QUIET)
    assert not found.touched if is_known else len(found.touched) == 1


def test_a_cliff_is_where_the_sensor_is_at_first_then_half_way_from_where_it_saw_floor_then_where_it_saw_it_last():
    found, cliff = findings(), RobotConfig().cliff
    found.note(Grid(), Pose(1.0, 2.0, 0.0), (False, False), (True, False, False, False))
    angle = cliff.angles[0]
    assert angle > 0.0  # the first is on the left
    assert found.cliffs == [pytest.approx((1.0 + cliff.distance * math.cos(angle),
                                           2.0 + cliff.distance * math.sin(angle)))]
    found = findings()
    found.note(Grid(), Pose(1.0, 2.0, 0.0), (False, False), QUIET)
    for x in (1.1, 1.4):
        found.note(Grid(), Pose(x, 2.0, 0.0), (False, False), (True, False, False, False))
    assert found.cliffs == [pytest.approx((x + cliff.distance * math.cos(angle),
                                           2.0 + cliff.distance * math.sin(angle))) for x in (1.05, 1.1)]


def test_a_plan_shows_what_was_found():
    found = findings()
    found.touched, found.cliffs = [(0.5, 0.01)], [(0.7, 0.01)]
    plan = believed_plan(grid_with_wall(2.0), 'found', None, found)
    assert plan.occupancy[plan.cell(0.5, 0.01)] == OCCUPIED
    assert plan.cliff[plan.cell(0.7, 0.01)] and plan.occupancy[plan.cell(0.7, 0.01)] == FREE
    assert plan.occupancy[plan.cell(0.6, 0.01)] == FREE and not plan.cliff[plan.cell(0.6, 0.01)]


def test_a_map_that_is_saved_is_read_again(tmp_path):
    cells = crooked(0.02).occupancy.copy()
    cells[:40, :40] = UNKNOWN
    cliff = np.zeros(cells.shape, np.bool_)
    cliff[100, 120:124] = True
    plan = FloorPlan('crooked', cells, 0.02, (-1.23, 0.5), cliff=cliff, dock=Pose(1.0, 1.75, -0.7))
    saving.save(str(tmp_path / 'home.yaml'), plan)
    read = map_file.load(str(tmp_path / 'home.yaml'))
    assert read.dock == pytest.approx(plan.dock, abs=1e-6)
    assert read.resolution == plan.resolution
    for row, column in ((20, 60), (0, 80), (100, 121), (60, 20)):
        x, y = plan.centre(row, column)
        assert read.occupancy[read.cell(x, y)] == cells[row, column]
        assert read.cliff[read.cell(x, y)] == cliff[row, column]
    assert np.count_nonzero(read.free) == np.count_nonzero(plan.free)


@pytest.mark.parametrize('path, pattern', [
    ('home.png', "home.png'?: the file of a map must end in .yaml"),
    ('.yaml', 'must end in .yaml'),
    ('no/such/folder/home.yaml', 'cannot be written: No such file or directory')])
def test_a_path_that_cannot_be_written_is_refused(tmp_path, path, pattern):
    with pytest.raises(MapError, match=pattern):
        saving.save(str(tmp_path / path), crooked())
