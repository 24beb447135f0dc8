"""The command evaluate: the missions that it runs, the files that it writes, and its error messages."""

import csv
import itertools
import os
import re
import subprocess
import sys
import time

import numpy as np
import pytest
from evaluations import register_simple_strategies, small_map
from sheets import write

from rumba_evaluation.trials import batch, evaluate
from rumba_evaluation.trials.results import Results
from rumba_sim.model.common.errors import MapError


@pytest.fixture(autouse=True)
def _simple_strategies(monkeypatch):
    register_simple_strategies(monkeypatch)


@pytest.fixture
def run(tmp_path, capsys):
    """A function that runs the command on a small map, and returns exit code, output and errors."""
    path = small_map(tmp_path)

    def find(name):
        if name != 'small':
            raise MapError(f'there is no map {name!r}')
        return path

    def run(*arguments, plots=False):
        defaults = {'--maps': 'small', '--strategies': 'turn', '--seeds': '2', '--bound': '0.2', '--jobs': '1',
                    '--output': str(tmp_path / 'out')}
        given = [word for pair in defaults.items() if pair[0] not in arguments for word in pair]
        try:
            code = evaluate.main([*given, *arguments] + ['--no-plots'] * (not plots), find)
        except SystemExit as end:
            code = end.code
        captured = capsys.readouterr()
        return code, captured.out, captured.err
    return run


def rows(folder):
    """The rows of the file of results, in the order of writing."""
    with open(folder / 'out' / 'results.csv') as file:
        return list(csv.DictReader(file))


def lines(folder):
    """The lines of the file of results, sorted."""
    return sorted((folder / 'out' / 'results.csv').read_text().splitlines())


def test_every_case_is_run_and_in_the_table(run, tmp_path):
    code, output, errors = run('--strategies', 'turn', 'give_up', '--robots', '1', '2', '--bound', '3')
    assert (code, errors) == (0, '')
    assert [line.split()[:4] for line in output.splitlines()[2:6]] == [
        ['small', 'turn', '1', '2'], ['small', 'turn', '2', '2'],
        ['small', 'give_up', '1', '2'], ['small', 'give_up', '2', '2']]
    assert output == (tmp_path / 'out' / 'table.txt').read_text()
    assert sorted((row['strategy'], row['robots'], row['seed']) for row in rows(tmp_path)) == sorted(
        itertools.product(('turn', 'give_up'), '12', '12'))
    assert {(row['strategy'], row['outcome']) for row in rows(tmp_path) if row['robots'] == '1'} == {
        ('give_up', 'failed'), ('turn', 'timed_out')}
    for line, end in zip(output.splitlines()[2:6], 2 * ['2 timed out'] + 2 * ['2 failed']):
        assert line.endswith(f' {end}')
    assert sorted(path.name for path in (tmp_path / 'out').glob('[!.]*')) == [
        'coverage.csv', 'results.csv', 'table.txt']


def test_a_mission_cleans_the_room_and_is_drawn(run, tmp_path):
    code, output, errors = run('--strategies', 'boustrophedon', '--bound', '5', '--seeds', '7-7', '--target', '0.98',
                               plots=True)
    assert (code, errors) == (0, '')
    [row] = rows(tmp_path)
    assert (row['outcome'], row['docked'], row['penetrated'], row['seed']) == ('succeeded', '1', 'False', '7')
    assert float(row['to_98_T']) < 3.0 and float(row['coverage']) > 0.98
    assert sorted(path.name for path in (tmp_path / 'out').glob('*.png')) == [
        'coverage_small.png', 'path_small_boustrophedon_1.png', 'times.png']
    assert (tmp_path / 'out' / 'coverage.csv').read_text().count('\n') == len(row['curve'].split()) + 1 > 98


def test_results_do_not_depend_on_the_number_of_workers(run, tmp_path):
    arguments = ('--strategies', 'bounce', 'ahead', '--seeds', '4', '--start', 'anywhere', '--bound', '1')
    _, first, _ = run(*arguments)
    alone = lines(tmp_path)
    (tmp_path / 'out' / 'results.csv').unlink()
    _, second, _ = run(*arguments, '--jobs', '2')
    assert lines(tmp_path) == alone and first == second and len(set(alone)) == 9


