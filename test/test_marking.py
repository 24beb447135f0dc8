"""The command mark, on what classes hand in: submissions that are built, cheats, processes and files that are left."""

import csv
import json
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time

import pytest
from workspaces import ROOT, TIMEOUT

sys.path.append(str(ROOT / 'bench'))
from common import classroom  # noqa: E402
from common.homework import BUMPER, EXERCISES, GOOD, HOSTILE, MARKER, STATUS, solved  # noqa: E402

HIDDEN = {exercise: ROOT / 'rumba_exercises' / exercise / 'hidden' for exercise in (STATUS, BUMPER)}
MARK = 'rosrun rumba_evaluation mark'
MAKERS = {maker.__name__: (kind, exercise, maker) for kind, makers in classroom.MAKERS.items()
          for exercise, maker in makers}
LONG = 600.0  # [s]


def class_of(folder, *names):
    """Make a class of these submissions, all to one exercise, and return the exercise."""
    for name in names:
        kind, exercise, maker = MAKERS[name]
        path = folder / 'class' / name
        shutil.copytree(EXERCISES / exercise / 'starter', path)
        if kind == GOOD:
            solved(path, exercise)
        maker(path)
    return exercise


def rows(folder):
    """The rows of the sheet of a class, by name."""
    with open(folder / 'marks' / 'marks.csv', encoding='utf-8', newline='') as file:
        return {row['submission']: row for row in csv.DictReader(file)}


def marked(space, folder, exercise, words='exam:=true', **options):
    """Mark a class; returns the rows of its sheet."""
    space.run(f'{MARK} --all {folder}/class --tests {HIDDEN[exercise]} --output {folder}/marks --jobs 2 {words}', LONG,
              **options)
    return rows(folder)


@pytest.fixture
def scratch(tmp_path):
    """A folder for the scratch folders of mark, in which nothing may be left."""
    folder = tmp_path / 'scratch'
    folder.mkdir()
    yield folder
    assert not list(folder.iterdir())
    assert not [path for path in pathlib.Path('/proc').glob('[0-9]*/cmdline') if _names(path, str(folder).encode())]


def _names(path, word):
    try:
        return word in path.read_bytes()
    except OSError:
        return False


@pytest.fixture
def space(workspace, environment, scratch):
    """The space of the workspace, with a folder for temporary files."""
    return workspace.space('devel', {**environment, 'TMPDIR': str(scratch)})


def test_what_must_be_built_is_built_from_anywhere_and_cheats_earn_nothing(space, tmp_path):
    elsewhere = tmp_path / 'elsewhere'  # a workspace in which the teacher happens to be
    (elsewhere / 'src' / 'broken').mkdir(parents=True)
    (elsewhere / 'src' / 'broken' / 'package.xml').write_text('no package')
    exercise = class_of(tmp_path, 'bumper_in_cpp_and_zipped', 'has_a_wide_brush', 'leaves_a_process', 'odd_files')
    found = marked(space, tmp_path, exercise, cwd=str(elsewhere))
    assert {name: row['points'] for name, row in found.items()} == {
        'bumper_in_cpp_and_zipped': '10', 'has_a_wide_brush': '0', 'leaves_a_process': '0', 'odd_files': '0'}
    assert [path.name for path in elsewhere.iterdir()] == ['src']
    assert 'pipe is left out: it is neither a file nor a folder' in found['odd_files']['notes']
    assert 'Built target cleaner' in (tmp_path / 'marks' / 'bumper_in_cpp_and_zipped' / 'build.log').read_text()


@pytest.mark.thorough
@pytest.mark.parametrize('names', [
    ('status_in_cpp', 'status_with_a_message_of_its_own', 'status_with_a_module', 'status_in_two_packages',
     'status_as_one_script', 'status_from_a_platform', 'status_in_a_workspace'),
    ('bumper_by_two_nodes_and_a_message', 'bumper_with_a_service_of_its_own', 'bumper_with_a_library_in_cpp')])
def test_good_submissions_earn_all_points_however_they_are_handed_in(space, tmp_path, names):
    found = marked(space, tmp_path, class_of(tmp_path, *names))
    assert {row['submission']: row['points'] for row in found.values()} == dict.fromkeys(names, '10')


