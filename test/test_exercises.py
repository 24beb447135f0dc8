"""Of each exercise, the solution earns all points, and typical wrong submissions and the starter package do not."""

import csv
import re
import shutil
import xml.etree.ElementTree as ElementTree

import pytest
from workspaces import ROOT

EXERCISES = sorted((ROOT / 'rumba_exercises').glob('[0-9]_*'))
INDEX = (ROOT / 'rumba_exercises' / 'README.md').read_text()


def name_of(path):
    """What a test of an exercise is called."""
    return path.name


def class_of(exercise, folder):
    """Make the submissions of a class in a folder."""
    for overlay in (exercise / 'solution', *(exercise / 'wrong').iterdir()):
        shutil.copytree(exercise / 'starter', folder / overlay.name)
        shutil.copytree(overlay, folder / overlay.name, dirs_exist_ok=True)


@pytest.mark.parametrize('exercise', EXERCISES, ids=name_of)
def test_the_solution_earns_all_points_and_each_wrong_submission_less(exercise, workspace, tmp_path):
    class_of(exercise, tmp_path / 'class')
    workspace.space('devel').run(f'rosrun rumba_evaluation mark --all {tmp_path}/class --tests {exercise}/hidden '
                                 f'--output {tmp_path}/marks', timeout=600.0)
    with open(tmp_path / 'marks' / 'marks.csv', encoding='utf-8', newline='') as file:
        rows = {row['submission']: row for row in csv.DictReader(file)}
    assert len(rows) == 4
    assert {name for name, row in rows.items() if row['points'] == row['of']} == {'solution'}, rows


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