def test_an_interrupted_run_goes_on(run, tmp_path):
    arguments = ('--strategies', 'bounce', '--seeds', '4')
    _, whole, _ = run(*arguments)
    path, before = tmp_path / 'out' / 'results.csv', lines(tmp_path)
    path.write_bytes(path.read_bytes()[:-40])
    code, output, errors = run(*arguments)
    assert (code, output, lines(tmp_path)) == (0, whole, before)
    assert errors == f'evaluate: 3 of 4 missions are in {path} already; to run them again, delete it or choose ' \
                     'another --output\n'


@pytest.fixture
def other(tmp_path):
    """Another evaluate in the same folder, which waits for ever in its third mission."""
    (tmp_path / 'held.py').write_text(
        'import time\nfrom simple_strategies import Wait\nfrom rumba_cleaning.strategies import strategy\n\n'
        '@strategy("hold")\nclass Hold(Wait):\n    def update(self, observation):\n        time.sleep(600.0)\n')
    script = 'import sys; from rumba_evaluation.trials import evaluate; sys.exit(evaluate.main(sys.argv[1:], str))'
    folder = tmp_path / 'out'
    with subprocess.Popen(
            [sys.executable, '-c', script, '--maps', small_map(tmp_path), '--strategies', 'turn', 'hold', '--import',
             'held', '--seeds', '2', '--bound', '0.2', '--jobs', '1', '--no-plots', '--output', str(folder)],
            env={**os.environ, 'PYTHONPATH': os.pathsep.join([str(tmp_path), *sys.path])}) as process:
        end = time.monotonic() + 60.0
        while not (folder / 'results.csv').exists() or len(lines(tmp_path)) < 3:
            assert process.poll() is None and time.monotonic() < end
            time.sleep(0.01)
        yield process
        process.kill()


def test_a_second_evaluate_in_one_folder_is_refused_until_the_first_has_ended_or_was_killed(run, tmp_path, other):
    folder, before = tmp_path / 'out', lines(tmp_path)
    assert run() == (2, '', f'evaluate: {folder}: another evaluate writes its results there: wait until it has ended, '
                            'or choose another --output\n')
    assert lines(tmp_path) == before
    other.kill()
    other.wait()
    with open(folder / 'results.csv', 'a') as file:
        file.write('small,turn,2')  # killed in the middle of a row
    assert run()[0] == 0
    assert sorted((row['map'], row['seed']) for row in rows(tmp_path)) == sorted(
        itertools.product(('small', small_map(tmp_path)), '12'))


def test_results_of_other_cases_stay_in_the_file_and_out_of_the_table(run, tmp_path):
    run('--seeds', '3')
    _, output, _ = run('--seeds', '2-2')
    assert len(rows(tmp_path)) == 3 and output.splitlines()[2].split()[3] == '1'


def test_ctrl_c_keeps_the_results_and_says_how_to_go_on(run, tmp_path, monkeypatch):
    add = Results.add

    def add_and_stop(results, case, result):
        add(results, case, result)
        raise KeyboardInterrupt
    monkeypatch.setattr(Results, 'add', add_and_stop)
    code, output, errors = run('--seeds', '5')
    assert (code, output) == (130, '')
    assert errors == f'evaluate: stopped; 1 of 5 missions are in {tmp_path / "out" / "results.csv"}; the same ' \
                     'command goes on from there\n'
    monkeypatch.setattr(Results, 'add', add)
    code, _, errors = run('--seeds', '5')
    assert code == 0 and len(rows(tmp_path)) == 5 and errors.startswith('evaluate: 1 of 5 missions are in')


def test_ctrl_c_before_the_first_mission_gives_one_line(run, monkeypatch):
    def stop(*_):
        raise KeyboardInterrupt
    monkeypatch.setattr(evaluate, '_jobs', stop)
    assert run() == (130, '', 'evaluate: stopped before the first mission\n')


