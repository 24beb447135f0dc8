"""A mission is recorded from a press of the button to another one, or to its end, and a report is made of it."""

import dataclasses
import pathlib

import pytest
import rospkg
from PyQt5.QtCore import Qt
from windows import Opened, robot, snapshot

from rumba_viewer.ros import mission_record
from rumba_viewer.ros.actor import Actor
from rumba_viewer.ros.mission_record import MissionRecord, RecordError
from rumba_viewer.scene.snapshot import Mission

CLEANING, IDLE = Mission('cleaning', True, 'bounce', ''), Mission('idle', False, '', '')


@pytest.fixture
def opened(tmp_path):
    """A window with a robot that does nothing yet."""
    return Opened(snapshot(robot(mission=IDLE)), folder=str(tmp_path))


def done(opened):
    """The names of what was asked for."""
    return [what for what, *_ in opened.actor.done]


def test_the_button_begins_and_ends_a_recording_and_shows_how_long_it_is(opened, tmp_path):
    button = opened.window.panel.buttons['report']
    opened.type(Qt.Key_B, Qt.ControlModifier)
    (what, name, bag), = opened.actor.done
    assert (what, name, bag.parent, bag.suffix) == ('record_mission', 'rumba', tmp_path, '.bag')
    assert button.isChecked() and button.text() == '0:00'
    opened.window.reports._begun -= 83.0
    opened.window.update_picture()
    assert button.text() == '1:23'
    opened.window.act('report')
    assert done(opened) == ['record_mission', 'make_report'] and not button.isChecked() and button.text() == 'Report'


def test_the_recording_ends_with_the_mission_of_its_robot(opened):
    opened.window.act('report')
    other = robot('rumba2', mission=IDLE, report=('ended',))
    for shown in (robot(mission=CLEANING), robot(mission=IDLE)):  # the figures of the end are still to come
        opened.show(snapshot(shown, other))
        opened.window.update_picture()
    assert opened.window.reports.is_recording
    opened.show(snapshot(robot(mission=IDLE, report=('ended',)), other))
    opened.window.update_picture()
    assert done(opened) == ['record_mission', 'make_report'] and not opened.window.reports.is_recording


def test_a_mission_that_ended_before_does_not_end_it(opened):
    opened.show(snapshot(robot(mission=IDLE, report=('ended',))))
    opened.window.act('report')
    opened.window.update_picture()
    assert opened.window.reports.is_recording


def test_what_cannot_be_recorded_is_not(opened):
    opened.actor.can_record = False
    opened.window.act('report')
    assert not opened.window.reports.is_recording and not opened.window.panel.buttons['report'].isChecked()


def test_the_card_says_how_to_get_a_report_and_then_where_it_is(opened):
    opened.show(snapshot(robot(mission=IDLE, report=('ended',))))
    opened.window.update_picture()
    assert opened.window.floor.hint == 'Report [Ctrl+B] records the next mission and makes a page of it.'
    before = opened.picture()
    opened.actor.report = 'The report is /tmp/rumba.html'
    opened.show(dataclasses.replace(opened.window.snapshot))
    assert opened.window.floor.hint == opened.actor.report
    assert opened.picture() != before


# --- the bag ----------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('package, source', mission_record.NEEDED.items())
def test_what_is_not_installed_is_named(monkeypatch, tmp_path, package, source):
    def get_path(_, name):
        if name == package:
            raise rospkg.ResourceNotFound(name)
    monkeypatch.setattr(rospkg.RosPack, 'get_path', get_path)
    actor = Actor('rumba')
    assert not actor.record_mission('rumba', tmp_path / 'a.bag')
    assert actor.notices.get() == f'report: needs the package {package}: install {source}'
    actor.make_report()
    assert actor.notices.empty() and actor.report == ''


def test_a_folder_that_is_a_file_is_refused(tmp_path):
    (tmp_path / 'taken').write_text('')
    with pytest.raises(RecordError, match=r'cannot be recorded: .*/taken'):
        MissionRecord('rumba', tmp_path / 'taken' / 'a.bag')


@pytest.mark.parametrize('content, said', [
    (None, 'rosbag wrote no {bag}: is there a gigabyte of space, as it wants?'),
    (b'nonsense', '{bag} is there, but no page: mission_report: {bag}: ')])
def test_why_there_is_no_report_is_told(monkeypatch, tmp_path, content, said):
    bag = pathlib.Path(tmp_path, 'a.bag')
    with monkeypatch.context() as without_rosbag:
        without_rosbag.setattr(mission_record.subprocess, 'Popen', lambda *_, **__: None)
        record = MissionRecord('rumba', bag)
    if content is not None:
        bag.write_bytes(content)
    with pytest.raises(RecordError) as error:
        record.report()
    assert str(error.value).startswith(said.format(bag=bag)) and '\n' not in str(error.value)


def test_the_true_map_is_recorded_too_and_where_that_of_the_robot_lies_in_it(tmp_path, monkeypatch):
    begun = []
    monkeypatch.setattr(mission_record, '_check_installed', lambda: None)
    monkeypatch.setattr(mission_record.subprocess, 'Popen', lambda command, **_: begun.append(command))
    monkeypatch.setattr(mission_record.rospy, 'resolve_name', lambda name: f'/upstairs/{name}')
    MissionRecord('rumba', tmp_path / 'a.bag')
    assert {'/map', '/tf_static', '/upstairs/simulator/map', '/upstairs/rumba/coverage'} <= set(begun[0])
