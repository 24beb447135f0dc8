"""Names that strategies.md and where_to_change.md give to developers exist, in objects and in files."""

import ast
import inspect
import re

import numpy as np
import pytest
from workspaces import ROOT

from rumba_cleaning.behaviour import Behaviour, Command, Observation
from rumba_cleaning.belief import paths
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps import map_file, named_maps
from rumba_sim.model.settings.robot_config import RobotConfig

STRATEGIES = (ROOT / 'docs' / 'strategies.md').read_text()
PLACES = [[cell.strip().replace('`', '') for cell in row.split('|')[1:-1]]
          for row in (ROOT / 'docs' / 'where_to_change.md').read_text().splitlines() if row.startswith('|')][2:]
ATTRIBUTE = re.compile(r'`(observation|context|paths|self)((?:\.\w+)+)')
TABLES = '\n'.join(row for row in STRATEGIES.splitlines() if row.startswith('|'))
HOOKS = re.findall(r'^\| `(\w+)\(.*?\)` ', TABLES, re.MULTILINE)


@pytest.fixture(scope='module')
def known():
    """Objects by their names on the page."""
    context = Context(map_file.load(named_maps.path('studio')), RobotConfig(), CleaningConfig())
    return {'context': context, 'observation': Observation(0.1, Pose(1.0, 1.0, 0.0)), 'paths': paths, 'self': Behaviour}


@pytest.mark.parametrize('name, path', sorted(set(ATTRIBUTE.findall(TABLES))))
def test_what_a_strategy_gets_is_there(known, name, path):
    found = known[name]
    for part in path[1:].split('.'):
        found = getattr(found, part)


def test_what_a_row_says_of_its_object_is_there(known):
    rows = re.findall(r'^\| `context\.(\w+)` \| (.*) \|$', TABLES, re.MULTILINE)
    named = [(owner, name) for owner, about in rows for name in re.findall(r'`(\w+)(?:\(\))?`', about)]
    classes = {'FloorPlan', 'Future'}
    assert {('swept', 'coverage'), ('swept', 'missed')} <= set(named)
    assert [pair for pair in named if pair[1] not in classes
            and not hasattr(getattr(known['context'], pair[0]), pair[1])] == []


def test_the_path_that_the_page_names_leads_around(known):
    context = known['context']
    start, end = np.array(context.plan.dock[:2]), np.array([1.0, 1.5])
    way = paths.between(context.ground, start, end)
    assert (way[0] == start).all() and (way[-1] == end).all()


def test_the_hooks_and_the_command_are_those_of_the_class():
    assert {'initialise', 'update', 'terminate', 'take_note', 'plan_ahead'} <= set(HOOKS)
    for name in HOOKS:
        assert inspect.isfunction(getattr(Behaviour, name)), name
    assert set(re.search(r'`Command\((.*?)\)`', STRATEGIES).group(1).replace('=False', '').split(', ')) <= set(
        Command._fields)


@pytest.mark.parametrize('what, file, names, test', PLACES, ids=lambda cell: cell)
def test_a_place_to_change_is_there(what, file, names, test):
    defined = set()
    for node in ast.parse((ROOT / file).read_text()).body:
        defined |= {getattr(node, 'name', '')}
        targets = node.targets if isinstance(node, ast.Assign) else []
        defined |= {name.id for target in targets for name in ast.walk(target) if isinstance(name, ast.Name)}
    assert {name.strip() for name in names.split(',')} <= defined
    assert (ROOT / test).exists()


def test_five_changes_have_a_place():
    assert {'the order of rooms', 'the recoil after a bump', 'when a robot counts as lost', "a topic's rate",
            'a requirement of mission_test'} <= {row[0] for row in PLACES}
