"""Of each exercise, the solution earns all points, and typical wrong submissions and the starter package do not."""

import csv
import re
import shutil
import xml.etree.ElementTree as ElementTree

import pytest
from workspaces import ROOT

EXERCISES = sorted((ROOT / 'rumba_exercises').glob('[0-9]_*'))
INDEX = (ROOT / 'rumba_exercises' / 'README.md').read_text()
SLOW = 0.03  # [s] of the wall clock, many times as long as a world takes for a control tick


def name_of(path):
    """What a test of an exercise is called."""
    return path.name


def class_of(exercise, folder):
    """Make the submissions of a class in a folder."""
    for overlay in (exercise / 'solution', *(exercise / 'wrong').iterdir()):
        shutil.copytree(exercise / 'starter', folder / overlay.name)
        shutil.copytree(overlay, folder / overlay.name, dirs_exist_ok=True)


def marked(space, folder, tests, arguments=''):
    """The rows of the sheet of a class, by name."""
    space.run(f'rosrun rumba_evaluation mark --all {folder}/class --tests {tests} --output {folder}/marks {arguments}',
              timeout=600.0)
    with open(folder / 'marks' / 'marks.csv', encoding='utf-8', newline='') as file:
        return {row['submission']: row for row in csv.DictReader(file)}


@pytest.mark.thorough
@pytest.mark.parametrize('exercise', EXERCISES, ids=name_of)
def test_the_solution_earns_all_points_and_each_wrong_submission_less(exercise, workspace, tmp_path):
    class_of(exercise, tmp_path / 'class')
    rows = marked(workspace.space('devel'), tmp_path, f'{exercise}/hidden')
    assert len(rows) == 4
    assert {name for name, row in rows.items() if row['points'] == row['of']} == {'solution'}, '\n'.join(
        path.read_text() for path in sorted((tmp_path / 'marks').glob('*/*.[jl]*')))  # results and logs


@pytest.mark.thorough
def test_an_examination_is_passed_by_what_a_robot_knows_and_its_recording_is_kept(workspace, tmp_path):
    exercise = ROOT / 'rumba_exercises' / '2_bumper'
    for overlay in ('starter', 'solution'):
        shutil.copytree(exercise / overlay, tmp_path / 'class' / 'honest', dirs_exist_ok=True)
    row = marked(workspace.space('install'), tmp_path, exercise / 'hidden', 'exam:=true')['honest']
    assert (row['points'], row['notes']) == ('10', '')
    assert (tmp_path / 'marks' / 'honest' / 'bumper.recording.bag').stat().st_size > 0


@pytest.mark.thorough
def test_a_submission_that_takes_its_time_for_each_answer_earns_all_points(workspace, tmp_path):
    exercise = ROOT / 'rumba_exercises' / '1_status'
    for overlay in ('starter', 'solution'):
        shutil.copytree(exercise / overlay, tmp_path / 'class' / 'slow', dirs_exist_ok=True)
    script = tmp_path / 'class' / 'slow' / 'status_exercise' / 'scripts' / 'status'
    before, after = script.read_text().split('        status = BatteryStatus()')
    script.write_text(f'{before}        rospy.rostime.wallsleep({SLOW})\n        status = BatteryStatus(){after}')
    rows = marked(workspace.space('devel'), tmp_path, exercise / 'hidden')
    assert rows['slow']['points'] == '10', rows


@pytest.mark.parametrize('exercise', EXERCISES, ids=name_of)
def test_a_page_names_the_package_its_topics_and_the_typical_mistakes(exercise):
    page = (exercise / 'README.md').read_text()
    [package] = [path.parent.name for path in (exercise / 'starter').glob('*/package.xml')]
    assert f'`{package}`' in page and f'[{exercise.name[0]}]({exercise.name}/README.md)' in INDEX
    for path in (exercise / 'wrong').iterdir():
        assert f'`{path.name}`' in page, path.name
    test, = (exercise / 'hidden').glob('*.test')
    root = ElementTree.parse(str(test)).getroot()
    parameters = {param.attrib['name']: param.attrib['value'] for param in root.iter('param')}
    for part in parameters['points'].split(';'):
        condition, points = part.split()
        assert re.search(rf'^\| `{condition}` \|.*\| {points} \|$', page, re.MULTILINE), condition


@pytest.mark.parametrize('exercise', EXERCISES, ids=name_of)
def test_a_starter_package_is_one_that_catkin_understands(exercise):
    [manifest] = (exercise / 'starter').glob('*/package.xml')
    assert ElementTree.parse(str(manifest)).getroot().find('name').text == manifest.parent.name
    for overlay in (exercise / 'solution', *(exercise / 'wrong').iterdir()):
        for path in (path.relative_to(overlay) for path in overlay.rglob('*') if path.is_file()):
            assert (exercise / 'starter' / path).is_file(), f'{overlay}: {path}'
