"""A bounded behaviour ends in time, and when the battery is empty."""

import pytest

from rumba_cleaning.behaviour import STOP, Behaviour, Command, Observation, Status
from rumba_cleaning.behaviours.bounded import Bounded
from rumba_cleaning.outcome import Outcome
from rumba_sim.model.common.geometry import Pose

DOCK = Pose(3.8, 1.2, 0.0)


class Forever(Behaviour):
    """Goes ahead, until it notes something."""

    def __init__(self):
        self.ends, self.noted = 0, []

    def update(self, observation):
        """Ahead."""
        self.message = 'ahead'
        return self.fail('noted', Outcome.BLOCKED) if self.noted else Command(0.1, 0.0)

    def terminate(self):
        """Count."""
        self.ends += 1

    def take_note(self, observation):
        """Remember."""
        self.noted.append(observation)


def test_what_does_not_end_is_given_up_after_its_time():
    bounded = Bounded(Forever(), 5.0)
    answers = [bounded.step(Observation(0.1, DOCK)) for _ in range(60)]
    assert answers.index(STOP) == 50
    assert (bounded.status, bounded.message) == (Status.FAILED, 'not done after 5 s: ahead')
    assert bounded.outcome is Outcome.TIMED_OUT and bounded.behaviour.ends == 1


def test_what_runs_out_of_charge_is_given_up():
    bounded = Bounded(Forever(), 5.0)
    assert bounded.step(Observation(0.1, DOCK, state_of_charge=0.0)) == STOP
    assert (bounded.status, bounded.message) == (Status.FAILED, 'the battery is empty')
    assert bounded.outcome is Outcome.BATTERY_EMPTY


def test_what_ends_by_itself_ends_as_it_says():
    bounded = Bounded(Forever(), 5.0)
    bounded.step(Observation(0.1, DOCK))
    bounded.stand_by(Observation(0.1, DOCK))
    bounded.step(Observation(0.1, DOCK))
    assert (bounded.status, bounded.message, bounded.outcome) == (Status.FAILED, 'noted', Outcome.BLOCKED)
    assert bounded.behaviour.ends == 1


def test_the_time_in_which_a_person_drives_counts():
    bounded = Bounded(Forever(), 5.0)
    bounded.step(Observation(0.0, DOCK))
    seen = [Observation(0.5, DOCK)] * 20
    for observation in seen:
        bounded.stand_by(observation)
    assert bounded.status is Status.RUNNING and bounded.behaviour.noted == seen
    bounded.step(Observation(0.1, DOCK))
    assert bounded.outcome is Outcome.TIMED_OUT and bounded.time == pytest.approx(10.1)


def test_what_is_stopped_stops_the_other_one():
    bounded = Bounded(Forever(), 5.0)
    bounded.step(Observation(0.1, DOCK))
    bounded.stop()
    assert bounded.behaviour.ends == 1


def test_restarted_it_has_all_its_time_again():
    bounded = Bounded(Forever(), 5.0)
    for _ in range(60):
        bounded.step(Observation(0.1, DOCK))
    bounded.restart()
    assert bounded.step(Observation(0.1, DOCK)) != STOP
    assert bounded.status is Status.RUNNING
