"""The noise of a laser, by the scans that fit."""

import math

import numpy as np
import pytest
from rooms import room
from scans import error

from rumba_localisation.mapping.mapper import Mapper
from rumba_localisation.noise import FIRST, KERNEL, LEAST, Noise
from rumba_localisation.scan import scan_of
from rumba_sim.model.common.config import updated
from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

STEP = math.radians(1.0)
TABLE = [(0.01, 0.0), (0.02, 0.0), (0.03, 0.0), (0.04, 0.0), (0.005, 0.01), (0.005, 0.02)]  # [m], and share of a range


def rng_drive(constant, share, seconds=90.0):
    """Map a room of 7 m x 5 m by a laser whose ranges err, on a way around; the mapper, and RMS of the position [m]."""
    plan, start = room(7.0, 5.0, boxes=[(2.0, 4.2, 2.8, 5.0), (4.5, 2.0, 5.2, 2.6)]), Pose(1.0, 1.0, 0.0)
    config = updated(RobotConfig(), {'laser': {'noise': 0.0}}, 'a laser without noise')
    world, random = World(plan, config, 50, 1), np.random.default_rng(2)
    robot = world.spawn('rumba', start)
    mapper, errors, corners = Mapper(start), [], [(6.0, 1.0), (6.0, 4.0), (3.5, 4.0), (1.0, 4.0), (1.0, 1.0)]
    for _ in range(round(10 * seconds)):
        x, y = corners[0]
        off = wrap_angle(math.atan2(y - robot.pose.y, x - robot.pose.x) - robot.pose.theta)
        if math.hypot(x - robot.pose.x, y - robot.pose.y) < 0.2:
            corners.append(corners.pop(0))
        robot.command(0.0 if abs(off) > 0.3 else 0.3, max(min(2.0 * off, 1.0), -1.0), world.tick)
        world.step(5)
        ranges = world.scan('rumba')
        ranges = ranges + np.hypot(constant, share * ranges) * random.standard_normal(len(ranges))
        mapper.observe(robot.odometry, scan_of(ranges.astype(np.float32), -math.pi, STEP, 12.0, 0.12))
        errors.append(error(mapper.pose(robot.odometry), robot.pose)[0])
    return mapper, math.sqrt(np.mean(np.square(errors)))


@pytest.mark.parametrize('constant, share', TABLE)
def test_a_laser_that_errs_more_is_mapped_with_as_good_as_its_errors_allow_and_never_lost(constant, share):
    mapper, off = rng_drive(constant, share)
    typical = math.hypot(constant, 3.0 * share)  # of a wall 3 m away
    assert off < max(0.01, typical)
    assert not mapper.is_lost and mapper.redrawn <= 1
    assert np.count_nonzero(mapper.grid.odds < 0.0) * mapper.grid.resolution ** 2 < 1.05 * 35.0  # no floor beyond walls


@pytest.mark.parametrize('constant, share', [(0.01, 0.0), (0.03, 0.0), (0.005, 0.02)])
def test_the_estimate_is_the_noise_in_each_class_of_ranges(constant, share):
    noise = rng_drive(constant, share, 60.0)[0].noise
    for distance in (1.5, 3.0):
        [kernel] = noise.kernels(np.array([[distance, 0.0]]))
        true = math.hypot(constant, share * distance)
        assert 0.7 * true < kernel / KERNEL < 1.6 * true + 0.005


def test_noise_that_is_told_is_not_estimated():
    noise = Noise(0.05)
    noise.follow(np.zeros(3), np.zeros((100, 2)), (0.0, 0.0), np.zeros((9, 9), np.float32), -1.0, -1.0, 0.5)
    assert noise.sigma == 0.05 and noise.is_settled
    assert noise.steps[-1] == pytest.approx(0.1) and noise.steps[0] == pytest.approx(0.5)


def test_nothing_is_learnt_of_beams_that_hit_what_the_map_does_not_show():
    noise, field = Noise(), np.full((41, 41), 0.5, np.float32)  # no wall is near
    ends = np.random.default_rng(1).uniform(-1.0, 1.0, (200, 2))
    noise.follow(np.zeros(3), ends, (0.0, 0.0), field, -1.0, -1.0, 0.05)
    assert noise.sigma == FIRST and not noise.is_settled


def test_classes_of_longer_ranges_err_as_much_at_least_until_something_is_known_of_them():
    noise, field = Noise(), np.full((41, 41), 0.03, np.float32)
    for _ in range(200):
        noise.follow(np.zeros(3), np.random.default_rng(1).uniform(-0.5, 0.5, (200, 2)), (0.0, 0.0), field, -1.0, -1.0,
                     0.05)
    near, far = noise.kernels(np.array([[0.5, 0.0], [6.0, 0.0]]))
    assert near / KERNEL == pytest.approx(1.4826 * 0.03, rel=0.02) and far >= near > KERNEL * LEAST
