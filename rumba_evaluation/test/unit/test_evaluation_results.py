"""Results are in their file as soon as they are known, and a run can go on with a file that is cut off anywhere."""

import csv
import dataclasses
import math

import pytest
from evaluations import case, result, steady

from rumba_cleaning.outcome import Outcome
from rumba_evaluation.trials.cases import Conditions, grid
from rumba_evaluation.trials.results import Results
from rumba_sim.model.common.errors import ConfigError

CASES = [case(seed=seed) for seed in (1, 2, 3)]
FOUND = [steady(1.5),
         steady(11.0, until=60, outcome=Outcome.TIMED_OUT, message='it took,\n"too long"', penetrated=True),
         result(energy_per_area=math.nan, outcome=Outcome.FALLEN)]


@pytest.fixture
def path(tmp_path):
    """The path of the file of results."""
    return tmp_path / 'results.csv'


def opened(path, **conditions):
    """The results of a file."""
    return Results(str(path), Conditions(**conditions))


def read(path):
    """The results in a file, by case."""
    results = opened(path)
    results.close()
    return results.found


def written(path):
    """The content of a file after all results were added to it."""
    results = opened(path)
    for one, found in zip(CASES, FOUND):
        results.add(one, found)
    results.close()
    return path.read_bytes()


def test_written_results_are_read(path):
    written(path)
    found = read(path)
    assert list(found) == CASES
    assert found[CASES[0]] == FOUND[0]
    assert found[CASES[1]] == dataclasses.replace(FOUND[1], message='it took, "too long"')
    assert math.isnan(found[CASES[2]].energy_per_area) and found[CASES[2]].curve == ()


def test_a_row_is_in_the_file_at_once_and_its_result_is_rounded_as_in_the_file(path):
    results = opened(path)
    results.add(CASES[0], result(distance=1.0 / 3.0))
    assert len(path.read_text().splitlines()) == 2
    assert results.found == read(path) and results.found[CASES[0]].distance == 0.3333333
    results.close()


def test_the_times_to_coverage_have_columns_of_their_own(path):
    written(path)
    with open(path) as file:
        first, second, third = csv.DictReader(file)
    assert (first['map'], first['strategy'], first['seed'], first['target']) == ('room', 'bounce', '1', '0.99')
    assert (first['to_80_s'], first['to_80_T'], first['to_99_T']) == ('120', '1.2', '1.485')
    assert (second['to_80_s'], second['to_80_T']) == ('inf', 'inf')
    assert [first['outcome'], second['outcome'], third['outcome']] == ['succeeded', 'timed_out', 'fallen']


def test_a_file_that_is_cut_off_anywhere_keeps_its_complete_rows_and_goes_on(path):
    whole = written(path)
    ends = [index + more for index, byte in enumerate(whole) if byte == ord('\n') for more in (0, 1)]
    for length in sorted({*range(0, len(whole), 37), *ends}):
        path.write_bytes(whole[:length])
        results = opened(path)
        kept = max(whole[:length].count(b'\n') - 1, 0)
        assert list(results.found) == CASES[:kept], length
        for one, found in list(zip(CASES, FOUND))[kept:]:
            results.add(one, found)
        results.close()
        assert path.read_bytes() == whole, length


@pytest.mark.parametrize('conditions, message', [
    (dict(target=0.95), 'was made with target 0.99, not 0.95: choose another --output, or delete it'),
    (dict(start='anywhere'), 'was made with start dock, not anywhere'),
    (dict(drain=20.0), 'was made with drain 1, not 20'),
    (dict(bound=3.0), 'was made with bound 12, not 3')])
def test_a_file_with_other_conditions_is_refused_and_not_changed(path, conditions, message):
    whole = written(path)
    with pytest.raises(ConfigError, match=f'results.csv {message}'):
        opened(path, **conditions)
    assert path.read_bytes() == whole


