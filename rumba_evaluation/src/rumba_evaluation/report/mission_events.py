"""What happened during a mission, in order of time."""

from __future__ import annotations

import math
from typing import Iterator, List, NamedTuple, Tuple

from rumba_evaluation.report.mission_record import (CLEANING, IDLE, STRANDED, MissionRecord, Series, charging_spans,
                                                    leaps, rises, spans, state_spans)

LOW, WELL = 10.0, 12.0  # [%] a battery below LOW is worth a word, and is so again once it was at WELL
FEW_BUMPS = 12  # more are told in one line
NEAR = 0.15  # [m] contacts of one dock are not farther apart


class Event(NamedTuple):
    """Something that happened at a time [s]; `kind` is one word: what it is about."""

    time: float
    kind: str
    text: str


def events(record: MissionRecord) -> List[Event]:
    """What happened, from the first to the last moment."""
    found = [Event(0.0, 'recording', f'The recording begins at {_place(record, 0.0)}, {_charge(record, 0.0)}.')]
    for part in (_dock, _charges, _states, _bumps, _leaps, _low, _falls):
        found += part(record)
    found.sort(key=lambda event: event.time)
    end = record.duration
    return found + [Event(end, 'recording', f'The recording ends at {_place(record, end)}, {_charge(record, end)}.')]


def _place(record: MissionRecord, time: float) -> str:
    x, y = record.path.at(time)
    return f'({x:.2f}, {y:.2f}) m'


def _charge(record: MissionRecord, time: float) -> str:
    return f'battery {record.charge.at(time):.0f} %'


def _dock(record: MissionRecord) -> Iterator[Event]:
    last = record.docked.times[-1] if len(record.docked.times) else 0.0
    for number, (begin, end) in enumerate(spans(record.docked)):
        if number > 0 or begin > record.docked.times[0]:
            yield Event(begin, 'dock', f'Docked, {_charge(record, begin)}.')
        if end < last:
            yield Event(end, 'dock', f'Undocked, {_charge(record, end)}.')


def _charges(record: MissionRecord) -> Iterator[Event]:
    for begin, end in charging_spans(record):
        yield Event(begin, 'charge', f'Charging began, {_charge(record, begin)}.')
        if end < record.duration - 1.0:
            yield Event(end, 'charge', f'Charging ended, {_charge(record, end)}.')


def _states(record: MissionRecord) -> Iterator[Event]:
    for time, _, state in state_spans(record):
        strategy = f' ({state.strategy})' if state.strategy and state.state == CLEANING else ''
        # When the state changes the message is still about what was before, but where all is over.
        message = f': {state.message}' if state.message and state.state in (IDLE, STRANDED) else ''
        yield Event(time, 'mission', f'Mission: {state.name}{strategy}{message}')


def _bumps(record: MissionRecord) -> Iterator[Event]:
    times = rises(record.pressed)
    if len(times) > FEW_BUMPS:
        yield Event(float(times[0]), 'bump', f'The first of {len(times)} bumps, at {_place(record, times[0])}; '
                                             'the map shows where all were.')
    else:
        for time in times.tolist():
            yield Event(time, 'bump', f'Bump at {_place(record, time)}.')


def _leaps(record: MissionRecord) -> Iterator[Event]:
    for index in leaps(record.path):
        (left, bottom), (x, y) = record.path.values[index - 1:index + 1]
        yield Event(float(record.path.times[index]), 'place',
                    f'Put elsewhere: from ({left:.2f}, {bottom:.2f}) m to ({x:.2f}, {y:.2f}) m.')


def _low(record: MissionRecord) -> Iterator[Event]:
    is_low = False
    for time, percent in zip(*(part.tolist() for part in record.charge)):
        if percent < LOW and not is_low:
            yield Event(time, 'battery', f'Battery below {LOW:.0f} %.')
        is_low = percent < LOW or is_low and percent < WELL


def _falls(record: MissionRecord) -> Iterator[Event]:
    for begin, _ in spans(record.fallen):
        yield Event(begin, 'cliff', f'A wheel hangs over a cliff at {_place(record, begin)}.')


def contacts(record: MissionRecord) -> List[Tuple[float, float]]:
    """Where the robot closed the contacts of a dock [m], once a dock."""
    found: List[Tuple[float, float]] = []
    for begin, _ in spans(record.docked):
        place = record.path.at(begin).tolist()
        if all(math.dist(place, other) > NEAR for other in found):
            found.append((place[0], place[1]))
    return found


def bump_places(record: MissionRecord) -> Series:
    """When and where the bumper was pressed, (n, 2) [m]."""
    times = rises(record.pressed)
    return Series(times, record.path.at(times))
