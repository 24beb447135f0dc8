"""What is measured of a path: against closed forms, and against a replay by other means."""

import itertools
import math

import numpy as np
import pytest
from paths import SPEED, SQUARE, TURN_RATE, WIDTH, bare, drawn, driven, path, spiral
from pytest import approx
from rooms import RADIUS, quiet, room

from rumba_cleaning.outcome import Outcome
from rumba_evaluation.scoring.measures import events, ratios, runs, turns_in
from rumba_evaluation.scoring.ride import AsDrawn, Driven
from rumba_sim.model.common.config import updated
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel.sweeping.samples import PASS, REACHABLE
from rumba_sim.model.simulation.obstacle import Obstacle

TICK = 0.02  # [s]
RIM = RADIUS - 0.5 * WIDTH  # [m] along a wall, which no brush reaches
RIGHT_ANGLE = 0.5 * math.pi


# --- closed forms -------------------------------------------------------------------------------------------------

def test_a_straight_lane_as_drawn():
    ride = drawn([(1.0, 2.0), (3.0, 2.0)])
    found = ride.observer.measures()
    assert (ride.outcome, found.turns, found.collisions, found.near_misses) == (Outcome.SUCCEEDED, 0, (), ())
    assert found.path_length == approx(2.0) and found.turned_angle == approx(0.0) and found.time_in_turns == 0.0
    assert ride.time == approx(2.0 / SPEED, abs=2.0 * TICK)
    assert ride.world.floor.cleaned_area == approx(2.0 * WIDTH, rel=0.01)
    assert found.overlap_ratio == found.revisit_ratio == 0.0


def test_a_straight_lane_to_and_fro_is_swept_twice():
    found = drawn([(1.0, 2.0), (3.0, 2.0), (1.0, 2.0)]).observer.measures()
    assert (found.turns, found.path_length) == (1, approx(4.0)) and found.turned_angle == approx(math.pi)
    assert found.time_in_turns == approx(math.pi / TURN_RATE, abs=TICK)
    # Beside the lane, the turn sweeps half a disc beyond its end, which nothing else sweeps.
    lane, half_disc = 2.0 * WIDTH, math.pi * (0.5 * WIDTH) ** 2 / 2.0
    assert found.overlap_ratio == approx(lane / (lane + half_disc), abs=0.01)
    assert found.revisit_ratio == approx((lane + half_disc) / (lane + half_disc), abs=0.02)


def test_a_square_as_drawn():
    ride = drawn(SQUARE)
    found = ride.observer.measures()
    assert (found.turns, found.path_length) == (3, approx(8.0)) and found.turned_angle == approx(3.0 * RIGHT_ANGLE)
    assert found.time_in_turns == approx(3.0 * RIGHT_ANGLE / TURN_RATE, abs=3.0 * TICK)
    assert ride.time == approx(8.0 / SPEED + 3.0 * RIGHT_ANGLE / TURN_RATE, abs=2.0 * TICK)
    # At each corner the two lanes overlap in a square of half a brush. The turns sweep two quarters of a disc each: one
    # in that square, one outside both lanes; there is no turn where the square ends.
    square, quarter = (0.5 * WIDTH) ** 2, math.pi * (0.5 * WIDTH) ** 2 / 4.0
    area = 8.0 * WIDTH - 4.0 * square + 3.0 * quarter
    assert ride.world.floor.cleaned_area == approx(area, rel=0.01)
    assert found.overlap_ratio == approx(4.0 * square / area, rel=0.1)
    # The floor is swept in strides of 3 cm.
    assert found.revisit_ratio == approx((8.0 * WIDTH + 6.0 * quarter) / area - 1.0, rel=0.15)


def test_a_spiral_as_drawn_and_driven():
    points, length, angle = spiral()
    for ride in (drawn(points), driven(points)):
        found = ride.observer.measures()
        assert found.path_length == approx(length, rel=0.005) and found.turned_angle == approx(angle, rel=0.03)
        assert ride.world.floor.cleaned_area == approx(length * WIDTH, rel=0.01)
        assert found.overlap_ratio < 0.002 and (found.turns, found.time_in_turns) == (0, 0.0)
        assert ride.time == approx(length / SPEED, rel=0.05)


def test_a_square_driven_with_the_limits_of_a_robot_is_cut_at_its_corners():
    exact, ride = drawn(SQUARE), driven(SQUARE)
    found = ride.observer.measures()
    assert (ride.outcome, found.turns) == (Outcome.SUCCEEDED, 3)
    assert 7.5 < found.path_length < 8.1
    assert all(np.hypot(*(ride.observer.path[:, :2] - corner).T).min() > 0.01 for corner in SQUARE[1:-1])
    assert np.max(np.abs(np.diff(ride.observer.path[:, 0]))) <= SPEED * TICK * 1.01
    assert exact.observer.measures().path_length == approx(8.0)


