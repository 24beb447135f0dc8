"""What the page remembers of addresses: wrong tokens and refusals, by a clock that the test sets."""

from rumba_viewer.page import addresses
from rumba_viewer.page.addresses import GUESS_PERIOD, GUESSES, LINE_PERIOD, LINES, LINES_OF_ALL, Addresses, Guesses


def test_few_wrong_tokens_can_be_tried_at_once_and_then_one_after_the_other():
    guesses, tried = Guesses(0.0), 0
    for second in range(1000):
        for number in range(100):
            if not guesses.wait(f'{second} {number}', float(second)):
                guesses.add(f'{second} {number}', float(second))
                tried += 1
    assert GUESSES + 999 / GUESS_PERIOD - 1 < tried <= GUESSES + 999 / GUESS_PERIOD
    assert 0.0 < guesses.wait('right', 999.0) <= GUESS_PERIOD


def test_the_same_wrong_token_again_is_no_new_guess():
    guesses = Guesses(0.0)
    for _ in range(1000):
        assert not guesses.wait('old', 0.0)
        guesses.add('old', 0.0)
    assert not guesses.wait('new', 0.0)


def test_an_address_gets_few_lines_of_the_log_and_the_others_are_counted():
    now, lines = [0.0], []
    known = Addresses(lambda: now[0], lines.append)
    for number in range(1000):
        known.note(known.find('10.0.0.1'), f'no {number}')
    known.note(known.find('10.0.0.2'), 'no\nway')
    assert lines == [f'client at 10.0.0.1: no {number}' for number in range(LINES)] + [r'client at 10.0.0.2: no\nway']
    known.flush()
    assert len(lines) == LINES + 1
    now[0] = LINE_PERIOD
    known.flush()
    assert lines[-1] == f'client at 10.0.0.1: no 999 ({1000 - LINES - 1} more were refused before)'
    known.flush()
    assert len(lines) == LINES + 2


def test_many_addresses_together_cannot_fill_the_log():
    lines = []
    known = Addresses(lambda: 0.0, lines.append)
    for number in range(1000):
        known.note(known.find(f'10.0.{number // 250}.{number % 250}'), 'no')
    assert len(lines) == LINES_OF_ALL


def test_addresses_without_connections_are_forgotten_the_oldest_first(monkeypatch):
    monkeypatch.setattr(addresses, 'REMEMBERED', 3)
    known = Addresses(lambda: 0.0, print)
    first, second = known.find('1'), known.find('2')
    first.streams['connection'] = None
    for name in ('3', '4'):
        known.find(name)
    assert known.find('1') is first and known.find('2') is not second
