"""The time limit of a mission follows the floor, so that a large floor can be cleaned to its end."""

import pytest
from drivers import context_of
from rooms import alone, room

from rumba_cleaning.cleaning_config import DAY
from rumba_cleaning.mission.duration import longest


def limit(width, height, **changes):
    """The limit on a room of this size [m]."""
    plan = room(width, height, 0.1)
    world, _ = alone(plan=plan, pose=None)
    return longest(context_of(plan, world, **changes))


def test_on_a_floor_that_a_day_is_enough_for_the_limit_is_a_day():
    assert limit(10.0, 10.0) == DAY


@pytest.mark.thorough
def test_on_a_large_floor_the_limit_is_three_times_what_work_and_charging_take():
    """2,000 m2: 10.9 h of work without overlap; 1.69 A flow out, 1.25 A in, and the charger tapers."""
    working = 2000.0 / (0.17 * 0.3)
    found = limit(50.0, 40.0)
    assert found == pytest.approx(3.0 * working * (1.0 + 1.3 * 1.69 / 1.25), rel=1e-6)
    assert found > 3.7 * DAY
    assert limit(50.0, 40.0, speed=0.15) == pytest.approx(2.0 * found, rel=1e-6)
