"""The codes of Python are those of the messages."""

import pathlib
import re

import pytest

from rumba_cleaning.mission.stages import State
from rumba_cleaning.outcome import Outcome

MESSAGES = pathlib.Path(__file__).resolve().parents[3] / 'rumba_msg' / 'msg'


@pytest.mark.parametrize('codes, message', [(Outcome, 'Outcome'), (State, 'MissionStatus')])
def test_the_codes_are_the_constants_of_the_message(codes, message):
    constants = re.findall(r'^uint8 (\w+) = (\d+)', (MESSAGES / f'{message}.msg').read_text(), re.MULTILINE)
    assert len(constants) > 5
    assert {code.name: code.value for code in codes} == {name: int(value) for name, value in constants}