def test_the_results_are_kept_if_a_worker_dies(run):
    code, output, errors = run('--strategies', 'turn', 'die', '--seeds', '1')
    assert (code, output) == (1, '')
    assert re.fullmatch(r'evaluate: the workers have died, perhaps for lack of memory \(.*\); 1 of 2 missions are '
                        r'in .*; the same command, perhaps with fewer --jobs, goes on from there\n', errors)


def test_a_full_disk_gives_one_line(run, monkeypatch):
    def fail(*_):
        raise OSError(28, 'No space left on device', 'results.csv')
    monkeypatch.setattr(Results, 'add', fail)
    assert run() == (1, '', "evaluate: [Errno 28] No space left on device: 'results.csv'\n")


def test_an_exception_of_a_strategy_is_reported_and_the_others_go_on(run, tmp_path):
    code, output, errors = run('--strategies', 'crash', 'turn', '--seeds', '1')
    assert code == 1
    assert re.fullmatch(r'evaluate: crash raised an exception on small, seed 1, robots 1: ZeroDivisionError: '
                        r'division by zero \(simple_strategies.py:\d+\)\n', errors)
    assert {row['strategy']: row['outcome'] for row in rows(tmp_path)} == {'crash': 'error', 'turn': 'timed_out'}


def test_a_strategy_that_exits_is_reported_and_the_others_go_on(run, tmp_path):
    code, _, errors = run('--strategies', 'quit', 'turn', '--seeds', '1')
    assert code == 1
    assert re.fullmatch(r'evaluate: quit raised an exception on small, .*: SystemExit: 3 '
                        r'\(simple_strategies.py:\d+\)\n', errors)
    assert {row['strategy']: row['outcome'] for row in rows(tmp_path)} == {'quit': 'error', 'turn': 'timed_out'}


@pytest.mark.parametrize('code, message', [
    ('nonsense\n', 'NameError: name .nonsense. is not defined'), ('import sys\nsys.exit(7)\n', 'SystemExit: 7'),
    ('1 / 0\n', 'ZeroDivisionError: division by zero')])
def test_a_module_that_cannot_be_imported_gives_one_line(run, tmp_path, monkeypatch, code, message):
    (tmp_path / 'broken.py').write_text(code)
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, 'broken', raising=False)
    exit_code, output, errors = run('--import', 'broken')
    assert (exit_code, output) == (2, '')
    assert re.fullmatch(rf"evaluate: strategies of 'broken': {message} \(broken.py:\d\)\n", errors)


@pytest.mark.parametrize('arguments', [('--strategies', 'unmakable'), ('--strategies', 'unmakable', 'turn')])
def test_a_strategy_that_cannot_be_made_gives_one_line(run, arguments):
    code, output, errors = run(*arguments)
    assert (code, output) == (2, '')
    assert re.fullmatch(r"evaluate: unmakable cannot be made on small: KeyError: 'nothing' "
                        r'\(simple_strategies.py:\d+\)\n', errors)


def test_strategies_of_other_packages_are_imported(run, tmp_path, monkeypatch):
    (tmp_path / 'my_strategies.py').write_text(
        'from simple_strategies import Wait\nfrom rumba_cleaning.strategies import strategy\nstrategy("mine")(Wait)\n')
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, 'my_strategies', raising=False)
    assert run('--strategies', 'mine', '--import', 'my_strategies')[0] == 0


