"""The figures of a mission, and how it ended in a sentence."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Optional, Tuple

import numpy as np

from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.mission.stages import State
from rumba_evaluation.report.mission_record import (MOVING, MissionRecord, Series, charging_spans, clock, jumps, rises,
                                                    state_spans, steps)
from rumba_sim.model.settings.robot_config import BrushConfig

OWN_ACCOUNT = re.compile(r'^[\d.]+ % swept(?:[:;,] |$)')  # with which a message begins: one figure is enough
CLOSE = 5e-4  # of coverage: by so much the account of a robot may differ from the truth, rounded as it is shown


@dataclass(frozen=True)
class Summary:
    """A mission in figures; None: not recorded."""

    duration: float  # [s]
    busy: Optional[float]  # [s] during which the mission was not idle
    ideal_time: Optional[float]  # [s] for one brush to sweep the reachable floor at the cleaning speed, without overlap
    distance: float  # [m]
    driving_time: float  # [s]
    mean_speed: Optional[float]  # [m/s] while it drove
    coverage: Optional[float]  # [0..1]
    areas: Optional[Tuple[float, float]]  # swept, and within reach [m^2]
    charges: int  # during the mission, if its states were recorded
    charging_time: float  # [s]
    charge: Tuple[float, float, float]  # at the beginning, at the end, lowest [%]
    energy: Optional[Tuple[float, float]]  # used, and charged [Wh]
    bumps: Optional[int]
    jumps: int
    outcome: str


def summary(record: MissionRecord) -> Summary:
    """The figures of a mission."""
    step, gap = steps(record.path)
    driven = np.ones(len(step), bool)
    driven[jumps(record.path) - 1] = False
    moving = driven & (step > MOVING * gap)
    distance, driving_time = float(step[driven].sum()), float(gap[moving].sum())
    charge = record.charge.values
    return Summary(
        record.duration, _busy(record), ideal_time(record), distance, driving_time,
        distance / driving_time if driving_time > 0.0 else None,
        float(record.coverage.values[-1]) if len(record.coverage.times) else None, record.areas,
        _charges(record), sum(end - begin for begin, end in charging_spans(record)),
        (float(charge[0]), float(charge[-1]), float(charge.min())), _energy(record.power),
        len(rises(record.pressed)) if len(record.pressed.times) else None, len(step) - int(driven.sum()),
        _outcome(record))


def _busy(record: MissionRecord) -> Optional[float]:
    found = state_spans(record)
    return sum(end - begin for begin, end, state in found if state.state != State.IDLE) if found else None


def ideal_time(record: MissionRecord) -> Optional[float]:
    """Time for one brush to sweep the reachable floor at the cleaning speed, without any overlap [s]."""
    return record.areas[1] / (BrushConfig().width * CleaningConfig().speed) if record.areas else None


def _charges(record: MissionRecord) -> int:
    """How often the mission stopped to charge, as the cleaner counts: its last return to the dock is none."""
    if not record.states:
        return len(charging_spans(record))
    states = [state.state for _, _, state in state_spans(record) if state.state != State.YIELDING]
    return sum(state == State.CHARGING != before for before, state in zip([None, *states], states))


def _energy(power: Series) -> Optional[Tuple[float, float]]:
    """Used, and charged [Wh], by the trapezoidal rule."""
    if not len(power.times):
        return None
    used, charged = (float(np.sum(0.5 * (part[1:] + part[:-1]) * np.diff(power.times))) / 3600.0
                     for part in (np.maximum(-power.values, 0.0), np.maximum(power.values, 0.0)))
    return used, charged


# --- how it ended ---------------------------------------------------------------------------------------------------

def _outcome(record: MissionRecord) -> str:
    """How the mission ended, in a sentence; empty if no state was recorded."""
    if not record.states:
        return ''
    last, busy = record.states[-1], _busy(record) or 0.0
    swept = f'{100.0 * record.coverage.values[-1]:.1f} % of the floor' if len(record.coverage.times) else 'the floor'
    said = next((state.message for state in reversed(record.states) if state.message), '')
    if all(state.state == State.IDLE for state in record.states):
        return 'The robot had no mission while this was recorded.'
    if last.state == State.STRANDED:
        return f'The robot is stranded after {clock(busy)}: {said or "it does not say why"}.'
    if last.state != State.IDLE:
        return (f'The recording ends before the mission, after {clock(busy)}: {swept} is swept, '
                f'the robot is {last.name}.')
    where = ' and is back on its dock' if len(record.docked.times) and record.docked.values[-1] > 0.5 else ''
    if not len(record.coverage.times):
        return f'The mission ended after {clock(busy)}{f": {said}" if said else ""}.'
    if record.coverage.values[-1] + CLOSE >= record.target:
        return f'The robot swept {swept} in {clock(busy)}{where}: the target was {100.0 * record.target:g} %.'
    said = OWN_ACCOUNT.sub('', said)
    return (f'The robot swept {swept} in {clock(busy)}{where}, less than the target of {100.0 * record.target:g} %'
            f'{f": {said}" if said else ""}.')