@pytest.mark.thorough
@pytest.mark.parametrize('name, words', [
    ('windows_line_ends', 'has Windows line ends'), ('byte_order_mark', 'begins with a byte order mark'),
    ('script_with_another_name', 'rename it to status_exercise/scripts/status'),
    ('script_that_is_missing', 'status_exercise has no node status'), ('python_2', 'this is Python 2'),
    ('error_in_cpp', 'cleaner.cpp'), ('package_that_is_not_installed', 'moveit_core')])
def test_a_pupil_is_told_what_is_wrong_and_nothing_about_nodes_that_were_interrupted(space, tmp_path, name, words):
    [row] = marked(space, tmp_path, class_of(tmp_path, name), '').values()
    assert row['points'] == '0' and words in row['notes']
    assert 'KeyboardInterrupt' not in row['notes'] and 'KeyError' not in row['notes']


@pytest.mark.thorough
@pytest.mark.parametrize('name', [name for name, (kind, _, _) in MAKERS.items() if kind == HOSTILE])
def test_hostile_submissions_earn_nothing_and_leave_nothing(space, tmp_path, name):
    code = 'from rumba_evaluation.submissions import sandbox; print(sandbox.trouble())'
    trouble = space.run(f'python3 -c "{code}"').strip()
    if trouble:
        pytest.skip(f'this system permits no sandbox: {trouble}')
    [row] = marked(space, tmp_path, class_of(tmp_path, name)).values()
    assert row['points'] == '0'
    log = tmp_path / 'marks' / name / 'bumper.log'
    assert log.stat().st_size < 2_000_000 and 'FOUND' not in log.read_text()
    assert not list(tmp_path.glob(f'*/{MARKER}'))


@pytest.mark.thorough
def test_a_class_goes_on_after_it_was_ended_at_any_moment(space, tmp_path, scratch):
    names = ('status_solution', 'share_for_percent', 'status_in_cpp', 'wrong_topic')
    exercise = class_of(tmp_path, *names)
    generator = random.Random(4)
    for sent in (signal.SIGINT, signal.SIGKILL, signal.SIGTERM):
        process = space.start(f'{MARK} --all {tmp_path}/class --tests {HIDDEN[exercise]} --output {tmp_path}/marks '
                              '--jobs 2', start_new_session=True)
        time.sleep(generator.uniform(3.0, 12.0))
        process.send_signal(sent)
        process.communicate(timeout=TIMEOUT)
    found = marked(space, tmp_path, exercise, '')
    shutil.move(str(tmp_path / 'marks'), str(tmp_path / 'first'))
    again = marked(space, tmp_path, exercise, '')
    assert {name: row['points'] for name, row in found.items()} == {name: row['points'] for name, row in again.items()}
    assert [found[name]['points'] == '10' for name in names] == [True, False, True, False]


def test_what_cannot_be_marked_is_told_to_who_reads_only_the_results(space, tmp_path):
    process = space.start(f'{MARK} {tmp_path} --tests {tmp_path}/none --output {tmp_path}/out', stderr=subprocess.PIPE)
    _, errors = process.communicate(timeout=TIMEOUT)
    assert process.returncode == 2 and errors == f'mark: {tmp_path}/none: is no folder\n'
    found = json.loads((tmp_path / 'out' / 'results.json').read_text())
    assert (found['score'], found['output'], found['tests']) == (0.0, errors.strip(), [])


def test_a_room_that_has_changed_is_marked_again(space, tmp_path):
    hidden = tmp_path / 'exercises' / 'x' / 'hidden'
    shutil.copytree(HIDDEN[BUMPER], hidden)
    shutil.copytree(ROOT / 'rumba_exercises' / 'rooms', tmp_path / 'exercises' / 'rooms')
    code = ('import sys; from rumba_evaluation.marks import class_marks, hidden_tests; '
            'from rumba_evaluation.ros import launches; t = hidden_tests.load(sys.argv[1], {}); '
            'print(class_marks.digest_of_tests(sys.argv[1], t, [launches.load(each, sys.argv[1]) for each in t]))')

    def digest():
        return space.run(f'python3 -c "{code}" {hidden}')
    found = [digest(), digest()]
    assert found[0] == found[1]
    for changed in (tmp_path / 'exercises' / 'rooms' / 'room.png', hidden / 'helper'):
        with open(changed, 'ab') as file:
            file.write(b'x')
        found.append(digest())
    assert len(set(found)) == 3