@pytest.mark.parametrize('arguments, message', [
    (('--strategies', 'tidy', 'turn'), "unknown strategy 'tidy': known are ahead, bounce, boustrophedon, crash"),
    (('--maps', 'moon'), "there is no map 'moon'"),
    (('--seeds', 'many'), "argument --seeds: 'many' must be a number of seeds, as in 10, or the first and the last"),
    (('--seeds', '9-3'), "argument --seeds: '9-3' must be"), (('--seeds', '0'), "argument --seeds: '0' must be"),
    (('--robots', '0'), "argument --robots: '0' must be a whole number, 1 or more"),
    (('--robots', '40'), 'flat.yaml: no room for another robot'),
    (('--jobs', '-1'), "argument --jobs: '-1' must be a whole number"),
    (('--target', '1.5'), 'target is 1.5: must be 0 to 1'), (('--target', 'nan'), 'target is nan: must be 0 to 1'),
    (('--target', 'all'), "argument --target: invalid float value: 'all'"),
    (('--bound', '0'), 'bound is 0.0: must be 0.01 to 1000000'), (('--drain', '-1'), 'drain is -1.0: must be 0 to'),
    (('--start', 'here'), "argument --start: invalid choice: 'here'"),
    (('--output', '/proc/none'), '/proc/none: .*: --output must be a writable folder'),
    (('--import', 'nowhere'), "strategies of 'nowhere': No module named 'nowhere'"),
    (('--sedes', '3'), 'unrecognized arguments: --sedes 3')])
def test_bad_input_gives_one_line_and_nothing_is_written(run, tmp_path, arguments, message):
    code, output, errors = run(*arguments)
    assert (code, output) == (2, '') and not (tmp_path / 'out').exists()
    assert re.match(f'evaluate: .*{re.escape(message) if ".*" not in message else message}', errors), errors
    assert errors.count('\n') == 1


def test_missions_among_obstacles_begin_beside_them_and_a_wrong_file_is_one_line(run, tmp_path):
    good, bad = tmp_path / 'good.yaml', tmp_path / 'bad.yaml'
    good.write_text('bin: {pose: [0.5, 0.5], radius: 0.1, height: 0.3}\n')
    bad.write_text('bin: {pose: [0.5, 0.5], radus: 0.1, height: 0.3}\n')
    code, _, errors = run('--strategies', 'turn', '--obstacles', str(good), '--laser', '--start', 'anywhere',
                          '--bound', '0.5', '--laser-model', 'lds01')
    assert (code, errors) == (0, '')
    for row in rows(tmp_path):
        assert (row['obstacles'], row['laser'], row['penetrated']) == (str(good), 'True', 'False')
        assert row['laser_model'] == 'lds01'
        assert np.hypot(float(row['x']) - 0.5, float(row['y']) - 0.5) > 0.27
    assert run('--obstacles', str(bad)) == (
        2, '', f"evaluate: {bad}: bin/radus is unknown: did you mean 'radius'?\n")


def test_a_map_without_free_floor_is_refused(run, tmp_path):
    write(tmp_path, np.zeros((9, 9), np.uint8))
    batch.floor_plan.cache_clear()
    code, _, errors = run()
    assert code == 2 and re.fullmatch('evaluate: .*flat.yaml: no free floor: every cell is wall or unknown\n', errors)


@pytest.mark.parametrize('arguments, code, output, errors', [
    (('--no-plots',), 0, 'Working time to coverage', ''),
    ((), 2, '', r"evaluate: pictures need matplotlib \(.*\): install the package python3-matplotlib "
                r'\(with pip: matplotlib\), or give --no-plots\n')])
def test_only_pictures_need_matplotlib(tmp_path, arguments, code, output, errors):
    script = ('import sys; sys.modules["matplotlib"] = None; from rumba_evaluation.trials import evaluate; '
              'sys.exit(evaluate.main(sys.argv[1:], str))')
    done = subprocess.run(
        [sys.executable, '-c', script, '--maps', small_map(tmp_path), '--strategies', 'bounce', '--seeds', '1',
         '--bound', '0.1', '--jobs', '1', '--output', str(tmp_path / 'out'), *arguments],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True,
        env={**os.environ, 'PYTHONPATH': os.pathsep.join(sys.path)})
    assert done.returncode == code and done.stdout.startswith(output)
    assert re.fullmatch(errors, done.stderr) and (tmp_path / 'out').exists() == (code == 0)


def test_help_names_every_option(run):
    code, output, _ = run('--help')
    assert code == 0
    for option in ('maps', 'strategies', 'seeds', 'robots', 'start', 'drain', 'target', 'bound', 'import', 'output',
                   'jobs', 'scheduler', 'no-plots'):
        assert f'--{option}' in output
