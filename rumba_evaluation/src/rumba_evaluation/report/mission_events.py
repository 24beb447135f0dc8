"""The events of a mission, in order of time."""

from __future__ import annotations

import math
from typing import Iterator, List, NamedTuple, Tuple

import numpy as np

from rumba_cleaning.mission.stages import State
from rumba_evaluation.report.mission_record import (MissionRecord, MissionState, Series, charging_spans, clock, jumps,
                                                    rises, spans, state_spans)

LOW, RECOVERED = 10.0, 12.0  # [%] a charge below LOW is an event; the next one needs a charge of RECOVERED before
FEW_BUMPS = 3  # more bumps of one state of the mission are counted in one event
TOGETHER = 3.0  # [s] what happens within this time is one event: to dock and to charge, to undock and to say so
NEAR = 0.15  # [m] contacts that are farther apart belong to different docks


class Event(NamedTuple):
    """Something that happened at a time [s]; `kind` is one word for the subject."""

    time: float
    kind: str
    text: str


def events(record: MissionRecord) -> List[Event]:
    """All events from the beginning to the end of a recording."""
    found = [Event(0.0, 'recording', f'The recording begins at {_position(record, 0.0)}, {_charge(record, 0.0)}.')]
    for part in (_stays, _charges, _states, _bumps, _jumps, _low, _falls):
        found += part(record)
    found.sort(key=lambda event: event.time)
    end = record.duration
    return found + [Event(end, 'recording', f'The recording ends at {_position(record, end)}, {_charge(record, end)}.')]


def _position(record: MissionRecord, time: float) -> str:
    x, y = record.path.at(time)
    return f'({x:.2f}, {y:.2f}) m'


def _charge(record: MissionRecord, time: float) -> str:
    return f'battery {record.charge.at(time):.0f} %'


def _stays(record: MissionRecord) -> Iterator[Event]:
    """Each stay on the dock, with the charge that began or ended with it."""
    last = record.docked.times[-1] if len(record.docked.times) else 0.0
    charges = charging_spans(record)
    for number, (begin, end) in enumerate(spans(record.docked)):
        if number > 0 or begin > record.docked.times[0]:
            is_charged = any(_are_together(begin, start) for start, _ in charges)
            yield Event(begin, 'dock', f'Docked{" and charging" if is_charged else ""}, {_charge(record, begin)}.')
        if end < last:
            charged = sum(stop - start for start, stop in charges if _are_together(stop, end))
            yield Event(end, 'dock', f'Left the dock{f" after {clock(charged)} of charging" if charged else ""}, '
                                     f'{_charge(record, end)}.')


def _charges(record: MissionRecord) -> Iterator[Event]:
    """Charges that neither begin nor end with a stay on the dock."""
    edges = [edge for span in spans(record.docked) for edge in span]
    for begin, end in charging_spans(record):
        if not any(_are_together(begin, edge) for edge in edges):
            yield Event(begin, 'charge', f'Charging began, {_charge(record, begin)}.')
        if end < record.duration - 1.0 and not any(_are_together(end, edge) for edge in edges):
            yield Event(end, 'charge', f'Charging ended, {_charge(record, end)}.')


def _are_together(one: float, other: float) -> bool:
    return abs(one - other) <= TOGETHER


def _states(record: MissionRecord) -> Iterator[Event]:
    """The states of the mission, without those that a stay on the dock tells of, or that hardly last."""
    found = state_spans(record)
    edges = [edge for span in spans(record.docked) for edge in span]
    for number, (time, end, state) in enumerate(found):
        is_last = number == len(found) - 1
        is_told = (state.state in (State.UNDOCKING, State.CHARGING) and any(time - TOGETHER <= edge <= end + TOGETHER
                                                                            for edge in edges)
                   or state.state == State.DOCKING and number > 0 and found[number - 1][2].state == State.RETURNING
                   or state.state == State.IDLE and end - time <= TOGETHER)
        if is_last or not is_told:
            yield Event(time, 'mission', _told(state, is_last and number > 0))


def _told(state: MissionState, is_end: bool) -> str:
    # At a change of state the message still describes the state before, except at the end of a mission.
    message = f': {state.message}' if state.message and state.state in (State.IDLE, State.STRANDED) else ''
    if state.state == State.IDLE and is_end:
        return f'The mission ends{message}'
    strategy = f' ({state.strategy})' if state.strategy and state.state == State.CLEANING else ''
    return f'Mission: {state.name}{strategy}{message}'


def _bumps(record: MissionRecord) -> Iterator[Event]:
    """The bumps of each state of the mission: each of them, or the first with their number."""
    times = rises(record.pressed)
    edges = [time for time, _, _ in state_spans(record)]
    for group in np.split(times, np.searchsorted(times, edges)):
        if len(group) > FEW_BUMPS:
            yield Event(float(group[0]), 'bump', f'The first of {len(group)} bumps until {clock(group[-1])}, at '
                                                 f'{_position(record, group[0])}; the map shows all of them.')
        else:
            for time in group.tolist():
                yield Event(time, 'bump', f'Bump at {_position(record, time)}.')


def _jumps(record: MissionRecord) -> Iterator[Event]:
    for index in jumps(record.path):
        (left, bottom), (x, y) = record.path.values[index - 1:index + 1]
        yield Event(float(record.path.times[index]), 'jump',
                    f'Moved without driving: from ({left:.2f}, {bottom:.2f}) m to ({x:.2f}, {y:.2f}) m.')


def _low(record: MissionRecord) -> Iterator[Event]:
    is_low = False
    for time, percent in zip(*(part.tolist() for part in record.charge)):
        if percent < LOW and not is_low:
            yield Event(time, 'battery', f'Battery below {LOW:.0f} %.')
        is_low = percent < LOW or is_low and percent < RECOVERED


def _falls(record: MissionRecord) -> Iterator[Event]:
    for begin, _ in spans(record.fallen):
        yield Event(begin, 'cliff', f'A wheel hangs over a cliff at {_position(record, begin)}.')


def contacts(record: MissionRecord) -> List[Tuple[float, float]]:
    """Where the robot touched the contacts of a dock [m], once for each dock."""
    found: List[Tuple[float, float]] = []
    for begin, _ in spans(record.docked):
        x, y = record.path.at(begin).tolist()
        if all(math.dist((x, y), other) > NEAR for other in found):
            found.append((x, y))
    return found


def bump_positions(record: MissionRecord) -> Series:
    """When and where the bumper was pressed, (n, 2) [m]."""
    times = rises(record.pressed)
    return Series(times, record.path.at(times))
