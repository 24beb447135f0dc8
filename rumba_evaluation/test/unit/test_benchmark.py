"""rumba-benchmark: its floors, the table of strategies and of planners of others, what it refuses."""

import json
import pathlib

import pytest

from rumba_evaluation.trials import benchmark, floors
from rumba_sim.model.floors.sweep import Sweep
from rumba_sim.model.maps import map_file
from rumba_sim.model.settings.robot_config import RobotConfig

AREAS = {'bare': 20.0, 'lounge': 20.0, 'rooms': 45.0, 'loft': 33.0, 'narrows': 24.0}  # [m^2] with what stands there


@pytest.fixture(scope='module')
def maps(tmp_path_factory):
    """The path of each floor by its name."""
    return benchmark.draw(tmp_path_factory.mktemp('floors'))


@pytest.mark.parametrize('name', floors.FLOORS)
def test_a_robot_reaches_all_parts_of_a_floor_from_its_dock(maps, name):
    plan = map_file.load(maps[name])
    plan.check_pose(plan.dock, RobotConfig().drive.radius, 'dock')
    sweep = Sweep(plan.refined(), RobotConfig())
    sweep.begin(plan.dock.x, plan.dock.y)
    assert 0.65 * AREAS[name] < sweep.reachable_area < AREAS[name]


def test_the_floors_are_the_same_each_time(maps, tmp_path):
    for name, path in benchmark.draw(tmp_path).items():
        for ending in ('.yaml', '.png'):
            assert pathlib.Path(path).with_suffix(ending).read_bytes() == pathlib.Path(maps[name]).with_suffix(
                ending).read_bytes()


@pytest.fixture
def planners(tmp_path):
    """A folder with the paths of a planner on one of the floors."""
    folder = tmp_path / 'planners' / 'mine'
    folder.mkdir(parents=True)
    (folder / 'bare.csv').write_text('x,y\n0.5,0.5\n3.5,0.5\n3.5,0.65\n0.5,0.65\n')
    return folder


def test_a_planner_and_a_strategy_stand_in_one_table(tmp_path, planners, capsys, monkeypatch):
    monkeypatch.setattr(benchmark, 'BOUND', 0.05)
    monkeypatch.setattr(benchmark, 'FLOORS', {'bare': floors.bare, 'narrows': floors.narrows})
    arguments = [str(tmp_path), '--strategies', 'bounce', '--seeds', '2', '--jobs', '1',
                 '--paths', str(planners.parent)]
    assert benchmark.main(arguments) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[:4] for line in lines[2:5]] == [
        ['bare', 'bounce', '1', '2'], ['bare', 'mine', '1', '1'], ['narrows', 'bounce', '1', '2']]
    assert 'collisions  near misses' in lines[7]
    assert benchmark.main([*arguments, '--format', 'json']) == 0
    drives = json.loads(capsys.readouterr().out)['drives']
    assert [(drive['map'], drive['strategy'], drive['seed']) for drive in drives] == [
        ('bare', 'bounce', 1), ('bare', 'bounce', 2), ('bare', 'mine', 0), ('narrows', 'bounce', 1),
        ('narrows', 'bounce', 2)]
    assert all(drive['outcome'] == 'timed_out' for drive in drives)


def test_a_mission_that_is_looked_at_in_each_tick_is_the_same_mission(maps):
    task = benchmark.Task(benchmark.Case('bare', 'bounce', 1, 1), maps['bare'], '', False)
    job = benchmark.batch.Job(task.case, benchmark.Conditions(bound=benchmark.BOUND), maps['bare'], '')
    trial = benchmark.batch.prepare(job)
    for _ in range(100):
        trial.step()
    watched = benchmark.batch.prepare(job)
    observer = benchmark.Observer(watched.world, watched.world.robots['rumba'])
    watched.advance = observer.advance
    for _ in range(100):
        watched.step()
    assert watched.result() == trial.result()
    assert observer.measures().path_length == pytest.approx(trial.result().distance)


def test_what_is_refused(tmp_path, planners, capsys):
    (planners / 'moon.csv').write_text('x,y\n')
    for arguments, message in (
            (['--paths', str(planners.parent)], "moon.csv: there is no floor 'moon': floors are bare, lounge, "),
            (['--paths', str(planners)], 'has no path: must be as PLANNER/bare.csv'),
            (['--paths', str(tmp_path / 'none')], 'No such file or directory'),
            (['--strategies', 'boun'], "unknown strategy 'boun'")):
        assert benchmark.main([str(tmp_path), *arguments]) == 2
        captured = capsys.readouterr()
        assert (captured.out, captured.err.count('\n')) == ('', 1) and message in captured.err
