"""A run counts only if the node of the robot, and no other one, publishes what the run is judged by."""

import pytest

from rumba_evaluation.verdicts.origins import CLOCK, Origins

COVERAGE, BUMPER, FIELD, STATE = '/rumba/cleaning_status', '/rumba/bumper', '/rumba/odom', '/simulator/state'
SIMULATOR, STUDENT = '/simulator', '/student'


def origins(*publishers, named=(SIMULATOR,), publisher=''):
    """The origins of a run, after pairs of topic and node, and after nodes were named by the state."""
    found = Origins([COVERAGE, BUMPER], STATE, publisher)
    found.watch(FIELD)
    for node in named:
        found.names(node)
    for topic, node in publishers:
        found.publishes(topic, node)
    return found


def test_all_is_well_if_the_node_that_the_state_names_publishes_alone():
    found = origins(*((topic, SIMULATOR) for topic in (COVERAGE, BUMPER, FIELD, STATE, CLOCK)))
    assert found.is_complete and found.problem() == ''


@pytest.mark.parametrize('publishers, topic', [
    ([(COVERAGE, STUDENT)], COVERAGE), ([(BUMPER, SIMULATOR), (BUMPER, STUDENT)], BUMPER),
    ([(STATE, SIMULATOR), (STATE, STUDENT)], STATE), ([(FIELD, STUDENT), (FIELD, SIMULATOR)], FIELD)])
def test_another_node_that_publishes_what_is_judged_is_a_problem(publishers, topic):
    assert origins(*publishers).problem() == f'{topic} is published by {STUDENT}: {SIMULATOR} alone may do that'


def test_all_wrong_nodes_are_named():
    assert 'published by /a and /b: ' in origins((COVERAGE, '/b'), (COVERAGE, SIMULATOR), (COVERAGE, '/a')).problem()


@pytest.mark.parametrize('publishers', [
    [(FIELD, STUDENT)], [(FIELD, STUDENT), (FIELD, '/teleop')], [('/rumba/cmd_vel', STUDENT)],
    [(CLOCK, '/a_clock')]])
def test_a_topic_that_the_node_of_the_robot_does_not_publish_is_free(publishers):
    assert origins(*publishers).problem() == ''


def test_a_node_that_names_itself_in_place_of_the_simulator_is_a_problem():
    assert origins(named=[SIMULATOR, STUDENT]).problem() == (
        f'{STATE} names {SIMULATOR} and {STUDENT}: it must name one node')


def test_a_second_clock_is_a_problem():
    assert origins((CLOCK, STUDENT), (CLOCK, SIMULATOR)).problem() == (
        f'{CLOCK} is published by {SIMULATOR} and {STUDENT}: one node alone may do that')


def test_without_a_state_nobody_knows_who_may_publish():
    found = origins((FIELD, STUDENT), named=[])
    assert found.is_complete and found.problem() == ''
    found.publishes(BUMPER, STUDENT)
    assert not found.is_complete and found.problem() == ''
    assert found.unknown().startswith(f'{BUMPER} is published by {STUDENT}, but no node publishes {STATE}: ')


def test_a_state_is_there_as_soon_as_a_node_publishes_it():
    assert not origins((BUMPER, STUDENT), named=[]).has_state
    assert origins((STATE, SIMULATOR), named=[]).has_state


def test_a_node_that_is_given_needs_no_state():
    assert origins((BUMPER, STUDENT), (STATE, '/other'), named=[], publisher=STUDENT).problem() == ''
    assert origins((BUMPER, STUDENT), named=['/other'], publisher=STUDENT).is_complete
    assert origins((BUMPER, SIMULATOR), named=[SIMULATOR], publisher=STUDENT).problem() == (
        f'{BUMPER} is published by {SIMULATOR}: {STUDENT} alone may do that')
