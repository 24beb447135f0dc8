"""The command evaluate: what it runs, what it leaves in its folder, and what it says where that cannot be."""

import csv
import itertools
import re
import sys

import numpy as np
import pytest
from evaluations import know_manners, small_map
from sheets import write

from rumba_evaluation.trials import batch, evaluate
from rumba_evaluation.trials.results import Results
from rumba_sim.model.errors import MapError


@pytest.fixture(autouse=True)
def _manners(monkeypatch):
    know_manners(monkeypatch)


@pytest.fixture
def run(tmp_path, capsys):
    """Runs the command on a small map; returns exit code, output and errors."""
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
    """The rows of the file of results, in order of time."""
    with open(folder / 'out' / 'results.csv') as file:
        return list(csv.DictReader(file))


def lines(folder):
    """The lines of the file of results, sorted."""
    return sorted((folder / 'out' / 'results.csv').read_text().splitlines())


def test_every_case_is_run_and_told(run, tmp_path):
    code, output, errors = run('--strategies', 'turn', 'give_up', '--robots', '1', '2', '--bound', '3')
    assert (code, errors) == (0, '')
    assert [line.split()[:4] for line in output.splitlines()[2:6]] == [
        ['small', 'turn', '1', '2'], ['small', 'turn', '2', '2'],
        ['small', 'give_up', '1', '2'], ['small', 'give_up', '2', '2']]
    assert output == (tmp_path / 'out' / 'table.txt').read_text()
    assert sorted((row['strategy'], row['robots'], row['seed']) for row in rows(tmp_path)) == sorted(
        itertools.product(('turn', 'give_up'), '12', '12'))
    assert {(row['strategy'], row['outcome']) for row in rows(tmp_path) if row['robots'] == '1'} == {
        ('give_up', 'failed'), ('turn', 'time out')}
    assert sorted(path.name for path in (tmp_path / 'out').iterdir()) == ['coverage.csv', 'results.csv', 'table.txt']


def test_a_mission_cleans_the_room_and_is_drawn(run, tmp_path):
    code, output, errors = run('--strategies', 'boustrophedon', '--bound', '5', '--seeds', '7-7', plots=True)
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


def test_a_run_that_was_cut_short_goes_on(run, tmp_path):
    arguments = ('--strategies', 'bounce', '--seeds', '4')
    _, whole, _ = run(*arguments)
    path, before = tmp_path / 'out' / 'results.csv', lines(tmp_path)
    path.write_bytes(path.read_bytes()[:-40])
    code, output, errors = run(*arguments)
    assert (code, output, lines(tmp_path)) == (0, whole, before)
    assert errors == f'evaluate: 3 of 4 missions are in {path} already; to run them again, delete it or give another ' \
                     '--output\n'


def test_results_of_other_cases_stay_in_the_file_and_out_of_the_table(run, tmp_path):
    run('--seeds', '3')
    _, output, _ = run('--seeds', '2-2')
    assert len(rows(tmp_path)) == 3 and output.splitlines()[2].split()[3] == '1'


def test_ctrl_c_keeps_what_is_done_and_says_how_to_go_on(run, tmp_path, monkeypatch):
    add = Results.add

    def add_and_stop(results, case, result):
        add(results, case, result)
        raise KeyboardInterrupt
    monkeypatch.setattr(Results, 'add', add_and_stop)
    code, output, errors = run('--seeds', '5')
    assert (code, output) == (130, '')
    assert errors == f'evaluate: stopped; 1 of 5 missions are in {tmp_path / "out" / "results.csv"}; the same ' \
                     'command again goes on from there\n'
    monkeypatch.setattr(Results, 'add', add)
    code, _, errors = run('--seeds', '5')
    assert code == 0 and len(rows(tmp_path)) == 5 and errors.startswith('evaluate: 1 of 5 missions are in')


def test_ctrl_c_before_the_first_mission_is_no_traceback(run, monkeypatch):
    def stop(*_):
        raise KeyboardInterrupt
    monkeypatch.setattr(evaluate, '_jobs', stop)
    assert run() == (130, '', 'evaluate: stopped before the first mission\n')


def test_a_worker_that_dies_does_not_take_the_results_along(run):
    code, output, errors = run('--strategies', 'turn', 'die', '--seeds', '1')
    assert (code, output) == (1, '')
    assert re.fullmatch(r'evaluate: the workers are gone, perhaps for lack of memory \(.*\); 1 of 2 missions are '
                        r'in .*; the same command again, perhaps with fewer --jobs, goes on from there\n', errors)


def test_a_full_disk_is_named_in_one_line(run, monkeypatch):
    def fail(*_):
        raise OSError(28, 'No space left on device', 'results.csv')
    monkeypatch.setattr(Results, 'add', fail)
    assert run() == (1, '', "evaluate: [Errno 28] No space left on device: 'results.csv'\n")


def test_a_strategy_that_crashes_is_named_and_the_others_go_on(run, tmp_path):
    code, output, errors = run('--strategies', 'crash', 'turn', '--seeds', '1')
    assert code == 1
    assert re.fullmatch(r'evaluate: crash crashed on small, seed 1, robots 1: ZeroDivisionError: division by zero '
                        r'\(manners.py:\d+\)\n', errors)
    assert {row['strategy']: row['outcome'] for row in rows(tmp_path)} == {'crash': 'crashed', 'turn': 'time out'}


def test_strategies_of_other_packages_are_imported(run, tmp_path, monkeypatch):
    (tmp_path / 'my_strategies.py').write_text(
        'from manners import Wait\nfrom rumba_cleaning.strategies import strategy\nstrategy("mine")(Wait)\n')
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
    (('--output', '/proc/none'), '/proc/none: .*: --output must be a folder that can be written to'),
    (('--import', 'nowhere'), "strategies of 'nowhere': No module named 'nowhere'"),
    (('--sedes', '3'), 'unrecognized arguments: --sedes 3')])
def test_bad_input_is_named_in_one_line_before_anything_is_done(run, tmp_path, arguments, message):
    code, output, errors = run(*arguments)
    assert (code, output) == (2, '') and not (tmp_path / 'out').exists()
    assert re.match(f'evaluate: .*{re.escape(message) if ".*" not in message else message}', errors), errors
    assert errors.count('\n') == 1


def test_a_map_without_free_floor_is_refused(run, tmp_path):
    write(tmp_path, np.zeros((9, 9), np.uint8))
    batch.floor_plan.cache_clear()
    code, _, errors = run()
    assert code == 2 and re.fullmatch('evaluate: .*flat.yaml: no free floor: every cell is wall or unknown\n', errors)


def test_help_names_every_option(run):
    code, output, _ = run('--help')
    assert code == 0
    for option in ('maps', 'strategies', 'seeds', 'robots', 'start', 'drain', 'target', 'bound', 'import', 'output',
                   'jobs', 'scheduler', 'no-plots'):
        assert f'--{option}' in output