@pytest.mark.parametrize('content', ['a,b\n1,2\n', 'notes of mine', 'map,strategy\n', '\n'])
def test_a_file_of_another_kind_is_refused_and_not_changed(path, content):
    path.write_text(content)
    with pytest.raises(ConfigError, match='is not a file of results of this version: choose another --output'):
        opened(path)
    assert path.read_text() == content


@pytest.mark.parametrize('old, new', [(',bounce,2,', ',bounce,two,'), ('False', 'perhaps'), (',dock,', ',somewhere,'),
                                      ('timed_out', 'mislaid'), ('bounce,2,1,dock,0.99,12,', '')])
def test_the_message_names_a_line_that_cannot_be_read(path, old, new):
    lines = written(path).decode().split('\n')
    lines[2] = lines[2].replace('True', 'False').replace(old, new, 1)
    if not new:
        lines[2] = 'room,bounce'
    path.write_text('\n'.join(lines))
    with pytest.raises(ConfigError, match='results.csv cannot be read in line 3: choose another --output'):
        opened(path)


def test_a_folder_in_place_of_the_file_is_refused(tmp_path):
    with pytest.raises(ConfigError, match='Is a directory: --output must be a writable folder'):
        opened(tmp_path)


def test_the_grid_has_every_case_once():
    cases = grid(['a', 'b', 'a'], ['bounce'], [3, 4], [1, 2, 1])
    assert len(cases) == len(set(cases)) == 8
    assert cases[:3] == [('a', 'bounce', 3, 1), ('a', 'bounce', 4, 1), ('a', 'bounce', 3, 2)]


def test_another_kind_of_start_is_refused():
    with pytest.raises(ConfigError, match="start is 'here': must be dock or anywhere"):
        Conditions(start='here')


@pytest.mark.parametrize('column, values', [
    ('ideal_time', ['0', '5e-324', '-1', 'inf', 'nan']), ('time', ['inf', 'nan', '-1', '1e999']),
    ('charging_time', ['-1', '1e300', 'nan']), ('curve', ['1 nan', '1 inf', '-1', ' '.join(map(str, range(101)))])])
def test_a_file_with_times_that_no_mission_has_is_refused(path, column, values):
    written(path)
    with open(path, newline='') as file:
        rows = list(csv.reader(file))
    for value in values:
        changed = [list(row) for row in rows]
        changed[2][rows[0].index(column)] = value
        with open(path, 'w', newline='') as file:
            csv.writer(file, lineterminator='\n').writerows(changed)
        with pytest.raises(ConfigError, match='results.csv cannot be read in line 3: choose another --output, or'):
            opened(path)


def test_a_file_with_an_endless_column_is_refused(path):
    path.write_bytes(written(path) + b'x' * 1_000_000 + b'\n')
    with pytest.raises(ConfigError, match='results.csv is not a file of results of this version: choose another'):
        opened(path)


def test_the_rows_are_in_the_order_of_the_cases_at_the_end_and_those_of_others_after_them(path):
    other = case(seed=9)
    results = opened(path)
    for one, found in ((other, FOUND[0]), (CASES[2], FOUND[2]), (CASES[0], FOUND[0]), (CASES[1], FOUND[1])):
        results.add(one, found)
    results.arrange(CASES)
    more = case(seed=10)
    results.add(more, FOUND[1])
    results.close()
    with open(path, newline='') as file:
        assert [row['seed'] for row in csv.DictReader(file)] == ['1', '2', '3', '9', '10']
    assert list(read(path)) == [*CASES, other, more]
    assert [each.name for each in path.parent.iterdir()] == ['results.csv']


def test_rows_that_were_read_are_arranged_without_a_change(path):
    results = opened(path)
    for one, found in zip(reversed(CASES), reversed(FOUND)):
        results.add(one, found)
    results.close()
    again = opened(path)
    again.arrange(CASES)
    again.close()
    arranged = path.read_bytes()
    path.unlink()
    assert arranged == written(path)
