"""The square closes, even if commands come late."""

import collections
import math

import pytest

from turtlesim.model.field import Field
from turtlesim.model.square import SIDE, Square


@pytest.mark.parametrize('late', [0, 3])
def test_it_draws_a_square_of_2_m_to_the_left_and_comes_back(late):
    field, square = Field((0, 0, 0)), Square()
    start = field.pose('turtle1')
    commands = collections.deque([(0.0, 0.0)] * late)
    positions = []
    for _ in range(3000):
        commands.append(square.command(*field.pose('turtle1')))
        speed, turn_rate = commands.popleft()
        assert 0.0 <= speed <= 1.0 and 0.0 <= turn_rate
        field.command('turtle1', (speed, 0.0, turn_rate))
        field.move()
        positions.append(field.pose('turtle1'))
        if len(positions) > 500 and math.dist(positions[-1][:2], start[:2]) < 0.03:
            break
    assert math.dist(positions[-1][:2], start[:2]) < 0.03
    for axis, low in ((0, start[0]), (1, start[1])):
        assert min(position[axis] for position in positions) == pytest.approx(low, abs=0.03)
        assert max(position[axis] for position in positions) == pytest.approx(low + SIDE, abs=0.03)
