"""A mission is recorded from a press of the button to another one, or to its end, and a report is made of it."""

import dataclasses
import pathlib
import subprocess
import time

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


def follow(opened, *robots, selected='rumba'):
    """Have the window show robots, and follow them."""
    opened.show(snapshot(*robots, selected=selected))
    opened.window.update_picture()


ENDED = robot(mission=IDLE, report=('ended',))
HINT = 'Report [Ctrl+B] {}.'


def test_each_mission_is_recorded_with_all_robots_and_the_card_offers_the_report_of_it(opened, tmp_path):
    other = robot('rumba2', mission=IDLE)
    for shown in (robot(mission=CLEANING), robot(mission=CLEANING), ENDED, ENDED):
        follow(opened, shown, other)
    assert opened.actor.recorded == [('record_mission', ['rumba', 'rumba2'], False)]
    assert opened.actor.done == [('end_recording',)]
    assert opened.window.floor.hint == HINT.format('makes a page of this mission')
    opened.type(Qt.Key_B, Qt.ControlModifier)
    (what, bag), made = opened.actor.done[1:]
    assert (what, bag.parent, bag.suffix, made) == ('keep_recording', tmp_path, '.bag', ('make_report', 'rumba'))
    assert not opened.window.panel.buttons['report'].isChecked()
    follow(opened, robot(mission=CLEANING), other)
    assert len(opened.actor.recorded) == 2


def test_a_report_that_is_asked_for_during_a_mission_is_made_at_its_end(opened):
    button = opened.window.panel.buttons['report']
    follow(opened, robot(mission=CLEANING))
    assert not button.isChecked()
    opened.window.act('report')
    assert button.isChecked() and button.text() == '0:00'
    opened.window.reports._begun -= 83.0
    opened.window.update_picture()
    assert button.text() == '1:23' and done(opened) == ['keep_recording']
    follow(opened, robot(mission=IDLE))  # the figures of the end are still to come
    assert done(opened) == ['keep_recording']
    follow(opened, ENDED)
    assert done(opened)[1:] == ['end_recording', 'make_report'] and not button.isChecked() and button.text() == 'Report'


def test_a_report_that_is_asked_for_twice_is_made_at_once_and_no_second_recording_begins(opened):
    follow(opened, robot(mission=CLEANING))
    opened.window.act('report')
    opened.window.act('report')
    assert done(opened) == ['keep_recording', 'end_recording', 'make_report']
    follow(opened, robot(mission=CLEANING))
    assert len(opened.actor.recorded) == 1


def test_the_button_records_what_is_no_mission_too_and_a_mission_that_ended_before_does_not_end_it(opened):
    follow(opened, ENDED)
    assert opened.window.floor.hint == HINT.format('records the next mission and makes a page of it')
    opened.window.act('report')
    follow(opened, ENDED)
    assert opened.actor.done[0] == ('record_mission', ['rumba'], True) and opened.window.reports.is_asked
    opened.window.act('report')
    assert done(opened) == ['record_mission', 'keep_recording', 'end_recording', 'make_report']


def test_the_recording_goes_on_while_another_robot_is_selected(opened):
    follow(opened, robot(mission=CLEANING), robot('rumba2', mission=CLEANING))
    follow(opened, robot(mission=CLEANING), robot('rumba2', mission=IDLE, report=('ended',)), selected='rumba2')
    assert opened.actor.done == []
    follow(opened, ENDED, robot('rumba2', mission=IDLE, report=('ended',)), selected='rumba2')
    opened.window.act('report')
    assert opened.actor.done[-1] == ('make_report', 'rumba2')


def test_what_cannot_be_recorded_or_kept_is_not(opened):
    opened.actor.can_record = False
    follow(opened, robot(mission=CLEANING))
    follow(opened, robot(mission=CLEANING))
    assert len(opened.actor.recorded) == 1  # tried once
    opened.window.act('report')
    assert opened.actor.done == [('record_mission', ['rumba'], True)] and not opened.window.reports.is_asked
    opened.actor.can_record, opened.actor.can_keep = True, False
    opened.window.act('report')
    assert not opened.window.reports.is_asked and not opened.window.panel.buttons['report'].isChecked()


def test_the_card_says_where_the_report_is(opened):
    follow(opened, ENDED)
    before = opened.picture()
    opened.actor.report = 'The report is /tmp/rumba.html'
    opened.show(dataclasses.replace(opened.window.snapshot))
    assert opened.window.floor.hint == opened.actor.report
    assert opened.picture() != before


