"""Strategies are registered by name, those of other packages too; bad names and modules are refused in one line."""

import sys

import pytest
from drivers import context_of
from rooms import crooked

from rumba_cleaning import strategies
from rumba_cleaning.behaviour import STOP, Behaviour, Observation
from rumba_cleaning.behaviours.bounce import Bounce
from rumba_sim.model.common.errors import StrategyError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.world import World

PLAN = crooked()
OTHER = '''
from rumba_cleaning.behaviour import STOP, Behaviour
from rumba_cleaning.strategies import strategy

@strategy('statue')
class Statue(Behaviour):
    def __init__(self, context):
        self.name = context.plan.name
    def update(self, observation):
        return STOP
'''


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A folder on the Python path; what strategies it makes known is forgotten after the test."""
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(strategies, '_factories', dict(strategies._factories))
    yield tmp_path
    for name in [name for name, module in sys.modules.items() if str(tmp_path) in str(getattr(module, '__file__', ''))]:
        del sys.modules[name]


def test_those_of_this_package_are_known():
    assert {'bounce', 'boustrophedon', 'spiral', 'wall_follow', 'wander'} <= set(strategies.known())


@pytest.mark.parametrize('name', ['bounce', 'boustrophedon', 'spiral', 'wall_follow', 'wander'])
def test_each_call_makes_a_new_one(name):
    context = context_of(PLAN, World(PLAN))
    one, other = strategies.make(name, context), strategies.make(name, context)
    assert isinstance(one, Behaviour) and one is not other


def test_bounce_is_made_with_the_speed_that_was_asked_for():
    bounce = strategies.make('bounce', context_of(PLAN, World(PLAN), speed=0.21))
    assert isinstance(bounce, Bounce)
    assert bounce.step(Observation(0.0, Pose(1.0, 1.0, 0.0))).v == 0.21


def test_another_package_adds_its_own(package):
    (package / 'their_statues.py').write_text(OTHER)
    strategies.load(' their_statues, ')
    statue = strategies.make('statue', context_of(PLAN, World(PLAN)))
    assert statue.name == 'room'
    assert statue.step(Observation(0.0, Pose(1.0, 1.0, 0.0))) == STOP


def test_a_name_that_is_taken_is_refused(package):
    (package / 'their_bounce.py').write_text(OTHER.replace('statue', 'bounce'))
    with pytest.raises(StrategyError, match="two strategies are named 'bounce': .*Bounce|bounce.* and .*Statue"):
        strategies.load('their_bounce')


@pytest.mark.parametrize('module', ['nobody.has_this', '.relative', 'a b'])
def test_a_module_that_is_not_there_is_refused(module):
    with pytest.raises(StrategyError, match=f"^strategies of '{module}': .*; a module is named as in Python, "):
        strategies.load(module)


@pytest.mark.parametrize('code, error', [
    ('import nobody_has_this\n', r"ModuleNotFoundError: No module named 'nobody_has_this' \(their_typo\.py:1\)"),
    ('speed = 1\nspede * 2\n', r"NameError: name 'spede' is not defined \(their_typo\.py:2\)"),
    ('import json\njson.loads("?")\n', r'JSONDecodeError: .* \(decoder\.py:\d+, from their_typo\.py:2\)'),
    ('class Zigzag(:\n', r'SyntaxError: invalid syntax \(their_typo\.py:1\)'),
    ('import sys\nsys.exit("good\\nbye")\n', r'SystemExit: good.*bye \(their_typo\.py:2\)'),
    ('\0', '.*source code .*null bytes.*')])
def test_a_module_that_cannot_be_executed_is_refused_with_the_line(package, code, error):
    (package / 'their_typo.py').write_text(code)
    with pytest.raises(StrategyError, match=f"^strategies of 'their_typo': {error}$"):
        strategies.load('their_typo')


def test_a_strategy_that_is_no_behaviour_is_refused(package):
    strategies.strategy('nothing')(lambda context: None)
    with pytest.raises(StrategyError, match="^strategy 'nothing' makes None: must be a Behaviour$"):
        strategies.make('nothing', context_of(PLAN, World(PLAN)))


def test_an_unknown_name_is_refused_with_those_that_are_known():
    with pytest.raises(StrategyError, match="unknown strategy 'zigzag': known are .*bounce, .*boustrophedon"):
        strategies.check('zigzag')
