"""A behaviour owns its life cycle: what callers do in whatever order, each run is initialised and terminated once."""

import ast
import pathlib

import pytest

from rumba_cleaning import behaviour as module_of_behaviour
from rumba_cleaning.behaviour import FINAL, STOP, Behaviour, Command, Observation, Status
from rumba_cleaning.outcome import Outcome
from rumba_sim.model.common.geometry import Pose

SOURCE = pathlib.Path(module_of_behaviour.__file__).parent
HOOKS = ('initialise', 'update', 'terminate', 'take_note')
FOR_WATCHERS = ('plan_ahead',)
SEEN = Observation(0.1, Pose(1.0, 2.0, 3.0))
AHEAD = Command(0.2, 0.1)


class Recorder(Behaviour):
    """Records which of its hooks are called, and ends with the update of a number."""

    def __init__(self, last=0, fails=False):
        self.calls = []
        self._last = last
        self._fails = fails

    def initialise(self):
        self.calls.append('initialise')
        self._count = 0

    def update(self, observation):
        self.calls.append('update')
        self._count += 1
        self.message = f'update {self._count}'
        if self._count == self._last:
            if self._fails:
                self.fail('gave up', Outcome.BLOCKED)
            else:
                self.succeed('done')
        return AHEAD

    def terminate(self):
        self.calls.append('terminate')

    def take_note(self, observation):
        self.calls.append(observation)


def test_the_first_step_initialises_and_every_step_updates():
    behaviour = Recorder()
    assert behaviour.calls == []
    assert [behaviour.step(SEEN) for _ in range(3)] == [AHEAD] * 3
    assert behaviour.calls == ['initialise', 'update', 'update', 'update']
    assert (behaviour.status, behaviour.message, behaviour.outcome) == (Status.RUNNING, 'update 3', Outcome.UNKNOWN)


@pytest.mark.parametrize('fails, end', [(False, (Status.SUCCEEDED, 'done', Outcome.SUCCEEDED)),
                                        (True, (Status.FAILED, 'gave up', Outcome.BLOCKED))])
def test_from_its_end_on_it_answers_stop_and_is_not_updated_whatever_update_returned(fails, end):
    behaviour = Recorder(2, fails)
    assert [behaviour.step(SEEN) for _ in range(5)] == [AHEAD, STOP, STOP, STOP, STOP]
    assert behaviour.calls == ['initialise', 'update', 'update', 'terminate']
    assert (behaviour.status, behaviour.message, behaviour.outcome) == end


def test_an_end_is_followed_by_terminate_only_once():
    behaviour = Recorder(1)
    behaviour.step(SEEN)
    behaviour.stop()
    behaviour.restart()
    assert behaviour.calls.count('terminate') == 1


def test_a_behaviour_that_is_stopped_terminates_once_and_begins_again_with_the_next_step():
    behaviour = Recorder(2)
    behaviour.step(SEEN)
    for _ in range(2):
        behaviour.stop()
    assert behaviour.calls == ['initialise', 'update', 'terminate']
    assert (behaviour.status, behaviour.message) == (Status.RUNNING, 'update 1')
    assert behaviour.step(SEEN) == AHEAD
    assert behaviour.calls[3:] == ['initialise', 'update']


def test_a_behaviour_that_is_restarted_on_its_way_terminates_first():
    behaviour = Recorder()
    behaviour.step(SEEN)
    behaviour.restart()
    assert behaviour.message == ''
    behaviour.step(SEEN)
    assert behaviour.calls == ['initialise', 'update', 'terminate', 'initialise', 'update']


def test_a_behaviour_that_is_restarted_after_its_end_runs_again():
    behaviour = Recorder(1, fails=True)
    behaviour.step(SEEN)
    behaviour.restart()
    assert (behaviour.status, behaviour.message, behaviour.outcome) == (Status.RUNNING, '', Outcome.UNKNOWN)
    behaviour.step(SEEN)
    assert behaviour.calls == ['initialise', 'update', 'terminate'] * 2


def test_a_behaviour_that_never_began_has_nothing_to_terminate():
    behaviour = Recorder()
    behaviour.stop()
    behaviour.restart()
    assert behaviour.calls == []


def test_a_caller_may_fail_it_and_it_terminates_when_it_is_stopped_or_stepped():
    for end in (Behaviour.stop, Behaviour.restart):
        behaviour = Recorder()
        behaviour.step(SEEN)
        assert behaviour.fail('an exception', Outcome.ERROR) == STOP
        assert behaviour.step(SEEN) == STOP
        end(behaviour)
        assert behaviour.calls == ['initialise', 'update', 'terminate']


def test_while_it_stands_by_it_takes_note_and_is_not_updated():
    behaviour = Recorder()
    behaviour.step(SEEN)
    behaviour.stand_by(SEEN)
    behaviour.step(SEEN)
    assert behaviour.calls == ['initialise', 'update', SEEN, 'update']


def test_before_it_begins_and_after_it_has_ended_it_takes_no_note():
    behaviour = Recorder(1)
    behaviour.stand_by(SEEN)
    behaviour.step(SEEN)
    behaviour.stand_by(SEEN)
    assert behaviour.calls == ['initialise', 'update', 'terminate']


def test_what_fails_in_initialise_is_not_updated():
    class Stillborn(Recorder):
        def initialise(self):
            super().initialise()
            self.fail('cannot begin')

    behaviour = Stillborn()
    assert [behaviour.step(SEEN) for _ in range(2)] == [STOP, STOP]
    assert behaviour.calls == ['initialise', 'terminate']


def test_after_an_exception_in_initialise_the_next_step_initialises_again():
    class Hesitant(Recorder):
        def initialise(self):
            super().initialise()
            if len(self.calls) == 1:
                raise ValueError('not yet')

    behaviour = Hesitant()
    with pytest.raises(ValueError, match='not yet'):
        behaviour.step(SEEN)
    assert behaviour.step(SEEN) == AHEAD
    assert behaviour.calls == ['initialise', 'initialise', 'update']


@pytest.mark.parametrize('name', FINAL)
def test_a_subclass_that_overrides_what_callers_use_is_refused(name):
    with pytest.raises(TypeError, match=f'^Own overrides {name}, which is final: a behaviour overrides initialise, '):
        type('Own', (Recorder,), {name: lambda self: None})


def test_all_that_callers_use_is_final():
    methods = {name for name, value in vars(Behaviour).items() if callable(value) and not name.startswith('_')}
    assert methods == {*FINAL, *HOOKS, *FOR_WATCHERS}


@pytest.mark.parametrize('path', [path for folder in ('', 'behaviours', 'strategies', 'mission', 'ros/cleaner')
                                  for path in sorted((SOURCE / folder).glob('*.py')) if path.name != 'behaviour.py'],
                         ids=lambda path: path.stem)
def test_no_module_calls_a_hook(path):
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            assert node.func.attr not in HOOKS, f'line {node.lineno}'
