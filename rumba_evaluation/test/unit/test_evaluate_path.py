"""evaluate --path: what it prints, what it refuses, and that its JSON is strict."""

import json

import pytest
from evaluations import small_map

from rumba_evaluation.trials import evaluate


@pytest.fixture
def run(tmp_path, capsys):
    """A function that runs the command with a path on a small map, and returns exit code, output and errors."""
    def run(*arguments, content='x,y\n0.3,0.3\n1.2,0.3\n1.2,0.6\n0.3,0.6\n'):
        (tmp_path / 'path.csv').write_text(content)
        try:
            code = evaluate.main(['--path', str(tmp_path / 'path.csv'), '--maps', small_map(tmp_path), *arguments])
        except SystemExit as end:
            code = end.code
        captured = capsys.readouterr()
        return code, captured.out, captured.err
    return run


def strict(text):
    """The value of a text that is valid JSON, without what only Python reads."""
    def refuse(constant):
        raise AssertionError(f'{constant} is no JSON')
    return json.loads(text, parse_constant=refuse)


def test_the_table_and_the_places(run):
    code, output, errors = run()
    assert (code, errors) == (0, '')
    titles, values = output.splitlines()[5:7]
    assert titles.split()[:3] == ['map', 'strategy', 'robots'] and values.split()[1:3] == ['path.csv', '1']
    assert 'collisions  near misses' in titles and 'overlap  revisit' in titles
    assert '\nsucceeded: the end of the path is reached at (' in output and '\nnever reached: ' in output


def test_json_is_strict_and_says_null_for_never(run):
    for arguments in ((), ('--as-drawn',)):
        code, output, errors = run('--format', 'json', *arguments)
        found = strict(output)
        assert (code, errors, found['as_drawn']) == (0, '', bool(arguments))
        assert found['outcome'] == 'succeeded' and 0.2 < found['coverage'] < 0.8 and found['collisions'] == []
        assert found['time_to_s']['99'] is None and found['time_to_s'].keys() == found['time_to_T'].keys()
        assert found['path_length'] == pytest.approx(2.1, abs=0.1) and found['turns'] in (1, 2)
        assert sum(patch['area'] for patch in found['never_reached']) == pytest.approx(found['area_never_reached'])


def test_json_of_a_drive_that_swept_nothing_is_strict_too(run):
    _, output, _ = run('--format', 'json', '--bound', '0.01')
    assert strict(output)['energy_per_area'] is None or strict(output)['coverage'] > 0.0


def test_files_are_written_only_where_they_are_asked_for(run, tmp_path):
    before = set(tmp_path.iterdir())
    run()
    assert set(tmp_path.iterdir()) - before <= {tmp_path / name for name in ('path.csv', 'flat.yaml', 'flat.png')}
    code, output, _ = run('--format', 'json', '--output', str(tmp_path / 'out'))
    assert code == 0 and sorted(path.suffix for path in (tmp_path / 'out').iterdir()) == ['.json', '.png']
    assert strict((tmp_path / 'out' / 'score.json').read_text()) == strict(output)


@pytest.mark.parametrize('content, message', [
    ('x,y\n0.3,0.3\nnan,1\n', 'path.csv, line 3: x is nan: must be a finite number'),
    ('x,y\n0.3,0.3\n7,1\n', 'path.csv, line 3: (7.00, 1.00) m lies outside the map'),
    ('x,y\n0.3,0.3\n0.3,1.02\n', 'path.csv, line 3: (0.30, 1.02) m lies in a wall of the map'),
    ('x,y\n0.1,0.3\n1,0.3\n', 'path.csv, line 2: no robot can begin there: ')])
def test_a_bad_path_is_one_line(run, content, message):
    code, output, errors = run(content=content)
    assert (code, output, errors.count('\n')) == (2, '', 1) and message in errors and errors.startswith('evaluate: ')


@pytest.mark.parametrize('arguments, message', [
    (['--strategies', 'bounce'], '--strategies has no meaning with --path'),
    (['--import', 'x'], '--import has no meaning with --path'),
    (['--laser'], '--laser has no meaning with --path'),
    (['--maps', 'studio', 'field'], '--path needs --maps with the one map that the path is for'),
    (['--speed', '0'], '--speed is 0: must be above 0, and 0.5 m/s at most'),
    (['--speed', 'nan'], '--speed is nan: must be above 0'),
    (['--topic', '/plan'], 'is not a bag'),
    (['--drain', '-1'], 'drain')])
def test_options_that_do_not_fit(run, arguments, message):
    code, output, errors = run(*arguments)
    assert (code, output, errors.count('\n')) == (2, '', 1) and message in errors


def test_options_of_paths_have_no_meaning_for_missions(capsys):
    for option in (['--as-drawn'], ['--topic', '/plan'], ['--speed', '0.2']):
        assert evaluate.main([*option, '--no-plots']) == 2
        assert f'{option[0]} has no meaning without --path' in capsys.readouterr().err


def test_missions_as_json(run, tmp_path, capsys):
    assert evaluate.main(['--maps', small_map(tmp_path), '--strategies', 'bounce', '--seeds', '2', '--bound', '0.2',
                          '--jobs', '1', '--no-plots', '--format', 'json', '--output', str(tmp_path / 'out')]) == 0
    missions = strict(capsys.readouterr().out)['missions']
    assert [mission['seed'] for mission in missions] == [1, 2]
    assert missions[0]['strategy'] == 'bounce' and missions[0]['time_to_T']['99'] is None
