"""Do scans and odometry tell of the same movements? In a room without symmetry."""

import math

import numpy as np
import pytest

from rumba_cleaning.own_robot.heard import View
from rumba_cleaning.own_robot.views import can_tell, contradiction, has_moved_by_scans
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.mounting import Mounting

PLACE = Mounting(0.05, -0.02, 0.3)
DRIVEN = [Pose(0.1 * step, 0.0, 0.0) for step in range(4)] + [Pose(0.3, 0.0, 0.2 * step) for step in range(1, 6)]
TURNED = [Pose(0.0, 0.0, 0.2 * step) for step in range(6)]
STILL = [Pose(0.0, 0.0, 0.0)] * 3


def corners():
    """Points on the walls of a room with a corner that is cut off (n, 2) [m]."""
    outline = np.array([(-1.5, -1.0), (2.0, -1.0), (2.0, 0.6), (1.2, 1.6), (-1.5, 1.6), (-1.5, -1.0)])
    return np.concatenate([np.linspace(begin, end, 60)[:-1] for begin, end in zip(outline, outline[1:])])


def views(poses, mounting, said=None):
    """What a laser sees that is mounted somewhere, at poses; the odometry says others if they are given."""
    noise = np.random.default_rng(1)
    found = []
    for pose, told in zip(poses, said or poses):
        points = corners() + noise.normal(0.0, 0.01, corners().shape)
        for x, y, theta in (pose, mounting[:3]):
            cos, sin = math.cos(theta), math.sin(theta)
            points = (points - (x, y)) @ np.array([[cos, -sin], [sin, cos]])
        found.append(View(told, points * (1.0, -1.0 if mounting.upside_down else 1.0)))
    return found


@pytest.mark.parametrize('poses', [DRIVEN, TURNED, STILL])
@pytest.mark.parametrize('is_upside_down', [False, True])
def test_nothing_is_said_of_a_laser_that_is_where_it_should_be(poses, is_upside_down):
    mounting = PLACE._replace(upside_down=is_upside_down)
    assert contradiction(views(poses, mounting), mounting) is None


@pytest.mark.parametrize('angle', [90.0, -30.0, 180.0, 15.0])
def test_a_laser_that_is_turned_is_found_once_the_robot_has_driven(angle):
    turned = PLACE._replace(yaw=PLACE.yaw + math.radians(angle))
    found = contradiction(views(DRIVEN, turned), PLACE)
    assert not found.mirrored
    assert abs(math.remainder(found.turned - math.radians(angle), 2.0 * math.pi)) < math.radians(6.0)
    assert contradiction(views(TURNED, turned), PLACE) is None


@pytest.mark.parametrize('poses', [DRIVEN, TURNED])
def test_a_laser_that_is_upside_down_is_found(poses):
    assert contradiction(views(poses, PLACE._replace(upside_down=True)), PLACE).mirrored


def test_odometry_that_turns_the_other_way_looks_the_same():
    said = [Pose(pose.x, -pose.y, -pose.theta) for pose in DRIVEN]
    assert contradiction(views(DRIVEN, PLACE, said), PLACE).mirrored


def test_a_robot_that_stands_tells_nothing_unless_its_scans_move():
    assert not can_tell(views(STILL, PLACE))
    assert not has_moved_by_scans(views(STILL, PLACE))
    assert has_moved_by_scans(views(DRIVEN, PLACE, [STILL[0]] * len(DRIVEN)))
