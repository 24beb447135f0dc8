"""What a robot takes for swept by its mates before these have driven there."""

import numpy as np
import pytest
from floors import knowing
from rooms import room

from rumba_cleaning.belief.mates import Mates, Report, Task
from rumba_cleaning.planning.common import effort
from rumba_cleaning.planning.search.edits import dense
from rumba_cleaning.planning.simulate.rehearsal import Rehearsal
from rumba_cleaning.planning.team.sharing import leave_to_mates
from rumba_cleaning.route import Ahead, Route
from rumba_sim.model.common.geometry import Pose

START = Pose(0.5, 0.5, 0.0)
ZIGZAG = np.array([[0.5, 0.5], [3.5, 0.5], [3.5, 0.67], [0.5, 0.67], [0.5, 0.84], [3.5, 0.84], [3.5, 1.5], [0.5, 1.5]])


def shared_with(route, task=Task.SWEEPING, done=0.0):
    """The context of a robot that leaves a route to a mate, which has driven so much of it [m]."""
    context = knowing(room(4.0, 2.0, 0.02), START)
    length = float(np.hypot(*np.diff(route.waypoints, axis=0).T).sum())
    context.mates = Mates('rumba2', ['rumba', 'rumba2'])
    context.mates.hear('rumba', Report(START, False, task, Ahead(route, length - done)))
    leave_to_mates(context)
    return context


def zigzag(last_speed=0.3):
    """Lanes with corners; the last of them may be a way that the mate drives with its brushes up."""
    return dense(Route(ZIGZAG, np.array([0.3] * 6 + [last_speed])))


@pytest.mark.parametrize('last_speed', [0.3, 0.45])
def test_it_is_what_the_mate_will_sweep_with_the_corners_that_it_cuts(last_speed):
    route = zigzag(last_speed)
    driven = Rehearsal(knowing(room(4.0, 2.0, 0.02), START), START, route).swept.coverage
    assert shared_with(route).swept.coverage == pytest.approx(driven, abs=1e-6)


def test_what_the_mate_has_driven_counts_once_it_was_seen_and_a_mate_that_does_not_sweep_leaves_all():
    assert shared_with(zigzag(), done=3.0).swept.coverage < 0.8 * shared_with(zigzag()).swept.coverage
    assert shared_with(zigzag(), Task.RETURNING).swept.coverage == 0.0


def test_on_a_floor_that_is_too_large_for_rehearsals_it_is_what_a_robot_that_follows_exactly_would(monkeypatch):
    rehearsed = shared_with(zigzag()).swept.coverage
    monkeypatch.setattr(effort, 'WORK', 1.0)
    assert shared_with(zigzag()).swept.coverage == pytest.approx(rehearsed, rel=0.03)
    assert shared_with(zigzag()).swept.coverage != rehearsed


def test_a_route_that_no_robot_can_follow_counts_as_if_one_could():
    through = Route(np.array([[0.5, 0.5], [0.5, 5.0]]), np.array([0.3]))
    assert 0.0 < shared_with(through).swept.coverage < 1.0
