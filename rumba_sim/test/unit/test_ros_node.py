"""How a node reads its command line and its parameters, without a master."""

import os
import queue
import signal
import subprocess
import sys

import pytest

from rumba_sim.model.common.errors import ConfigError
from rumba_sim.ros.running import node
from rumba_sim.ros.simulator.settings import Settings


def given(monkeypatch, private):
    """Let the parameter server hold a value as the private parameters of /simulator."""
    monkeypatch.setattr(node.rospy, 'get_param', lambda *_: private)
    monkeypatch.setattr(node.rospy, 'get_name', lambda: '/simulator')


@pytest.mark.parametrize('value, message', [
    (['a'], r"config is \['a'\]: must be text$"), (5, 'config is 5: must be text$'),
    ({'a': 1}, 'config is .*: must be text$'), (True, 'config is True: must be text$')])
def test_a_config_that_is_no_path_is_refused_and_not_opened(monkeypatch, value, message):
    given(monkeypatch, {'config': value})
    with pytest.raises(ConfigError, match='^parameter of /simulator: ' + message):
        node._parameters(Settings, [])


@pytest.mark.parametrize('arguments, told', [
    ([], 'speed: 3, state: \'x\''), (['_speed:=3'], "state: 'x'"), (['_speed:=3', '_state:=x'], ''),
    (['__log:=/tmp/x'], '')], ids=str)
def test_parameters_of_an_earlier_start_are_named(monkeypatch, arguments, told):
    given(monkeypatch, {'speed': 3, 'state': 'x'})
    lines = []
    monkeypatch.setattr(node.rospy, 'loginfo', lines.append)
    monkeypatch.setattr(node.sys, 'argv', ['simulator', *arguments])
    assert node._parameters(Settings, []).speed == 3.0
    assert lines == ([f'the master keeps parameters of an earlier start, which hold for this one too: {told}; '
                      '`rosparam delete /simulator` forgets them'] if told else [])


def test_what_a_deleted_parameter_left_behind_is_not_named(monkeypatch):
    lines = []
    monkeypatch.setattr(node.rospy, 'loginfo', lines.append)
    monkeypatch.setattr(node.sys, 'argv', ['simulator'])
    node._tell_of_parameters_from_before({'drive': {}})
    assert not lines


@pytest.mark.parametrize('value', ['text', 5, ['a'], 1.5, True])
def test_parameters_that_are_no_mapping_are_refused(monkeypatch, value):
    given(monkeypatch, value)
    with pytest.raises(ConfigError, match='^parameter /simulator is .*: must be a mapping of '):
        node._parameters(Settings, [])


@pytest.mark.parametrize('argument', [
    '_seed:=99999999999999999999999', '_seed:=2147483648', '_seed:=' + 5000 * '9', '_map:=null', '_map:={1: 2}',
    '_map:=[', r'_map:="\x01"', '_map:=&a [*a]', '_battery/drain:=99999999999999999999999'])
def test_a_value_that_the_parameter_server_cannot_take_is_refused(monkeypatch, argument):
    monkeypatch.setattr(node.sys, 'argv', ['simulator', argument])
    with pytest.raises(ConfigError, match='cannot be a parameter: ') as caught:
        node._check_command_line([], ['map', 'seed'])
    assert str(caught.value).startswith(argument.split(':=')[0] + ':=') and len(str(caught.value)) <= 300


@pytest.mark.parametrize('argument', ['_seed:=2147483647', '_map:=studio', '_battery/drain:=1e3', '__name:=99999999999',
                                      '_rates:={scan: 5}'])
def test_other_values_are_fine(monkeypatch, argument):
    monkeypatch.setattr(node.sys, 'argv', ['simulator', argument])
    node._check_command_line([], ['map', 'seed'])


def test_a_signal_during_the_registration_ends_the_node_too(monkeypatch):
    """rospy's own handlers may wait for ever then, for a lock that the main thread holds."""
    reasons, options = queue.Queue(), {}

    def register(_, **given_options):
        options.update(given_options)
        os.kill(os.getpid(), signal.SIGTERM)

    monkeypatch.setattr(node.rospy, 'init_node', register)
    monkeypatch.setattr(node.rospy, 'signal_shutdown', reasons.put)
    monkeypatch.setattr(node.clock, 'guard', lambda: None)
    monkeypatch.setattr(node.master_watch, 'start', lambda: None)
    monkeypatch.setattr(node, '_log_trouble_once', lambda _: None)
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        node._register('talker', own_clock=False, is_single=False)
        assert reasons.get(timeout=10.0) == f'signal {signal.SIGTERM.value}'
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    assert options == {'disable_rostime': False, 'disable_signals': True}


INTERRUPTED = '''
import os, signal
import rosgraph
from rumba_sim.ros.running import node

calls = []

def is_master_online():
    calls.append(1)
    try:
        if len(calls) == 1:
            os.kill(os.getpid(), signal.SIGINT)
        return True
    except:
        return False

rosgraph.is_master_online = is_master_online
node._wait_for_master('no master')
print('goes on')
'''


def test_ctrl_c_ends_a_node_also_while_it_asks_for_the_master():
    """rosgraph takes the KeyboardInterrupt for a no, and the node went on once the master answered."""
    done = subprocess.run([sys.executable, '-c', INTERRUPTED], stdout=subprocess.PIPE, universal_newlines=True)
    assert (done.returncode, done.stdout) == (-signal.SIGINT, '')


@pytest.mark.parametrize('argument', ['--help', '--config'])
def test_whoever_reads_only_the_beginning_of_a_help_ends_it_quietly(argument):
    """As `| head -1` does; a pipe that nobody reads any more is an error."""
    code = 'import sys; from rumba_sim.ros.simulator import simulator; sys.argv[1:] = sys.stdin.read().split(); ' \
           'simulator.main()'
    with subprocess.Popen([sys.executable, '-c', code], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, universal_newlines=True) as process:
        process.stdout.close()
        process.stdin.write(argument)
        process.stdin.close()
        assert process.stderr.read() == ''
        assert process.wait(60.0) == 0
