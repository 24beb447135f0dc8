"""Scans are weighed and matched as closed forms say."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rooms import crooked, room
from scans import scanned, world_of

from rumba_localisation import compiled_matching
from rumba_localisation.localiser_config import LocaliserConfig
from rumba_localisation.matcher import STEPS, Match, Matcher
from rumba_localisation.walls import Walls
from rumba_sim.model.common.geometry import Pose

WIDE = np.diag([0.1, 0.1, 0.1]) ** 2


def matched(walls, start, points, covariance=WIDE):
    """Pose, its covariance, and the fit."""
    pose, result = np.empty(3), np.empty((3, 3))
    fit = compiled_matching.match(np.array(start, float), covariance, points, np.zeros(len(points)),
                                  walls.distance, *walls.origin, walls.resolution, STEPS, 1.0, pose, result)
    return pose, result, fit


def test_a_pose_is_weighed_by_the_cells_in_which_its_beams_end():
    walls = Walls(room(3.0, 2.0, 0.025))
    field = np.zeros((walls.distance.shape[0] + 1, walls.distance.shape[1] + 1), np.float32)
    field[1 + 23, 1 + 43], field[1 + 59, 1 + 11] = -1.0, -10.0  # cells around (1.0625, 0.5625) and (0.2625, 1.4625)
    poses = np.array([[0.56, 0.56, 0.0], [1.06, 1.06, -0.5 * math.pi], [0.26, 0.96, 0.5 * math.pi], [9.0, -9.0, 0.3]])
    sums = np.empty(4)
    compiled_matching.weigh(poses, np.array([[0.5, 0.0]]), field, *walls.origin, walls.resolution, sums)
    assert sums.tolist() == [-1.0, -1.0, -10.0, 0.0]


@settings(max_examples=30)
@given(st.floats(-0.06, 0.06), st.floats(-0.06, 0.06), st.floats(-0.1, 0.1))
def test_a_match_finds_the_pose_from_nearby(x, y, theta):
    world = world_of(crooked(0.025), Pose(2.0, 1.3, 0.7))
    pose, covariance, fit = matched(Walls(world.plan), (2.0 + x, 1.3 + y, 0.7 + theta), scanned(world).points)
    assert pose == pytest.approx([2.0, 1.3, 0.7], abs=0.006)
    assert fit > 0.85 and math.sqrt(covariance[0, 0]) < 0.01


def test_along_a_bare_wall_the_prior_decides():
    """One straight wall says nothing of the position along it."""
    walls = Walls(room(6.0, 2.0, 0.05))
    points = np.array([[x, -1.0] for x in np.linspace(-0.5, 0.5, 40)])
    pose, covariance, _ = matched(walls, (3.03, 1.04, 0.02), points)
    assert pose == pytest.approx([3.03, 1.0, 0.0], abs=2e-3)
    assert covariance[0, 0] == pytest.approx(WIDE[0, 0], rel=0.05) and covariance[1, 1] < 0.01 * WIDE[1, 1]


def normal_equations(field, points):
    """Matrix, vector and share for beams from a pose in a field with cells of 1 m."""
    matrix, vector = np.empty((3, 3)), np.empty(3)
    pose, kernels = np.array([5.0, 5.0, 0.3]), np.zeros(len(points))
    share = compiled_matching.normal_equations(pose, points, kernels, field, 0.0, 0.0, 1.0, 0.5, matrix, vector)
    return matrix, vector, share


def test_distances_that_are_steeper_than_distances_can_be_count_as_if_they_were_not():
    plane = np.broadcast_to(0.6 * np.arange(11.0) + 0.8 * np.arange(11.0)[:, np.newaxis] - 7.0, (11, 11))
    points = np.random.default_rng(1).uniform(-3.0, 3.0, (50, 2))
    for told, expected in zip(normal_equations(7.0 * plane, points), normal_equations(1.0 * plane, points)):
        assert told == pytest.approx(expected)
    matrix, _, _ = normal_equations(0.5 * plane, points)  # between two walls distances are less steep
    assert matrix[0, 0] / matrix[1, 1] == pytest.approx(0.5625)
    assert matrix[0, 0] <= 0.25 * 0.36 * 50.0 / 0.5 ** 2


def test_beams_that_hit_what_the_map_does_not_show_count_little():
    world = world_of(crooked(0.025))
    points = scanned(world).points
    points[:60] *= 0.5  # something stands there
    pose, _, fit = matched(Walls(world.plan), (2.03, 1.27, 0.75), points)
    assert pose == pytest.approx([2.0, 1.3, 0.7], abs=0.01)
    assert fit == pytest.approx(0.95 * (1.0 - 60.0 / len(points)), abs=0.06)


def test_beams_that_would_have_to_pass_through_walls_are_counted():
    """In a room of 3 m x 2 m with a thin wall across, 1 m from its left side."""
    walls = Walls(room(3.0, 2.0, 0.02, [(1.0, 0.0, 1.04, 2.0)]))
    pose = np.array([0.5, 1.0, 0.0])

    def through(*ends):
        return walls.through(pose, np.array(ends, float), (0.0, 0.0))
    assert through((0.5, 0.0), (0.0, 0.9), (0.2, 0.0), (-0.49, 0.0)) == 0.0  # at walls, and at something before them
    assert through((0.54 + 0.13, 0.0)) == 0.0  # the pose may err a little
    assert through((0.54 + 0.2, 0.0)) == 1.0
    assert through((1.5, 0.0), (1.5, 0.5), (0.3, 0.0), (-0.4, 0.1)) == 0.5
    assert through((-1.5, 0.0)) == 1.0  # out of the map
    assert walls.through(np.array([0.5, 1.0, math.pi]), np.array([[1.5, 0.0], [-1.5, 0.0]]), (0.0, 0.0)) == 1.0


def test_a_match_does_not_run_away_from_a_start_that_fits_nowhere():
    walls = Walls(crooked(0.025))
    points = np.random.default_rng(1).uniform(-3.0, 3.0, (100, 2))
    for start in ((2.0, 1.3, 0.7), (0.1, 0.1, 3.0), (3.9, 2.9, -2.0)):
        pose, _, _ = matched(walls, start, points, np.diag([1.0, 1.0, 1.0]))
        assert np.abs(pose - start).max() <= compiled_matching.FARTHEST * len(STEPS)


@pytest.mark.parametrize('is_sure', [True, False])
def test_worse_scans_become_usual_soon_only_while_the_robot_knows_its_place(is_sure):
    matcher = Matcher(None, None, LocaliserConfig())
    good, worse = (Match(np.zeros(3), np.eye(3), fit, 0.0) for fit in (0.9, 0.5))
    matcher.follow(good, True)
    assert not matcher.is_good(worse)
    for _ in range(20):
        matcher.follow(worse, is_sure)
    assert matcher.is_good(worse) == is_sure