def test_the_charge_that_was_used_is_what_the_battery_lacks():
    for ride in (drawn(SQUARE), driven(SQUARE)):
        battery = ride.world.config.battery
        assert ride.meter.charge == approx(battery.capacity * (1.0 - ride.robot.battery.state_of_charge), rel=0.01)
        assert 14.0 < ride.meter.energy / ride.meter.charge < 18.5  # [V]


def test_times_of_a_path_count_as_drawn_only():
    points, times = [(1.0, 2.0), (2.0, 2.0), (3.0, 2.0)], [100.0, 110.0, 112.0]
    assert 'which no robot can do' not in drawn(points, times=times).message
    assert '(up to 1.0 m/s, which no robot can do)' in drawn(points, times=[0.0, 1.0, 2.0]).message
    assert drawn(points, times=times).time == approx(12.0, abs=2.0 * TICK)
    assert driven(points, times=times).time == approx(2.0 / SPEED, abs=1.5)


def test_headings_of_a_path_count_as_drawn_unless_they_are_all_the_same():
    points = [(1.0, 2.0), (3.0, 2.0), (3.0, 3.0)]
    aside = drawn(points, headings=[0.0, 0.0, 0.001])  # the brush lies along the second lane
    along = drawn(points, headings=[0.0, 0.0, 0.0])
    assert '(1.0 m of it sideways, which no robot can do)' in aside.message and 'which' not in along.message
    assert aside.world.floor.cleaned_area == approx(2.0 * WIDTH, rel=0.02)
    assert along.world.floor.cleaned_area > 2.9 * WIDTH


# --- a replay by other means --------------------------------------------------------------------------------------

def replay(path, step=0.004):
    """Visits of points on a grid by the brush, as it goes from pose to pose: convex quadrangles, and runs of ticks."""
    x, y = np.meshgrid(np.arange(0.5 * step, 4.0, step), np.arange(0.5 * step, 4.0, step))
    visits, last = np.zeros(x.shape, int), np.full(x.shape, -9)
    across = np.stack([-np.sin(path[:, 2]), np.cos(path[:, 2])], axis=1)
    ends = np.linspace(-0.5 * WIDTH, 0.5 * WIDTH, 5)[:, np.newaxis, np.newaxis] * across + path[:, :2]
    for tick, part in itertools.product(range(len(path) - 1), range(4)):
        corners = [ends[part, tick], ends[part, tick + 1], ends[part + 1, tick + 1], ends[part + 1, tick]]
        low, high = np.min(corners, axis=0), np.max(corners, axis=0)
        rows, columns = (slice(max(int(a / step) - 1, 0), int(b / step) + 2) for a, b in zip(low[::-1], high[::-1]))
        px, py = x[rows, columns], y[rows, columns]
        sides = np.array([(b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0])
                          for a, b in zip(corners, corners[1:] + corners[:1])])
        inside = np.all(sides >= 0.0, axis=0) | np.all(sides <= 0.0, axis=0)
        seen = last[rows, columns]
        visits[rows, columns] += inside & (seen < tick - 3)
        last[rows, columns] = np.where(inside, tick, seen)
    return visits, step ** 2


@pytest.mark.thorough
def test_a_replay_by_other_means_finds_the_same_area_and_the_same_overlap():
    lanes = [(x, y) for index, x in enumerate(np.arange(0.6, 3.4, 0.13)) for y in ((0.6, 3.4), (3.4, 0.6))[index % 2]]
    ride = driven(lanes)
    visits, area = replay(ride.observer.path[:-5])  # the robot rolls out with its brushes up
    found, swept = ride.observer.measures(), np.count_nonzero(visits)
    assert ride.world.floor.cleaned_area == approx(swept * area, rel=0.01)
    assert found.overlap_ratio == approx(np.count_nonzero(visits > 1) / swept, abs=0.02) and found.overlap_ratio > 0.2
    assert found.revisit_ratio == approx(np.sum(visits) / swept - 1.0, abs=0.05)
    assert found.turned_angle == approx(np.sum(np.abs(np.diff(np.unwrap(ride.observer.path[:, 2])))))
    assert found.turns == len(lanes) // 2 - 1  # one from lane to lane


# --- collisions and near misses -----------------------------------------------------------------------------------

def test_a_path_through_a_wall_collides_where_the_wall_is():
    plan = room(4.0, 4.0, 0.05, [(1.9, 0.0, 2.1, 2.0)])
    points = [(1.0, 1.0), (3.0, 1.0), (3.0, 3.0), (1.0, 3.0)]
    exact, real = drawn(points, plan=plan), driven(points, plan=plan)
    [through] = exact.observer.measures().collisions
    assert (through.x, through.y) == (approx(2.0, abs=0.15), approx(1.0)) and through.gap < -0.1
    assert through.duration == approx((0.2 + 2.0 * 0.174) / SPEED, abs=0.1)
    assert (exact.outcome, real.outcome) == (Outcome.SUCCEEDED, Outcome.BLOCKED)
    [into] = real.observer.measures().collisions
    assert (into.x, into.y) == (approx(1.9 - 0.175, abs=0.01), approx(1.0, abs=0.02))
    assert not real.meter.penetrated and exact.meter.penetrated


