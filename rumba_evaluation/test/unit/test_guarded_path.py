"""A path of others that something blocks: the drive ends there, or goes around it as a mission does."""

import json

import numpy as np
import pytest
from paths import driven, rode
from rooms import RADIUS, room

from rumba_cleaning.outcome import Outcome
from rumba_evaluation.scoring.guarded import Guarded
from rumba_evaluation.trials import evaluate
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.obstacle import Obstacle
from sheets import B, W, write

LEG = 0.02  # [m] half of its side
LEGS = [(1.2, 1.17), (1.8, 1.17), (1.2, 1.65), (1.8, 1.65)]


def chair():
    """A room of 3 x 3 m with the four legs of a chair, which are further apart than a robot is wide."""
    return room(3.0, 3.0, 0.02, [(x - LEG, y - LEG, x + LEG, y + LEG) for x, y in LEGS])


def lanes(pitch=0.16):
    """A raw path: lanes to and fro that know the walls, and of the legs only that no pose lies in one."""
    rim = RADIUS + 0.01
    rows = np.arange(rim, 3.0 - rim, pitch)
    return [(x, y) for number, y in enumerate(rows) for x in (rim, 3.0 - rim)[::1 if number % 2 == 0 else -1]]


def test_a_robot_goes_around_the_edge_of_a_leg_and_on_along_the_path():
    blocked = driven(lanes(), plan=chair())
    assert (blocked.outcome, blocked.world.floor.coverage < 0.5) == (Outcome.BLOCKED, True)
    ride = rode(Guarded, lanes(), plan=chair())
    assert ride.outcome is Outcome.SUCCEEDED and not ride.meter.penetrated
    assert ride.message.startswith('the end of the path is reached, after ') and ' detours at (' in ride.message
    assert ride.world.floor.coverage > 0.9 and ride.time < 2.0 * ride.ideal_time


def test_a_path_that_nothing_blocks_is_driven_as_without_guards():
    points = [(0.5, 0.5), (2.5, 0.5), (2.5, 0.66), (0.5, 0.66)]
    free, guarded = driven(points, plan=chair()), rode(Guarded, points, plan=chair())
    assert guarded.message == free.message and guarded.time == pytest.approx(free.time, abs=0.2)
    assert guarded.world.floor.coverage == pytest.approx(free.world.floor.coverage, abs=0.001)


def test_a_robot_goes_around_what_the_map_does_not_show():
    things = [Obstacle('thing', Pose(1.5, 0.5, 0.0), 0.3, 0.1)]
    points = [(0.5, 0.5), (2.5, 0.5)]
    assert driven(points, plan=room(3.0, 3.0), obstacles=things).outcome is Outcome.BLOCKED
    ride = rode(Guarded, points, plan=room(3.0, 3.0), obstacles=things)
    assert ride.outcome is Outcome.SUCCEEDED and ride.robot.pose.x == pytest.approx(2.5, abs=0.05)


def test_a_robot_keeps_off_a_cliff_to_which_a_path_leads():
    points, plan = [(0.5, 0.5), (0.5, 2.5), (2.5, 2.5)], room(3.0, 3.0, cliff=(0.0, 1.2, 0.9, 1.8))
    assert driven(points, plan=plan).outcome is Outcome.FALLEN
    ride = rode(Guarded, points, plan=plan)
    assert (ride.outcome, ride.robot.has_fallen) == (Outcome.SUCCEEDED, False)


def test_a_path_whose_rest_cannot_be_reached_says_so():
    plan = room(4.0, 2.0, boxes=[(1.9, 0.0, 2.1, 2.0)])
    ride = rode(Guarded, [(0.5, 1.0), (1.8, 1.0), (2.2, 1.0), (3.5, 1.0)], plan=plan)
    assert ride.outcome is Outcome.BLOCKED
    assert ride.message.startswith('no way leads around what keeps the robot from the rest of the path at (1.')


def test_the_command_says_that_a_path_was_guarded(tmp_path, capsys):
    pixels = np.full((62, 62), B, np.uint8)
    pixels[1:-1, 1:-1] = W
    pixels[30:32, 30:32] = B
    path = write(tmp_path, pixels, resolution=0.05, origin=[-0.05, -0.05, 0.0], start=[0.5, 0.5, 0.0])
    (tmp_path / 'path.csv').write_text('x,y\n0.5,1.45\n2.5,1.45\n')
    arguments = ['--path', str(tmp_path / 'path.csv'), '--maps', path, '--format', 'json']
    for more, outcome in (([], 'blocked'), (['--guarded'], 'succeeded')):
        assert evaluate.main([*arguments, *more]) == 0
        found = json.loads(capsys.readouterr().out)
        assert (found['guarded'], found['outcome']) == (bool(more), outcome)
    assert evaluate.main([*arguments, '--guarded', '--as-drawn']) == 2
    assert capsys.readouterr().err == 'evaluate: --as-drawn and --guarded exclude each other: give one of them\n'


def test_a_path_that_ends_beside_a_wall_is_driven_as_far_as_a_robot_can_stand():
    ride = rode(Guarded, [(0.5, 0.5), (2.5, 0.5), (2.95, 0.5)], plan=room(3.0, 3.0))
    assert ride.outcome is Outcome.SUCCEEDED
    assert ride.message.startswith('a robot can stand nowhere on the rest of the path at (2.8')
