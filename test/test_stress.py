"""The trial ground finds planted faults and the blow that shows them; and its first seconds, with the real nodes."""

import io
import os
import pathlib
import random
import re
import signal
import subprocess
import sys

import pytest
from workspaces import ROOT

sys.path[:0] = [str(ROOT), str(ROOT / 'bench')]

import planted_faults  # noqa: E402
from common.ros_session import wait_until  # noqa: E402

from stress import growth, printed, report, run, schedule, shrink  # noqa: E402
from stress.blows import KINDS, fresh, messages, repeated  # noqa: E402
from stress.blows.blow import Blow, Kind  # noqa: E402
from stress.failure import Failure  # noqa: E402
from stress.member import Member, Role, Usage  # noqa: E402
from stress.publishers import Publishers  # noqa: E402
from stress.scenarios import Scenario  # noqa: E402

NODE = str(pathlib.Path(__file__).with_name('frail_node.py'))
GUILTY, BLOWS = 2, 4  # the blow that shows a planted fault, and how many there are
PATIENCE = 300.0  # [s] for a run of some seconds


class Frail:
    """A schedule of harmless blows with one among them that the frail node does not bear."""

    def __init__(self, fault):
        self._scenario = Scenario('frail', (Role('/frail', '', NODE, '/rumba/go_to/goal', (fault,), is_world=True,
                                                 pulse='goals'),), ('rumba',))

    def scenario(self, _):
        """The frail node alone."""
        return self._scenario

    def blow(self, seed, number):
        """Messages on cmd_vel if it is the guilty one, else nothing."""
        kind = Kind('guilty', twists, ('frail',)) if number == GUILTY else Kind('harmless', nothing, ('frail',))
        return Blow(number, kind, random.Random(f'{seed} {number}'))


def nothing(_ground, _chance, blow):
    """A blow that is none."""
    blow.say('nothing')


def twists(ground, _chance, blow):
    """Odd messages on cmd_vel."""
    blow.say('odd twists')
    name, kind, subscribers, _ = next(entry for entry in ground.topics() if entry[0] == '/rumba/cmd_vel')
    messages.send(ground, (name, kind, subscribers), random.Random(1), blow)


@pytest.fixture(scope='module')
def publishers():
    """The side of the trial ground that sends."""
    return Publishers()


def verdict(fault, publishers, monkeypatch):
    """What a run over the frail node prints, and how many failures it counts."""
    monkeypatch.setattr('stress.oracles.COMES_BACK_WITHIN', 2.0)
    monkeypatch.setattr('stress.oracles.ANSWERS_WITHIN', 3.0)
    monkeypatch.setattr('stress.oracles.SECONDS_PER_INPUT', 0.001)
    monkeypatch.setattr('stress.world.MOVES_WITHIN', 3.0)
    stream = io.StringIO()
    told = report.Report(5, 600.0, stream)
    run.Run(5, told, publishers, make=Frail(fault)).strike(range(BLOWS))
    told.summary()
    return stream.getvalue(), told.failures


@pytest.mark.thorough(except_for=['raises-traceback: /frail: .*ValueError: a planted fault'])
@pytest.mark.parametrize('fault, seen', [
    ('dies', r'ended: /frail: exit code 0: it printed nothing'),
    ('leaks', r'leak: /frail: \d+ files of which \d+ sockets'),
    ('leaks-threads', r'leak: /frail: \d+ files of which \d+ sockets, 2\d\d threads'),
    ('leaks-memory', r'leak: /frail: \d+ files of which \d+ sockets, \d+ threads, [34]\d\d MB'),
    ('below-zero', r'sane: world: charge of rumba is -0.1\d*, capacity 2.'),
    ('overfull', r'sane: world: charge of rumba is 2.\d*, capacity 2.\d*'),
    ('no-number', r'sane: world: charge of rumba is nan, capacity 2.'),
    ('too-clean', r'sane: world: coverage of rumba is 1.1'),
    ('backwards', r'sane: world: distance of rumba is -1.0'),
    ('nowhere', r'sane: world: pose of rumba is \(inf, '),
    ('floods', r'flood: /frail: \d+ lines: a planted fault'),
    ('long-line', r'long line: /frail: 5000 characters: yyy'),
    ('escape', r"escape: /frail: '\\x1b\[2J'"),
    ('silent', r'silent: ground: getPid of'),
    ('hangs', r'goal: /frail: no result of 1 goals of go_to'),
    ('forgets', r'lost: world: charge of rumba jumped from 2.0 to 0.1'),
    ('stops', r'time: world: stands still at tick'),
    ('raises', r'traceback: /frail: .*ValueError: a planted fault'),
])
def test_a_planted_fault_is_found_and_the_blow_that_shows_it(fault, seen, publishers, monkeypatch):
    text, failures = verdict(fault, publishers, monkeypatch)
    assert failures == 1
    assert re.search(f'FAILED, seed 5, blow {GUILTY}\n  asked: guilty: odd twists\n  seen:  {seen}', text), text
    assert f'the shortest sequence that shows it:\n    {GUILTY}: guilty: odd twists\n' in text
    assert f'./rumba stress --seed 5 --only {GUILTY}\n' in text


