"""In an examination there is nothing for a node to read or to forge, and an honest one loses nothing by that."""

import json

import pytest
import rosbag
from workspaces import ROOT

EXAMINEES = ROOT / 'test' / 'examinees'
EXERCISE = ROOT / 'rumba_exercises' / '2_bumper'
TIMEOUT = 150.0  # [s]
TEST = '''
    <launch>
      <include file="$(find rumba_sim)/launch/simulator.launch">
        <arg name="map" value="{map}" />
        <arg name="speed" value="0" />
        <arg name="exam" value="true" />
        <arg name="wait_for" value="rumba/cmd_vel judge" />
      </include>
      {nodes}
      <test test-name="exam" name="judge" pkg="rumba_evaluation" type="mission_test" time-limit="100">
        <param name="coverage" value="{coverage}" />
        <param name="reach" value="4 2" />
        <param name="collisions" value="60" />
        <param name="reach_distance" value="5" />
        <param name="time_limit" value="{limit}" />
        <param name="exam" value="true" />
        <param name="recording" value="{bag}" />
      </test>
    </launch>
'''
MANIFEST = ('<package format="2"><name>examinee</name><version>0.0.0</version><description>x</description>'
            '<maintainer email="a@b.c">x</maintainer><license>x</license></package>')


@pytest.fixture
def examined(workspace, tmp_path):
    """A function that has a program examined; returns points and words by condition, and the path of the bag."""
    def examine(program, coverage, limit, nodes=''):
        package, bag = tmp_path / 'examinee', tmp_path / 'exam.bag'
        package.mkdir()
        (package / 'package.xml').write_text(MANIFEST)
        for name, path in (('student', program), ('spy', EXAMINEES / 'spy')):
            (package / name).symlink_to(path)
        launch = tmp_path / 'exam.test'
        launch.write_text(TEST.format(
            map=EXERCISE.parent / 'rooms' / 'room.yaml', coverage=coverage, limit=limit, bag=bag,
            nodes=f'<node name="student" pkg="examinee" type="student" />{nodes}'))
        options = f'--pkgdir={tmp_path} --package=exam --results-base-dir={tmp_path}/results'
        space = workspace.space('devel')
        process = space.start(f'env ROS_PACKAGE_PATH={tmp_path}:$ROS_PACKAGE_PATH ROS_HOME={tmp_path}/home '
                              f'rostest {options} {launch}')
        output, _ = process.communicate(timeout=TIMEOUT)
        results = tmp_path / 'results' / 'exam' / 'rosunit-exam.json'
        assert results.exists(), output
        tests = {test['name']: test for test in json.loads(results.read_text())['tests']}
        return {name: test['score'] for name, test in tests.items()}, {
            name: test.get('output', '') for name, test in tests.items()}, bag
    return examine


def test_an_honest_node_earns_all_points_while_a_spy_hears_nothing_and_the_recording_shows_who_commanded(
        examined, tmp_path):
    heard = tmp_path / 'heard.json'
    points, words, bag = examined(
        EXERCISE / 'solution' / 'bumper_exercise' / 'scripts' / 'cleaner', 0.2, 120,
        f'<node name="spy" pkg="examinee" type="spy" args="{heard}" />')
    assert points == {'coverage': 1.0, 'reach': 1.0, 'collisions': 1.0}, words
    secrets = json.loads(heard.read_text())
    assert secrets.pop('/rumba/bumper') > 0 and not any(secrets.values()), secrets
    with rosbag.Bag(str(bag)) as recording:
        assert {header['callerid'] for _, _, _, header in recording.read_messages(
            '/rumba/cmd_vel', raw=True, return_connection_header=True)} == {b'/student'}
        stamps = [message.header.stamp.to_sec() for _, message, _ in recording.read_messages('/rumba/ground_truth')]
    assert stamps[0] < 0.1 and [round(10.0 * (after - before)) for before, after in zip(stamps, stamps[1:])] == [
        1] * (len(stamps) - 1)


@pytest.mark.thorough
def test_who_tells_the_judge_in_the_name_of_the_simulator_that_all_is_clean_earns_nothing(examined):
    points, words, _ = examined(EXAMINEES / 'forger', 0.2, 30)
    assert points['coverage'] == 0.0 and 'measured 0.0 % after 30.0 s' in words['coverage'], words


@pytest.mark.thorough
def test_who_connects_to_the_private_channel_makes_the_run_void(examined):
    points, words, bag = examined(EXAMINEES / 'intruder', 0.2, 30)
    assert not any(points.values())
    assert 'a second process has connected to the private channel of the simulator' in words['coverage'], words
    with rosbag.Bag(str(bag)) as recording:  # which is finished although the run ended early
        assert recording.get_message_count('/rumba/ground_truth') >= 50
