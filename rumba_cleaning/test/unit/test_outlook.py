"""What a mission will take is told before it begins, and by a map without a dock that it will not do."""

import pytest
from pytest import approx
from rooms import quiet, room

from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.mission.outlook import outlook, remarks
from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.geometry import Pose

CONFIG = CleaningConfig()


def of_room(width, height, **sections):
    """The outlook in an empty room [m]."""
    return outlook(room(width, height, 0.1), 0.5 * width, 0.5 * height, quiet(**sections), CONFIG)


def test_time_is_that_for_the_area_and_for_one_more_pass_along_the_edges():
    rim = 2.0 * (0.17425 - 0.085)
    width, height = 10.0 - rim, 8.0 - rim
    found = of_room(10.0, 8.0)
    assert found.area == approx(width * height, rel=0.01)
    assert found.working == approx((width * height / 0.17 + 2.0 * (width + height)) / 0.3, rel=0.01)
    assert (found.charges, found.charging) == (0, 0.0) and found.hours == approx(found.working / 3600.0)


def test_a_robot_that_cannot_drive_at_the_cleaning_speed_takes_longer():
    slow = of_room(10.0, 8.0, drive={'max_speed': 0.15})
    assert slow.working == approx(2.0 * of_room(10.0, 8.0).working)


def test_a_large_floor_takes_charges_and_each_takes_its_time():
    """2.7 Ah last for 2.7 / 1.69 h of cleaning; a charge from 8 to 95 % takes 1.3 times 0.87 * 2.7 / 1.25 h."""
    found = of_room(30.0, 20.0)
    batteries = found.working / 3600.0 * 1.69 / 2.7
    assert batteries == approx(2.1, abs=0.1) and found.charges == 2
    assert found.charging / 3600.0 == approx(2 * 1.3 * 0.87 * 2.7 / 1.25)
    quick = of_room(30.0, 20.0, battery={'drain': 10.0})
    assert quick.charges == approx(10 * batteries / 0.87, abs=1.5)
    assert quick.charging == approx(found.charging / 20.0 * quick.charges)
    assert of_room(30.0, 20.0, battery={'drain': 0.0}).charges == 0


def test_a_map_without_a_dock_on_which_the_battery_does_not_last_is_told():
    remark, = remarks(room(30.0, 20.0, 0.1), 5.0, 5.0, quiet(), CONFIG)
    assert remark == (
        'room: the map has no dock, and 591 m² take about 2 charges: add a dock (rosrun rumba_sim place_dock finds a '
        'place), or set drain to 0')
    assert remarks(room(30.0, 20.0, 0.1, dock=Pose(1.0, 0.2, 0.0)), 5.0, 5.0, quiet(), CONFIG) == []
    assert remarks(room(6.0, 5.0, 0.1), 1.0, 1.0, quiet(), CONFIG) == []


def test_a_cleaning_speed_that_the_robot_cannot_drive_is_told_and_lowered():
    slow = quiet(drive={'max_speed': 0.22})
    plan = room(3.0, 2.0)
    remark, = remarks(plan, 1.0, 1.0, slow, CONFIG)
    assert remark == 'the cleaning speed is 0.3 m/s, and drive/max_speed 0.22: the robot cleans at 0.22 m/s'
    context = Context(plan, slow, CONFIG)
    assert (context.config.speed, context.config.transit_speed) == (0.22, approx(0.2202, abs=1e-4))
    assert Context(plan, quiet(), CONFIG).config == CONFIG


def test_a_start_in_a_wall_is_refused():
    with pytest.raises(MapError, match='does not fit'):
        outlook(room(3.0, 3.0), 0.1, 0.1, quiet(), CONFIG)
