"""Loops that must close, and places that are like others."""

import functools
import math

import numpy as np
import pytest
from rooms import room
from scans import BLIND, error
from test_mapper import drive, off_walls, reckoned, scan, world_of

from rumba_localisation.mapping.believed_plan import believed_plan
from rumba_localisation.mapping.findings import Findings
from rumba_localisation.mapping.key_frames import KeyFrames
from rumba_localisation.mapping.loop_closure import LoopClosure
from rumba_localisation.mapping.mapper import Mapper
from rumba_localisation.noise import Noise
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import RobotConfig

START = Pose(1.0, 1.0, 0.0)
ROUGH = np.diag([0.1, 0.1, 0.02]) ** 2  # covariance of a step


def ring():
    """Corridors around a block: on the lower one the laser sees neither end for 8 m, on the upper one are pillars."""
    pillars = [(x, 7.7, x + 0.4, 8.0) for x in (4.0, 8.0, 12.0, 16.0, 20.0)]
    return room(26.0, 8.0, boxes=[(2.0, 2.0, 24.0, 6.0), *pillars])


class Recorder:
    """Stands for a mapper, and keeps what it was told."""

    def __init__(self):
        """Have been told nothing."""
        self.told = []

    def observe(self, odometry, seen):
        """Keep an observation."""
        self.told.append((odometry, seen))


@functools.lru_cache(maxsize=None)
def drive_around():
    """What a robot is told on its way around the ring, and where it is each time."""
    world, recorder, poses = world_of(ring(), START, seed=2), Recorder(), [START]
    recorder.observe(world.robots['rumba'].odometry, scan(world))
    for _ in drive(world, recorder, [(25.0, 1.0), (25.0, 7.0), (1.0, 7.0), (1.0, 1.0), (4.0, 1.0)]):
        poses.append(world.robots['rumba'].pose)
    assert error(reckoned(world, START), poses[-1])[0] > 3.0
    return recorder.told, poses


def mapped():
    """The map of this drive."""
    mapper = Mapper(START)
    for odometry, seen in drive_around()[0]:
        mapper.observe(odometry, seen)
    return mapper


@functools.lru_cache(maxsize=None)
def closed_map():
    """The same map, for tests that only look at it."""
    return mapped()


@pytest.mark.thorough
def test_a_loop_that_comes_back_with_a_large_error_closes(monkeypatch):
    closed = closed_map()
    monkeypatch.setattr(LoopClosure, 'closes', lambda *_: False)
    broken = mapped()
    (*_, (odometry, _)), (*_, true) = drive_around()
    assert closed.redrawn == 1 and broken.redrawn == 0
    assert off_walls(broken, ring()).max() > 0.2 and error(broken.pose(odometry), true)[0] > 0.15
    assert off_walls(closed, ring()).max() < 0.13 and error(closed.pose(odometry), true)[0] < 0.03


@pytest.mark.thorough
def test_the_same_scans_close_a_loop_in_the_same_way():
    one, other = closed_map(), mapped()
    assert one.correction == other.correction and one.version == other.version
    assert (one.grid.odds == other.grid.odds).all() and (one.grid.field == other.grid.field).all()


@pytest.mark.thorough
def test_a_redrawn_map_has_its_cells_where_those_of_the_map_before_were():
    mapper, versions, origins = Mapper(START), [], []
    for odometry, seen in drive_around()[0]:
        mapper.observe(odometry, seen)
        versions.append(mapper.version)
        origins.append(believed_plan(mapper.grid, 'map').origin if mapper.redrawn else None)
        if mapper.redrawn:
            break
    assert versions[-1] == versions[-2] + 2  # one for the scan, one for the map
    cells = np.array(origins[-1]) / mapper.grid.resolution
    assert cells == pytest.approx(np.rint(cells), abs=1e-6)
    assert mapper.moved(START) == pytest.approx(START, abs=1e-6)  # as a dock from which it began
    assert mapper.estimate.pose == pytest.approx(mapper.pose(odometry))