# --- the bag ----------------------------------------------------------------------------------------------------------

@pytest.fixture
def begun(monkeypatch, tmp_path):
    """The commands that recordings begin with: none of them runs, and their folders are in a folder of the test."""
    commands = []
    monkeypatch.setattr(mission_record, '_check_installed', lambda: None)
    monkeypatch.setattr(mission_record.subprocess, 'Popen', lambda command, **_: commands.append(command))
    monkeypatch.setattr(mission_record.rospy, 'resolve_name', lambda name: f'/upstairs/{name}')
    monkeypatch.setattr(mission_record.tempfile, 'tempdir', str(tmp_path))
    return commands


@pytest.mark.parametrize('package, source', mission_record.NEEDED.items())
def test_what_is_not_installed_is_named_if_a_person_asked(monkeypatch, package, source):
    def get_path(_, name):
        if name == package:
            raise rospkg.ResourceNotFound(name)
    monkeypatch.setattr(rospkg.RosPack, 'get_path', get_path)
    actor = Actor('rumba')
    assert not actor.record_mission(['rumba'], False) and actor.notices.empty()
    assert not actor.record_mission(['rumba'], True)
    assert actor.notices.get() == f'report: needs the package {package}: install {source}'
    actor.end_recording()
    actor.make_report('rumba')
    assert actor.notices.empty() and actor.report == ''


def test_a_folder_that_is_a_file_is_refused(begun, tmp_path):
    (tmp_path / 'taken').write_text('')
    actor = Actor('rumba')
    assert actor.record_mission(['rumba'], False)
    assert not actor.keep_recording(tmp_path / 'taken' / 'a.bag')
    told = actor.notices.get()
    assert told.startswith('report: cannot be saved: ') and told.endswith("/taken'")


def test_a_recording_is_deleted_unless_it_was_to_stay(begun, tmp_path):
    folders = set(tmp_path.iterdir())
    for kept in (False, True):
        actor = Actor('rumba')
        assert actor.record_mission(['rumba'], False)
        actor._record.bag.write_text('recorded')
        if kept:
            assert actor.keep_recording(tmp_path / 'pictures' / 'a.bag')
        actor.close()
        assert (tmp_path / 'pictures' / 'a.bag').exists() == kept
    assert {path.name for path in set(tmp_path.iterdir()) - folders} == {'pictures'}


def test_a_recording_that_nobody_wants_ends_at_once_with_all_its_processes(monkeypatch, tmp_path):
    monkeypatch.setattr(mission_record, '_check_installed', lambda: None)
    monkeypatch.setattr(mission_record.rospy, 'resolve_name', lambda name: f'/{name}')
    command = ['sh', '-c', 'trap "" INT; sleep 600 & echo on; wait']  # as rosbag, it has a process of its own
    popen = subprocess.Popen
    monkeypatch.setattr(mission_record.subprocess, 'Popen', lambda _, **__: popen(
        command, stdout=subprocess.PIPE, start_new_session=True))
    record = MissionRecord(['rumba'])
    output = record._process.stdout
    assert output.readline() == b'on\n'
    begin = time.monotonic()
    record.discard()
    assert output.read() == b''  # all that had it open have ended
    assert time.monotonic() - begin < mission_record.CLOSES_WITHIN


@pytest.mark.parametrize('content, said', [
    (None, 'rosbag wrote no {bag}: is there a gigabyte of space, as it wants?'),
    (b'nonsense', '{bag} is there, but no page: mission_report: {bag}: ')])
def test_why_there_is_no_report_is_told(monkeypatch, tmp_path, content, said):
    bag = pathlib.Path(tmp_path, 'a.bag')
    with monkeypatch.context() as without_rosbag:
        without_rosbag.setattr(mission_record.subprocess, 'Popen', lambda *_, **__: None)
        record = MissionRecord(['rumba'])
    record.keep_as(bag)
    if content is not None:
        record.bag.write_bytes(content)
    with pytest.raises(RecordError) as error:
        record.report('rumba')
    assert str(error.value).startswith(said.format(bag=bag)) and '\n' not in str(error.value)


def test_all_robots_are_recorded_and_the_true_map_and_where_that_of_a_robot_lies_in_it(begun):
    MissionRecord(['rumba', 'rumba2'])
    assert {'/map', '/tf_static', '/upstairs/simulator/map', '/upstairs/rumba/coverage',
            '/upstairs/rumba2/coverage'} <= set(begun[0])
