"""When a node registers again: the master forgets it as a whole, or but for what it has registered since."""

import pytest
import rosgraph

from rumba_sim.model.common.errors import WorldError
from rumba_sim.ros.running import master_watch

HERE = 'http://localhost:1/'


class Master:
    """A master that can be restarted, and stop to answer.

    Attributes:
        pid: of its process.
        uri: where it says that the node is; empty if it does not know the node.
        answers: whether it does.
    """

    def __init__(self):
        self.pid, self.uri, self.answers = 7, HERE, True

    def getPid(self):
        """The method of its API."""
        if not self.answers:
            raise OSError('timed out')
        return self.pid

    def lookupNode(self, name):
        """The method of its API."""
        if not self.uri:
            raise rosgraph.MasterError(f'unknown node {name}')
        return self.uri


@pytest.fixture
def master(monkeypatch):
    """The master of the node."""
    master = Master()
    monkeypatch.setattr(master_watch.peers, 'hasty_master', lambda _: master)
    return master


@pytest.fixture
def done(monkeypatch, master):
    """What the node does because of its master."""
    done = []
    rospy = master_watch.rospy
    monkeypatch.setattr(rospy, 'get_name', lambda: '/node')
    monkeypatch.setattr(rospy.core, 'get_node_uri', lambda: HERE)
    monkeypatch.setattr(rospy.core, 'is_shutdown_requested', lambda: False)
    for level in ('logwarn', 'logfatal'):
        monkeypatch.setattr(rospy, level, lambda _: None)
    monkeypatch.setattr(rospy, 'signal_shutdown', lambda _: done.append('ends'))
    monkeypatch.setattr(master_watch, '_register_again', lambda: done.append('registers'))
    monkeypatch.setattr(master_watch, '_before_return', [lambda: done.append('checks')])
    monkeypatch.setattr(master_watch, '_after_return', [lambda: done.append('repairs')])
    return done


@pytest.fixture
def watch(done):
    """A watch that has looked once at the master where its node registered."""
    watch = master_watch.MasterWatch()
    watch.look()
    assert not done
    return watch


def test_a_master_that_knows_the_node_is_left_alone(watch, done):
    watch.look()
    assert not done


def test_at_a_new_master_the_node_registers_again_once(watch, master, done):
    master.uri = ''
    watch.look()
    master.uri = HERE
    watch.look()
    assert done == ['checks', 'registers', 'repairs']


def test_at_a_new_master_that_knows_only_a_newer_part_of_the_node_all_of_it_registers_again(watch, master, done):
    master.pid = 8
    watch.look()
    watch.look()
    assert done == ['registers', 'repairs']


def test_a_master_that_is_restarted_while_the_node_registers_is_noticed(watch, master, done, monkeypatch):
    def restart():
        master.pid, master.uri = master.pid + 1, HERE
        monkeypatch.setattr(master_watch, '_register_again', lambda: done.append('registers'))
    monkeypatch.setattr(master_watch, '_register_again', restart)
    master.pid, master.uri = 8, ''
    watch.look()
    watch.look()
    assert done == ['checks', 'repairs', 'registers', 'repairs']


def test_a_master_that_does_not_answer_in_time_is_asked_again(watch, master, done):
    master.answers = False
    watch.look()
    assert not done
    master.answers, master.uri = True, ''
    watch.look()
    assert 'registers' in done


def test_a_check_that_fails_ends_the_node(watch, master, done, monkeypatch):
    def refuse():
        raise WorldError('another one')
    monkeypatch.setattr(master_watch, '_before_return', [refuse])
    master.uri = ''
    watch.look()
    assert done == ['ends']


def test_another_node_of_the_same_name_ends_this_one(watch, master, done):
    master.uri = 'http://localhost:2/'
    watch.look()
    assert done == ['ends']
