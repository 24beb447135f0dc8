"""Odd messages do not disturb the judge of a run: whatever comes, there is a verdict in one short line."""

import odd_messages
import pytest

from rumba_evaluation.ros.mission_monitor import TOPICS
from rumba_evaluation.verdicts.mission_requirements import Requirements
from rumba_evaluation.verdicts.mission_verdict import Judge

REQUIREMENTS = Requirements(coverage=0.5, reach='1 2 0.5', docked=True, battery=20.0, collisions=3)


@pytest.mark.parametrize('condition, kind, value', [
    pytest.param(condition, kind, value, id=f'{condition.name}-{topic}')
    for condition in REQUIREMENTS.conditions() for topic, kind, value in TOPICS[type(condition)]])
def test_any_message_can_be_judged(condition, kind, value):
    judge = Judge([condition], 10.0)
    for message in odd_messages.all_of(kind(), seed=14):
        judge.is_over = False  # judge every message
        judge.update(condition, value(message), 1.0)
    [verdict] = judge.verdicts(lambda _: '')
    assert len(verdict.words) < 300 and '\n' not in verdict.words
