"""Logs of CARMEN, trajectories, and the errors between two."""

import gzip
import math

import numpy as np
import pytest

from rumba_localisation.logs import carmen, trajectory
from rumba_localisation.logs.entry import LogError
from rumba_localisation.scan import AS_TOLD
from rumba_sim.model.common.geometry import Pose, compose

RANGES = ' '.join(['2.0'] * 89 + ['81.9'] + ['2.0'] * 90)
LOG = f"""# a comment
PARAM robot_frontlaser_offset 0.1 host 0
ODOM 0 0 0 0 0 0 0.5 host 0.5
ODOM 1 0 0 0 0 0 0.9 host 0.9
FLASER 180 {RANGES} 5 6 0.5 1 0 0.2 1.0 host 1.0
ODOM 5 6 0.5 0 0 0 0 host 0
NEFF 30
ODOM 5 7 0.5 0 0 0 1.5 host 1.5
FLASER 180 {RANGES} 5.1 7 0.5 2 0 0.3 2.0 host 2.0
ROBOTLASER1 0 -1.57 3.14 1.57 8.0 0.01 0 3 1.0 2.0 9.0 0 1 2 0 3 4 0.5 0 0 0 0 0 3.5 host 3.5
"""


def read(path, is_corrected=False):
    """The entries of a log, and how many bytes were read."""
    told = []
    return list(carmen.entries(str(path), is_corrected, AS_TOLD, told.append)), sum(told)


@pytest.mark.parametrize('packed', [False, True])
def test_a_log_tells_scans_with_their_odometry(tmp_path, packed):
    path = tmp_path / 'a.log'
    path.write_bytes(gzip.compress(LOG.encode()) if packed else LOG.encode())
    found, size = read(path)
    assert [entry.stamp for entry in found] == [1.0, 2.0, 3.5]
    assert [entry.odometry for entry in found] == [Pose(1.0, 0.0, 0.2), Pose(2.0, 0.0, 0.3), Pose(3.0, 4.0, 0.5)]
    assert all(entry.reference is None for entry in found)
    assert len(found[0].scan.points) == 179 and len(found[0].scan.beyond) == 1  # 81.9 m mean that there is no echo
    assert found[0].scan.points[0] == pytest.approx([0.1, -2.0])  # to the right of a laser 0.1 m ahead
    assert found[2].scan.points == pytest.approx(np.array([[0.1, -1.0], [2.1, 0.0]]), abs=2e-3)
    assert size == path.stat().st_size


def test_the_poses_of_a_corrected_log_are_the_reference_and_the_way_between_them_is_odometry(tmp_path):
    path = tmp_path / 'a.log'
    path.write_text(LOG)
    first, second = read(path, is_corrected=True)[0][:2]
    assert (first.reference, second.reference) == (Pose(5.0, 6.0, 0.5), Pose(5.1, 7.0, 0.5))
    assert first.odometry == pytest.approx(Pose(1.0, 0.0, 0.0))
    assert second.odometry == pytest.approx(compose(first.odometry, Pose(math.sin(0.5), math.cos(0.5), 0.0)))
    assert first.scan.laser == (0.0, 0.0)


@pytest.mark.parametrize('line, reason', [
    ('FLASER 180 1.0 2.0', 'line 1'), ('FLASER three', 'line 1'), ('ODOM nan 0 0', 'nan 0 0 is no pose'),
    ('ROBOTLASER1 0 1', 'line 1'), ('PARAM robot_frontlaser_offset far', 'line 1')])
def test_a_line_that_makes_no_sense_is_named(tmp_path, line, reason):
    path = tmp_path / 'a.log'
    path.write_text(line)
    with pytest.raises(LogError, match=reason) as caught:
        read(path)
    assert str(caught.value).startswith(str(path)) and '\n' not in str(caught.value)


def test_a_log_that_cannot_be_read_is_named(tmp_path):
    with pytest.raises(LogError, match='none.log: cannot be read: No such file'):
        read(tmp_path / 'none.log')
    path = tmp_path / 'cut.log.gz'
    path.write_bytes(gzip.compress(LOG.encode())[:-20])
    with pytest.raises(LogError, match='cut.log.gz: cannot be read'):
        read(path)


def circle(count=100, offset=Pose(0.0, 0.0, 0.0), noise=0.0):
    """Poses around a circle of 5 m, seen from elsewhere."""
    angles = np.linspace(0.0, 2.0 * math.pi, count)
    random = np.random.default_rng(1)
    return [(float(number), compose(offset, Pose(5.0 * math.cos(angle) + noise * random.normal(),
                                                 5.0 * math.sin(angle) + noise * random.normal(), angle)))
            for number, angle in enumerate(angles.tolist())]


def test_a_trajectory_is_written_and_read_as_it_is(tmp_path):
    path = str(tmp_path / 'a.tum')
    trajectory.save(path, circle())
    for (stamp, pose), (then, told) in zip(circle(), trajectory.load(path)):
        assert then == stamp and told[:2] == pytest.approx(pose[:2], abs=1e-6)
        assert math.cos(told.theta - pose.theta) == pytest.approx(1.0)


def test_a_trajectory_without_errors_has_none_from_wherever_it_is_seen():
    errors = trajectory.compared(circle(offset=Pose(3.0, -7.0, 2.0)), circle())
    assert errors[:5] == pytest.approx((0.0,) * 5, abs=1e-9) and errors.poses == 100


def test_errors_are_those_of_closed_forms():
    late = [(stamp, pose._replace(x=pose.x + (1.0 if stamp >= 50.0 else 0.0))) for stamp, pose in circle()]
    errors = trajectory.compared(late, circle())
    assert errors.absolute == pytest.approx(math.sqrt(0.5)) and errors.largest == pytest.approx(1.0)
    assert 0.1 < errors.aligned < errors.absolute  # a rigid movement takes a part of it
    noisy = trajectory.compared(circle(2000, noise=0.05), circle(2000))
    assert noisy.aligned == pytest.approx(0.05 * math.sqrt(2.0), rel=0.05)
    assert noisy.relative == pytest.approx(0.1, rel=0.2) and noisy.turn == pytest.approx(0.0, abs=1e-9)


def test_only_poses_of_the_same_time_are_compared():
    reference = circle()[::3]
    assert trajectory.compared(circle(), reference).poses == len(reference)
    with pytest.raises(LogError, match='the reference has 0 of the stamps'):
        trajectory.compared(circle(), [(stamp + 0.5, pose) for stamp, pose in reference])


@pytest.mark.parametrize('text, reason', [
    ('1 2 3', 'line 1: must be eight numbers'), ('# ok\n1 2 3 4 5 6 7 x', 'line 2: must be eight numbers')])
def test_a_reference_that_makes_no_sense_is_named(tmp_path, text, reason):
    path = tmp_path / 'a.tum'
    path.write_text(text)
    with pytest.raises(LogError, match=reason):
        trajectory.load(str(path))
