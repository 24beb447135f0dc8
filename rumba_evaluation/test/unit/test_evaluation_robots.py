"""The command evaluate: robots that a file describes, and what people are told before missions begin."""

import csv
import re

import numpy as np
import pytest
from evaluations import register_simple_strategies, small_map
from sheets import B, W, write

from rumba_evaluation.trials import evaluate


@pytest.fixture
def run(tmp_path, capsys, monkeypatch):
    """A function that runs the command on a small map, and returns exit code, output and errors."""
    register_simple_strategies(monkeypatch)
    path = small_map(tmp_path)

    def run(*arguments):
        code = evaluate.main(['--maps', path, '--strategies', 'turn', '--seeds', '2', '--bound', '0.2', '--jobs', '1',
                              '--no-plots', '--output', str(tmp_path / 'out'), *arguments])
        captured = capsys.readouterr()
        return code, captured.out, captured.err
    return run


def test_robots_are_as_a_file_says(run, tmp_path):
    (tmp_path / 'slow.yaml').write_text('drive: {radius: 0.105, max_speed: 0.15}\nbrush: {width: 0.1}\n')
    code, _, errors = run('--robot', str(tmp_path / 'slow.yaml'))
    assert (code, errors) == (0, 'evaluate: the cleaning speed is 0.3 m/s, and drive/max_speed 0.15: the robot cleans '
                                 'at 0.15 m/s\n')
    with open(tmp_path / 'out' / 'results.csv') as file:
        rows = list(csv.DictReader(file))
    for row in rows:  # T is for the floor that so small a robot reaches, at the speed that it can drive
        assert row['robot'] == str(tmp_path / 'slow.yaml')
        assert float(row['area']) == pytest.approx(1.39 * 0.89, rel=0.02)
        assert float(row['ideal_time']) == pytest.approx(float(row['area']) / (0.1 * 0.15))


def test_a_robot_that_has_to_creep_is_told(run, tmp_path):
    (tmp_path / 'wide.yaml').write_text('drive: {wheel_base: 0.32}\n')
    code, _, errors = run('--robot', str(tmp_path / 'wide.yaml'))
    assert code == 0 and errors.count('\n') == 1
    assert errors.startswith('evaluate: drive/wheel_base is 0.32 m and cliff/distance 0.165 m: no cliff sensor sees')


@pytest.mark.parametrize('content, message', [
    ('drive: {radios: 0.1}', ': drive/radios is unknown: did you mean .radius.'),
    ('drive: {max_speed: 0}', ': drive/max_speed is 0.0: must be 0.01 to 10'),
    ('speed: 10', ': speed is unknown: known are drive, odometry'),
    ('drive: [', ', line 1: is not valid YAML'), (None, ': No such file or directory')])
def test_a_bad_file_of_robots_is_one_line(run, tmp_path, content, message):
    path = tmp_path / 'robot.yaml'
    if content is not None:
        path.write_text(content)
    code, output, errors = run('--robot', str(path))
    assert (code, output, errors.count('\n')) == (2, '', 1) and re.match(f'evaluate: {path}{message}', errors)


def test_what_is_odd_about_a_map_is_told_before_the_missions(run, tmp_path):
    pixels = np.full((42, 62), W, np.uint8)
    pixels[:, 20] = pixels[[0, -1]] = pixels[:, [0, -1]] = B
    write(tmp_path, pixels, resolution=0.05, origin=[-0.05, -0.05, 0.0], map_type='occupancy')
    code, _, errors = run('--drain', '1000')
    first, second, third = errors.splitlines()
    assert code == 0 and first.endswith("flat.yaml: unknown keys are ignored: 'map_type'")
    assert 'is out of reach of the start at (' in second
    assert 'the map has no dock, and 3 m² take about ' in third and 'place_dock' in third
