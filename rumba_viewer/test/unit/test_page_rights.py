"""What clients of the page may reach, with which token, from which origin."""

import pytest

from rumba_sim.model.common.errors import ConfigError
from rumba_viewer.page.allow_list import AllowList, Rights, Tokens, is_loopback, is_origin_allowed, robot_tokens
from rumba_viewer.page.messages.errors import Refusal

EVERYTHING, NOTHING = Rights(everything=True), Rights()


@pytest.mark.parametrize('what, name, robot', [
    ('read', '/map', None), ('read', '/simulator/map', None),
    ('read', '/rumba2/scan', '/rumba2'), ('write', '/rumba/teleop/cmd_vel', '/rumba'),
    ('write', '/rumba/go_to/goal', '/rumba'), ('call', '/rumba/set_brushes_up', '/rumba'),
    ('call', '/simulator/reset', None)])
def test_what_the_page_needs_is_allowed_and_belongs_to_its_robot(what, name, robot):
    assert AllowList().robot(what, name) == robot


@pytest.mark.parametrize('what, name', [
    ('read', '/rosout'), ('write', '/clock'), ('write', '/rumba/odom'), ('call', '/rosout/set_logger_level'),
    ('call', '/rumba/teleport'), ('call', '/simulator/kill'), ('read', '/a/b/scan'), ('read', '/rumba/scan/more')])
def test_whatever_else_is_on_the_master_is_not(what, name):
    with pytest.raises(Refusal, match=f"'{name}' cannot be .* the allow-list of this page does not name it"):
        AllowList().robot(what, name)


def test_names_begin_in_the_namespace_of_the_node():
    upstairs = AllowList('/upstairs/')
    assert upstairs.robot('write', '/upstairs/rumba/cmd_vel') == '/upstairs/rumba'
    with pytest.raises(Refusal):
        upstairs.robot('write', '/rumba/cmd_vel')


def test_more_can_be_allowed_and_the_defaults_left_out():
    allowed = AllowList(defaults=False, read=['/chatter', '*/camera'])
    assert allowed.robot('read', '/chatter') is None and allowed.robot('read', '/rumba/camera') == '/rumba'
    for what, name in (('read', '/map'), ('write', '/chatter')):
        with pytest.raises(Refusal):
            allowed.robot(what, name)


@pytest.mark.parametrize('pattern', ['/a b', '/a/*b', 'x(.*)', '/', '/.*'])
def test_a_pattern_that_is_no_name_is_refused(pattern):
    with pytest.raises(ConfigError, match='cannot be allowed: must be a name such as'):
        AllowList(read=[pattern])


def test_without_tokens_everybody_may_change_everything():
    assert Tokens().rights(None) == EVERYTHING


def test_a_token_permits_everything_or_one_robot_and_none_only_to_watch():
    tokens = Tokens('teacher', robot_tokens('rumba:blue, rumba2:green', '/'))
    assert tokens.rights('teacher') == EVERYTHING and tokens.rights(None) == NOTHING
    blue = tokens.rights('blue')
    assert [blue.may_change(robot) for robot in ('/rumba', '/rumba2', None)] == [True, False, False]
    for wrong in ('', 'blu', 'Teacher', '/rumba', 'ä'):
        with pytest.raises(Refusal, match='^wrong token'):
            tokens.rights(wrong)


@pytest.mark.parametrize('text', ['rumba', 'rumba:', ':blue', 'a b:blue', 'rumba:blue,rumba:green'])
def test_robot_tokens_of_another_form_are_refused(text):
    with pytest.raises(ConfigError, match='robot_tokens'):
        robot_tokens(text, '/')


def test_tokens_that_contradict_each_other_are_refused():
    with pytest.raises(ConfigError, match='but no token'):
        Tokens('', {'/rumba': 'blue'})
    with pytest.raises(ConfigError, match='the same'):
        Tokens('blue', {'/rumba': 'blue'})


@pytest.mark.parametrize('origin, is_allowed', [
    (None, True), ('http://host:8080', True), ('HTTP://HOST:8080', True), ('http://host:8081', False),
    ('http://evil.example', False), ('null', False), ('http://lab.example.org', True)])
def test_only_the_page_itself_and_named_origins_may_connect(origin, is_allowed):
    assert is_origin_allowed(origin, 'host:8080', ['http://*.example.org']) == is_allowed


@pytest.mark.parametrize('address, expected', [
    ('127.0.0.1', True), ('127.1.2.3', True), ('localhost', True), ('::1', True), ('0.0.0.0', False),
    ('192.168.0.7', False), ('127.0.0.1.evil.example', False)])
def test_a_loopback_address_is_told_from_others(address, expected):
    assert is_loopback(address) == expected