@pytest.mark.parametrize('gap, near', [(0.012, 1), (0.03, 0)])
def test_a_near_miss_is_no_collision(gap, near):
    plan = room(4.0, 4.0, 0.05, [(1.9, 0.0, 2.1, 1.0)])
    found = drawn([(1.0, 1.0 + 0.1755 + gap), (3.0, 1.0 + 0.1755 + gap)], plan=plan).observer.measures()
    assert (len(found.near_misses), found.collisions) == (near, ())
    if near:
        assert found.near_misses[0].x == approx(2.0, abs=0.12) and found.near_misses[0].gap == approx(gap, abs=0.005)


def test_an_obstacle_that_the_map_does_not_show_is_hit_too():
    box = Obstacle('box', Pose(2.0, 2.0, 0.0), height=1.0, length=0.2, width=0.2)
    [event] = drawn([(1.0, 2.0), (3.0, 2.0)], obstacles=[box]).observer.measures().collisions
    assert (event.x, event.y) == (approx(2.0, abs=0.12), approx(2.0))


def test_events_count_runs_and_not_ticks():
    gaps = np.array([0.1] * 50 + [0.0] * 10 + [0.005] * 10 + [0.0] * 5 + [0.1] * 100 + [0.01] * 4 + [0.1] * 9)
    path = np.stack([np.arange(len(gaps)) * 0.01] * 3, axis=1)
    contacts, near = events(path, gaps, 50.0, 100)
    assert [(event.time, event.duration) for event in contacts] == [(3.0, 0.5)]  # two contacts 0.2 s apart are one
    assert [(event.time, event.duration) for event in near] == [(5.5, 0.08)]


def test_runs():
    mask = np.array([1, 1, 0, 1, 0, 0, 0, 1], bool)
    assert runs(mask, 1) == [(0, 2), (3, 4), (7, 8)] and runs(mask, 2) == [(0, 4), (7, 8)]
    assert runs(np.zeros(3, bool), 2) == []


def test_a_wide_curve_and_a_small_correction_are_no_turns():
    straight = np.full(100, 0.006)
    assert turns_in(straight, np.full(100, 0.006 / 0.6), 25) == []  # radius 0.6 m, 57 degrees
    assert turns_in(straight, np.full(100, 0.006 / 0.4), 25) == [(0, 100)]
    assert turns_in(straight[:50], np.full(50, 0.006 / 0.4), 25) == []  # 43 degrees
    assert turns_in(straight, np.tile([0.02, -0.02], 50), 1) == []


def test_ratios_of_counted_passes():
    passes = np.array([[0, 1, 1], [2, 5, 1]])
    samples = (passes * PASS + REACHABLE).astype(np.uint8)
    samples[0, 1] -= REACHABLE  # swept, but beyond what counts
    assert ratios(samples) == (0.5, (1 + 2 + 5 + 1) / 4 - 1.0)
    assert ratios(samples * 0) == (0.0, 0.0)


def test_what_was_never_reached_is_where_the_path_did_not_lead():
    found = drawn([(0.5, 0.5), (3.5, 0.5)]).observer.measures()
    [patch] = found.never_reached
    assert patch.y > 2.0 and patch.area == approx(found.cells_never_reached * 0.05 ** 2)
    assert patch.area == approx((4.0 - 2.0 * RIM) ** 2 - 3.0 * WIDTH, abs=0.6)


def test_a_path_in_a_room_that_nobody_can_reach_sweeps_nothing_that_counts():
    plan = room(4.0, 4.0, 0.05, [(1.9, 0.0, 2.1, 4.0)], start=Pose(1.0, 1.0, 0.0))
    for ride in (drawn([(3.0, 1.0), (3.0, 3.0)], plan=plan), driven([(3.0, 1.0), (3.0, 3.0)], plan=plan)):
        assert ride.message.endswith('; it swept nothing that a robot can reach from the start of the map')
        assert ride.observer.measures().overlap_ratio == ride.observer.measures().revisit_ratio == 0.0


def test_a_ride_ends_at_its_bound_or_with_an_empty_battery():
    points = [(1.0, 1.0), (3.0, 1.0)] * 50
    assert drawn(points, bound=0.1).outcome is driven(points, bound=0.1).outcome is Outcome.TIMED_OUT
    weak = updated(quiet(), {'battery': {'drain': 3000.0}}, 'test')
    for kind in (AsDrawn, Driven):
        ride = kind(bare(), path(points), weak)
        ride.run()
        assert ride.outcome is Outcome.BATTERY_EMPTY and ride.time < 10.0