class Dripping(Frail):
    """A schedule with a blow that does one thing over and over."""

    def blow(self, seed, number):
        """Goals that are refused, again and again."""
        kind = Kind('again and again', repeated.again, ('frail',))
        return Blow(number, kind, random.Random(f'{seed} {number}'))


@pytest.mark.thorough(except_for=['drips-files-fds'])
@pytest.mark.parametrize('fault, seen', [
    ('drips-files', 'fds'), ('drips-sockets', 'fds'), ('drips-threads', 'threads'), ('drips-memory', 'megabytes'),
    ('none', None)])
def test_what_each_goal_leaves_behind_is_found_although_it_is_little(fault, seen, publishers, monkeypatch):
    """One file descriptor for each goal; what a node may hold more than at its start is 90 of them."""
    monkeypatch.setattr(repeated, 'DEEDS', repeated.DEEDS[:1])
    monkeypatch.setattr('stress.goals.cancel_all', lambda _: None)
    stream = io.StringIO()
    told = report.Report(5, 600.0, stream)
    run.Run(5, told, publishers, make=Dripping(fault)).only([0])
    text = stream.getvalue()
    assert told.failures == (seen is not None), text
    if seen:
        assert re.search(f'seen:  growth: /frail: each 60 goals that are refused leave something behind: {seen} ', text)


@pytest.mark.parametrize('series, is_leak', [
    ([10, 70, 130, 190], True), ([10, 25, 40, 55], True), ([10, 24, 38, 52], False),  # 14 of 60: not each time
    ([10, 70, 130, 130], False), ([10, 500, 501, 502], False), ([10, 90, 20, 100], False), ([10, 10, 10, 10], False)])
def test_growth_is_a_leak_if_it_is_the_same_each_time(series, is_leak):
    held = [{'/node': Usage(fds=fds, sockets=5, threads=9, megabytes=50.0)} for fds in series]
    if not is_leak:
        growth.check(held, 60, 'goals')
    else:
        with pytest.raises(Failure, match=rf'^growth: /node: each 60 goals leave something behind: fds {series[0]}, '):
            growth.check(held, 60, 'goals')


@pytest.mark.parametrize('megabytes, is_leak', [([50.0, 51.2, 52.4, 53.6], True), ([50.0, 50.4, 50.8, 51.2], False)])
def test_memory_grows_too(megabytes, is_leak):
    held = [{'/node': Usage(20, 5, 9, amount)} for amount in megabytes]
    if not is_leak:
        growth.check(held, 60, 'goals')
    else:
        with pytest.raises(Failure, match='megabytes 50, 51, 52, 54$'):
            growth.check(held, 60, 'goals')


def test_each_round_has_each_kind_of_blow_that_fits_its_ground():
    for number, scenario in enumerate(schedule.ROUNDS):
        first = number * schedule.ROUND
        kinds = {schedule.blow(7, blow).kind.name for blow in schedule.round_of(first)}
        assert kinds == {kind.name for kind in KINDS if scenario.name in kind.scenarios}


def test_every_kind_of_blow_and_of_node_is_on_some_ground():
    assert {name for kind in KINDS for name in kind.scenarios} == {scenario.name for scenario in schedule.ROUNDS}
    programs = {role.program for scenario in schedule.ROUNDS for role in scenario.roles}
    assert programs >= {'simulator', 'cleaner', 'viewer', 'page', 'localiser', 'mapper', 'turtlesim_body'}


def test_there_is_a_planted_fault_for_each_kind_of_blow():
    assert {planted.blow for planted in planted_faults.FAULTS} == {kind.name for kind in KINDS}
    assert len(planted_faults.FAULTS) >= 20


@pytest.mark.thorough
def test_a_fault_that_is_planted_into_a_real_node_is_found(publishers):
    """The bench plants one for each kind of blow."""
    planted = next(each for each in planted_faults.FAULTS if each.fault == 'charge_below_zero')
    seconds, seen = planted_faults.search(planted, 1, publishers)
    assert seconds is not None and seen.startswith('sane: world: charge of rumba is -0.1'), seen


def test_a_node_without_a_fault_passes(publishers, monkeypatch):
    text, failures = verdict('none', publishers, monkeypatch)
    assert failures == 0
    assert text.endswith('0 failures\n') and re.search(rf'all +{BLOWS} +{messages.MESSAGES:,} +0\n', text), text


@pytest.mark.parametrize('needed', [[7], [3, 7], [0, 4, 7], [1, 2, 7]])
def test_the_shortest_sequence_is_found(needed):
    tried = []

    def shows(numbers):
        tried.append(numbers)
        return set(needed) <= set(numbers)

    assert shrink.shortest(list(range(8)), shows, 60.0) == (needed, True)
    assert len(tried) < 40


def test_what_does_not_show_again_is_kept_whole():
    assert shrink.shortest([1, 2, 3], lambda _: False, 60.0) == ([1, 2, 3], False)


OURS = '/ws/src/rumba_sim/src/rumba_sim/ros/x.py'
ROSPY = '/usr/lib/python3/dist-packages/rospy'


