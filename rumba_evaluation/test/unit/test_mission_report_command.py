"""The command mission_report."""

import os
import pathlib
import re
import subprocess
import sys

import genpy
import mission_bags
import pytest
import rosbag
from mission_bags import EVENTS, LEAST, write

from rumba_evaluation.ros.mission_report import mission_bag, mission_report
from rumba_msg.msg import CleanActionGoal, CleanGoal, CleaningStatus

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / 'scripts' / 'mission_report'


@pytest.fixture(scope='module')
def bag(tmp_path_factory):
    """The whole mission."""
    return write(tmp_path_factory.mktemp('bag') / 'a <b> & c.bag')


def test_the_command_writes_beside_the_bag_and_needs_no_master(bag):
    output = bag.replace('.bag', '.html')
    done = subprocess.run([sys.executable, str(SCRIPT), bag], env={**os.environ, 'ROS_MASTER_URI': 'http://nowhere:1'},
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
    assert (done.returncode, done.stderr) == (0, '')
    assert done.stdout.splitlines() == [
        output, 'The robot swept 90.0 % of the floor in 0:00:34 and is back on its dock, less than the target of '
                '99 %: 90.0 % swept <&>.',
        'rumba: 90.0 % swept, 25.0 % of the dirt left, 12.0 m driven at 0.50 m/s, bumps: 3',
        'battery: 100 % to 58 %, lowest 8 %, charges during the mission: 1, on the charger for 0:00:10 in all']
    page = pathlib.Path(output).read_text(encoding='utf-8')
    assert '<title>Mission of rumba: a &lt;b&gt; &amp; c.bag</title>' in page
    assert '90.0 % swept &lt;&amp;&gt;' in page and '<&>' not in page
    for text in ('>90.0 %<', '>18.0 of 20.0 m², target 99 %<', '>0:00:34<', '>ideal: 0:06:32, recorded: 0:00:36<',
                 '>12.0 m<', '>0.50 m/s while driving<', '>during the mission; on the charger for 0:00:10 in all<',
                 '<dt>Charges</dt><dd>1<', '>0.20 Wh<', '<dt>Dirt left</dt><dd>25.0 %<', '>from 100 %, lowest 8 %<',
                 '<dt>Bumps</dt><dd>3<', '2.0 m × 1.5 m, cells of 50 cm',
                 'cleaning 0:00:17', '100.0 s after the simulation began'):
        assert text in page, text
    told = re.findall(r'<td>(\d:\d\d:\d\d)</td><td>(.*?)</td>', page)
    assert [text for _, text in told] == [text.replace('<&>', '&lt;&amp;&gt;') for _, text in EVENTS]
    assert told[3][0] == '0:00:05'


def test_the_command_writes_to_the_given_path(bag, tmp_path, capsys):
    output = tmp_path / 'page'
    mission_report.main([bag, '--output', str(output), '--robot', 'rumba'])
    first = output.read_bytes()
    mission_report.main([bag, '--output', str(output)])
    assert capsys.readouterr().out.splitlines()[0] == str(output)
    assert output.read_bytes() == first, 'the same bag gives the same page'


def test_with_two_robots_page_and_summary_have_the_figures_of_both(tmp_path, capsys):
    path = write(tmp_path / 'two.bag')
    with rosbag.Bag(path, 'a') as two:
        mission_bags.add(two, LEAST, '/rumba2', until=10.0)
    mission_report.main([path])
    told = capsys.readouterr().out.splitlines()[1:]
    assert [line for line in told if ' driven' in line] == [
        'rumba: 90.0 % swept, 25.0 % of the dirt left, 12.0 m driven at 0.50 m/s, bumps: 3',
        'rumba2: coverage not recorded, 4.0 m driven at 0.50 m/s']
    text = (tmp_path / 'two.html').read_text()
    assert '<section class="team" tabindex="0" ' in text  # it scrolls on a phone
    rows = re.findall(r'<tr>(.*?)</tr>', text[text.index('<h2>Robots</h2>'):text.index('<h2>Path</h2>')])
    cells = [re.findall(r'<td>(.*?)</td>', row) for row in rows[1:]]
    assert [row[:3] for row in cells] == [['rumba', '0:00:34', '12.0 m'], ['rumba2', 'not recorded', '4.0 m']]
    assert cells[0][6].startswith('The robot swept 90.0 %') and cells[1][6] == 'not recorded'


def test_without_matplotlib_the_message_names_the_package(tmp_path):
    script = ('import sys; sys.modules["matplotlib"] = None; '
              'from rumba_evaluation.ros.mission_report import mission_report; mission_report.main()')
    done = subprocess.run([sys.executable, '-c', script, write(tmp_path / 'a.bag', LEAST, until=1.0)],
                          env={**os.environ, 'PYTHONPATH': os.pathsep.join(sys.path)}, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, universal_newlines=True)
    assert (done.returncode, done.stdout) == (2, '')
    assert re.fullmatch('mission_report: the figures need matplotlib .*: install the package python3-matplotlib\n',
                        done.stderr)


def test_help_names_every_option(capsys):
    with pytest.raises(SystemExit) as end:
        mission_report.main(['--help'])
    told = capsys.readouterr().out
    assert end.value.code == 0 and all(word in told for word in ('FILE.bag', '--output', '--robot', '--target'))


def test_the_target_is_that_of_the_recorded_goal_unless_it_is_given(tmp_path):
    path = write(tmp_path / 'a.bag')
    assert mission_bag.read(path).target == 0.99
    with rosbag.Bag(path, 'a') as bag:
        for target in (0.8, 0.9, 0.0):
            bag.write('/rumba/clean/goal', CleanActionGoal(goal=CleanGoal(target_coverage=target)), genpy.Time(101))
    assert mission_bag.read(path).target == 0.9 and mission_bag.read(path, target=0.5).target == 0.5


def test_topics_with_several_publishers_are_named(tmp_path):
    path = write(tmp_path / 'a.bag', LEAST)
    with rosbag.Bag(path, 'a') as bag:
        for node in ('/simulator', '/student'):
            message = CleaningStatus(coverage=float(node == '/student'))
            bag.write('/rumba/cleaning_status', message, genpy.Time(110), connection_header={
                'topic': '/rumba/cleaning_status', 'type': message._type, 'md5sum': message._md5sum,
                'message_definition': message._full_text, 'callerid': node})
            bag._topic_connections.clear()  # else it writes a connection for each topic, not for each publisher
    assert mission_bag.read(path).remarks == [
        '/rumba/cleaning_status was published by /simulator and /student: the figures mix their messages.']