@pytest.mark.thorough
def test_a_robot_that_is_carried_away_on_its_way_does_not_bend_the_map():
    plan, start = room(10.0, 8.0, boxes=[(1.6, 1.6, 8.4, 6.4), (4.0, 0.0, 4.4, 0.3)]), Pose(0.8, 0.8, 0.0)
    world, mapper = world_of(plan, start, seed=3), Mapper(start)
    for _ in drive(world, mapper, [(9.2, 0.8), (9.2, 7.2), (4.0, 7.2)]):
        pass
    world.teleport('rumba', Pose(6.0, 0.8, 2.0))
    for _ in drive(world, mapper, [(0.8, 0.8), (0.8, 7.2), (5.0, 7.2)]):
        pass
    robot = world.robots['rumba']
    assert mapper.estimate.is_sure and error(mapper.pose(robot.odometry), robot.pose)[0] < 0.1
    assert off_walls(mapper, plan).max() <= 0.15


def frames_at(plan, poses, offset):
    """Key frames along a way, the last of which errs; and where its beams end."""
    frames = KeyFrames()
    for number, true in enumerate(poses):
        pose = true if number < len(poses) - 1 else Pose(true.x + offset[0], true.y + offset[1], true.theta)
        seen = scan(world_of(plan, true))
        frames.add(pose, seen)
        if number:
            frames.link(number - 1, number, pose, ROUGH)
    return frames, seen


def there_and_back(y, x):
    """Poses at the place x of a corridor, far away, and at x again, 0.4 m on."""
    near = [Pose(x + by, y, 0.0) for by in (-1.0, -0.5, 0.0, 0.5)]
    return [*near, Pose(x + 8.0, y, 0.0), Pose(x + 0.2, y, 3.0)]


def tell(plan, offset):
    """What the closure makes of a frame that errs by an offset [m], and then of one 0.5 m on that errs alike."""
    poses = there_and_back(1.0, 15.0)
    frames, seen = frames_at(plan, poses, offset)
    closure = LoopClosure(frames, Noise(0.01))
    first = closure.closes(len(poses) - 1, seen, 0.02)
    true = Pose(14.7, 1.0, 3.1)
    seen = scan(world_of(plan, true))
    number = frames.add(Pose(true.x + offset[0], true.y + offset[1], true.theta), seen)
    frames.link(number - 1, number, frames.poses[number], ROUGH)
    return first, closure.closes(number, seen, 0.02), frames


def corridor(*boxes):
    """A long corridor whose ends are out of sight."""
    return room(40.0, 2.0, boxes=boxes)


def test_two_scans_that_agree_close_a_loop_and_the_frames_move():
    first, second, frames = tell(corridor((14.0, 0.0, 14.4, 0.3), (16.5, 1.6, 17.0, 2.0)), (0.35, -0.1))
    assert (first, second) == (False, True)
    frames.optimise()
    assert frames.poses[-1] == pytest.approx(Pose(14.7, 1.0, 3.1), abs=0.02)
    assert frames.poses[0] == pytest.approx(Pose(14.0, 1.0, 0.0))


@pytest.mark.parametrize('boxes', [
    (),
    [(x, 0.0, x + 0.3, 0.3) for x in np.arange(4.0, 36.0, 0.6)]], ids=['bare', 'a pillar every 0.6 m'])
def test_a_corridor_in_which_places_are_alike_is_not_closed(boxes):
    first, second, _ = tell(corridor(*boxes), (0.35, 0.0))
    assert not first and not second


def test_a_small_error_links_frames_and_moves_none():
    first, second, frames = tell(corridor((14.0, 0.0, 14.4, 0.3), (16.5, 1.6, 17.0, 2.0)), (0.01, 0.01))
    assert not first and not second
    assert frames.ways(len(frames.poses) - 1).lengths[3] < 2.0


def test_a_scan_without_echoes_closes_nothing():
    frames, _ = frames_at(corridor(), there_and_back(1.0, 15.0), (0.0, 0.0))
    assert not LoopClosure(frames, Noise()).closes(5, BLIND, 0.02)


def test_what_bumper_and_cliffs_found_moves_with_the_map():
    findings = Findings(RobotConfig())
    findings.touched, findings.cliffs = [(1.0, 2.0)], [(3.0, -1.0), (0.0, 0.0)]
    findings.move(lambda pose: Pose(pose.x + 0.5, 2.0 * pose.y, pose.theta))
    assert findings.touched == [(1.5, 4.0)] and findings.cliffs == [(3.5, -2.0), (0.5, 0.0)]
    assert findings.version == 3 and math.isfinite(findings.touched[0][0])