@pytest.mark.parametrize('lines, oracle', [
    (['[INFO] [1.0]: ready', '\x1b[33m[WARN] [1.0]: slow\x1b[0m', 'battery 9 %\x1b[K'], None),
    (['[WARN] [1.0]: Inbound TCP/IP connection failed: \x1b[2J', 'y' * 5000], None),
    (['[WARN] [1.0]: Inbound TCP/IP connection failed: x', '[WARN] [1.0]: ' + 'y' * 5000], 'long line'),
    (['[ERROR] [1.0]: no map \x1b[2J'], 'escape'),
    (['[ERROR] [1.0]: no'] * 201, 'flood'),
    (['Traceback (most recent call last):', f'  File "{ROSPY}/impl/tcpros_base.py", line 1, in x', '    raise',
      'IOError', '', printed.CHAINED, ''] * 201, None),
    (['Traceback (most recent call last):', f'  File "{ROSPY}/impl/tcpros_base.py", line 1, in x', 'IOError',
      '[ERROR] [1.0]: no'] * 201, 'flood'),
    (['Traceback (most recent call last):', f'  File "{ROSPY}/topics.py", line 1, in x', 'IOError'], None),
    (['Traceback (most recent call last):', f'  File "{ROSPY}/topics.py", line 1, in x',
      f'  File "{OURS}", line 1, in x', 'IOError'], 'traceback'),
    (['Traceback (most recent call last):', '  File "/usr/lib/python3.11/threading.py", line 1, in _bootstrap_inner',
      f'  File "{ROSPY}/timer.py", line 1, in run', 'IOError'], 'traceback'),
    (['Traceback (most recent call last):', '  File "/usr/lib/python3.11/threading.py", line 1, in _bootstrap_inner',
      f'  File "{ROSPY}/impl/tcpros_service.py", line 1, in handle', 'IOError'], None),
    (['Traceback (most recent call last):', '  File "/usr/lib/python3.11/threading.py", line 1, in _bootstrap_inner',
      'battery 100 %   at (2.45, 0.18) m', f'  File "{ROSPY}/impl/tcpros_service.py", line 1, in handle',
      'rospy.exceptions.TransportException: receive_once'], None),
])
def test_what_a_node_prints_is_judged(lines, oracle):
    if oracle is None:
        printed.check('/node', lines, 200)
    else:
        with pytest.raises(Failure, match=f'^{oracle}: /node: '):
            printed.check('/node', lines, 200)


def stress(*arguments):
    """Exit code, output and error output of `./rumba stress` in the workspace of these tests."""
    path = os.pathsep.join([str(ROOT), str(ROOT / 'bench'), os.environ.get('PYTHONPATH', '')])
    done = subprocess.run([sys.executable, '-m', 'stress', *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True, timeout=PATIENCE, env={**os.environ, 'PYTHONPATH': path})
    return done.returncode, done.stdout, done.stderr


@pytest.mark.parametrize('arguments, said', [
    (['0'], "MINUTES: '0': must be a number of minutes above 0"), (['nan'], "MINUTES: 'nan': must be a number"),
    (['soon'], "MINUTES: 'soon': must be a number"), (['--seed', 'x'], "--seed: invalid int value: 'x'"),
    (['--only', '1,-2'], "--only: '1,-2': must be numbers of blows with commas between them, as in 12,17,18"),
    (['--only', ''], "--only: '': must be numbers"), (['--ground', 'moon'], "--ground: invalid choice: 'moon'"),
    (['--nothing'], 'unrecognized arguments: --nothing')], ids=str)
def test_wrong_arguments_are_refused(arguments, said):
    code, out, error = stress(*arguments)
    assert (code, out) == (2, '')
    assert error.startswith('usage: ./rumba stress') and said in error.splitlines()[-1] and error.count('\n') == 3


@pytest.mark.thorough
def test_the_real_nodes_bear_the_first_ten_seconds():
    code, out, error = stress('0.17', '--seed', '1')
    assert code == 0, out + error
    assert out.startswith('seed 1\n') and out.endswith('\n0 failures\n')


def test_the_page_names_every_kind_of_blow():
    table = (ROOT / 'docs' / 'reliability.md').read_text().partition('| blow |')[2].partition('\n\n')[0]
    assert re.findall(r'^\| `([^`]+)` \|', table, re.MULTILINE) == [kind.name for kind in KINDS]


@pytest.mark.parametrize('fails_if_ended', [True, False])
def test_only_a_test_may_end_with_a_failure_after_a_signal(fails_if_ended, tmp_path):
    script = tmp_path / 'fails'
    script.write_text("#!/bin/sh\ntrap 'exit 1' INT\necho ready\nwhile :; do sleep 0.1; done\n")
    script.chmod(0o755)
    member = Member(Role('fails', '', str(script), fails_if_ended=fails_if_ended), os.environ, tmp_path)
    member.start()
    wait_until(lambda: 'ready' in member.last)
    if fails_if_ended:
        assert fresh.ends(member, signal.SIGINT) == 1
    else:
        with pytest.raises(Failure, match='end: fails: ends with exit code 1 after SIGINT'):
            fresh.ends(member, signal.SIGINT)
