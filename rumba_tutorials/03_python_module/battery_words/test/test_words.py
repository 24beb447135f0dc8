"""The words change at the right charges."""

import types

import pytest

from battery_words import words


@pytest.mark.parametrize('percentage, word', [(0, 'empty'), (1, 'low'), (20, 'low'), (21, 'good'), (99, 'good'),
                                              (100, 'full')])
def test_level(percentage, word):
    assert words.level(percentage) == word


@pytest.mark.parametrize('brushes_up, brushes', [(True, 'lifted'), (False, 'on the floor')])
def test_describe(brushes_up, brushes):
    status = types.SimpleNamespace(percentage_battery=7, brushes_up=brushes_up)
    assert words.describe(status) == f'low: 7 %, brushes {brushes}'
