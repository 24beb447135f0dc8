"""Nodes import the rumba_msg that has our definitions, whatever comes before it on sys.path."""

import sys

import pytest
import roslib.message

import rumba_msg.srv
from rumba_sim.ros.common import definitions

OURS = rumba_msg.__file__


@pytest.fixture(autouse=True)
def afterwards(monkeypatch):
    """The path and the modules of this process are as before."""
    monkeypatch.setattr(sys, 'path', sys.path[:])
    modules = sys.modules.copy()
    yield
    forget()
    sys.modules.update(modules)


def package(folder, *modules):
    """A package rumba_msg with some modules; returns the path of its __init__.py."""
    for path in ('__init__', 'msg/__init__', 'srv/__init__', *modules):
        file = folder / 'rumba_msg' / f'{path}.py'
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(f'NAME = {path!r}\n')
    return str(folder / 'rumba_msg' / '__init__.py')


def forget():
    """Have nothing of rumba_msg imported."""
    for name in [name for name in sys.modules if name.split('.')[0] == 'rumba_msg']:
        del sys.modules[name]


def imported():
    """Where rumba_msg, and a service that no lesson has, are imported from."""
    import rumba_msg.srv._AddObstacle as module
    return sys.modules['rumba_msg'].__file__, module.__file__.replace('srv/_AddObstacle', '__init__')


@pytest.mark.parametrize('is_imported', [False, True])
def test_that_of_a_lesson_is_passed_over_also_if_it_is_imported_already(tmp_path, is_imported):
    lessons = package(tmp_path, 'msg/_BatteryStatus', 'srv/_TargetPosition')
    sys.path.insert(0, str(tmp_path))
    forget()
    if is_imported:
        import rumba_msg.msg._BatteryStatus
        assert rumba_msg.__file__ == lessons
    definitions.take_ours()
    assert imported() == (OURS, OURS)
    assert roslib.message.get_message_class('rumba_msg/SimulatorState') is not None


def test_one_that_lacks_a_single_definition_is_not_ours(tmp_path):
    package(tmp_path, *[module for module in definitions.MODULES if module != 'srv/_Kill'])
    sys.path.insert(0, str(tmp_path))
    forget()
    definitions.take_ours()
    assert imported() == (OURS, OURS)


def test_of_two_that_have_all_the_first_is_taken(tmp_path):
    first = package(tmp_path, *definitions.MODULES)
    sys.path.insert(0, str(tmp_path))
    forget()
    definitions.take_ours()
    assert imported() == (first, first)


def test_what_is_imported_already_stays_if_it_is_ours():
    before = sys.modules['rumba_msg'], sys.modules['rumba_msg.srv']
    definitions.take_ours()
    assert (sys.modules['rumba_msg'], sys.modules['rumba_msg.srv']) == before


def test_a_folder_without_an_init_file_as_the_one_of_the_definitions_is_no_package(tmp_path):
    for module in definitions.MODULES:
        file = tmp_path / 'rumba_msg' / f'{module}.py'
        file.parent.mkdir(parents=True, exist_ok=True)
        file.touch()
    sys.path.insert(0, str(tmp_path))
    forget()
    definitions.take_ours()
    assert imported() == (OURS, OURS)


def test_if_no_package_has_all_the_error_is_that_of_the_import(tmp_path):
    package(tmp_path, 'msg/_BatteryStatus')
    sys.path[:] = [str(tmp_path)]
    forget()
    definitions.take_ours()
    with pytest.raises(ImportError, match='_AddObstacle'):
        imported()
