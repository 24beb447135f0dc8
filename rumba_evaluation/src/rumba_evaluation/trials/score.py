"""Scores of paths and of missions, by the same measures: as a table for people, and as JSON for programs."""

import dataclasses
import json
import math
import statistics
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Sequence

import numpy as np

from rumba_evaluation.scoring.measures import Event, Measures
from rumba_evaluation.scoring.ride import Ride
from rumba_evaluation.trials import table
from rumba_evaluation.trials.cases import LEVELS, Case, Result
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.common.geometry import TURN

PLACES = 10  # of one kind that a person wants to read


@dataclasses.dataclass(frozen=True)
class Score:
    """How one drive went."""

    case: Case  # the file of a path takes the place of the strategy
    result: Result
    measures: Measures


class Column(NamedTuple):
    """A column of the table of measures: the median of the drives."""

    title: str
    value: Callable[[Score], float]
    decimals: int


COLUMNS = (
    Column('length m', lambda score: score.measures.path_length, 1),
    Column('turns', lambda score: score.measures.turns, 0),
    Column('turned rad', lambda score: score.measures.turned_angle, 1),
    Column('in turns s', lambda score: score.measures.time_in_turns, 1),
    Column('overlap', lambda score: score.measures.overlap_ratio, 3),
    Column('revisit', lambda score: score.measures.revisit_ratio, 3),
    Column('collisions', lambda score: len(score.measures.collisions), 0),
    Column('near misses', lambda score: len(score.measures.near_misses), 0),
    Column('Wh', lambda score: score.result.energy, 2),
    Column('missed cells', lambda score: score.measures.cells_never_reached, 0),
    Column('missed m2', lambda score: missed_area(score.measures), 2),
    Column('total s', lambda score: score.result.time, 0))


def missed_area(measures: Measures) -> float:
    """Area of the cells that were never reached [m^2]."""
    return sum(patch.area for patch in measures.never_reached)


def of_ride(case: Case, ride: Ride) -> Score:
    """The score of a drive that has ended."""
    floor, meter, measures, start = ride.world.floor, ride.meter, ride.observer.measures(), Pose(*ride.observer.path[0])
    area = floor.cleaned_area
    result = Result(
        outcome=ride.outcome, message=ride.message, area=floor.reachable_area, ideal_time=ride.ideal_time,
        coverage=floor.coverage, dirt_left=floor.dirt_left, time=ride.time, charging_time=0.0, charges=0,
        distance=measures.path_length, turns=measures.turned_angle / TURN, collisions=ride.robot.bumps,
        charge_used=meter.charge, energy=meter.energy, energy_per_area=meter.energy / area if area > 0.0 else np.nan,
        docked=int(ride.robot.is_docked), penetrated=meter.penetrated, x=start.x, y=start.y, theta=start.theta,
        ticks=ride.world.tick, digest=ride.world.digest(), curve=tuple(ride.curve))
    return Score(case, result, measures)


# --- for people ---------------------------------------------------------------------------------------------------

def text(scores: Sequence[Score]) -> str:
    """The time to coverage as in the table of missions, and a table of the measures."""
    groups: Dict[table.Group, List[Score]] = {}
    for score in scores:
        groups.setdefault(table.group(score.case), []).append(score)
    results = {name: [score.result for score in members] for name, members in groups.items()}
    rows = [['map', 'strategy', 'robots', 'least %', *(column.title for column in COLUMNS)]]
    for name, members in groups.items():
        rows.append([*map(str, name), table.least(results[name]), *(
            f'{statistics.median(column.value(score) for score in members):.{column.decimals}f}'
            for column in COLUMNS)])
    return f'{table.times(results)}\nLeast coverage, and medians of the runs\n{table.aligned(rows)}'


def places(score: Score) -> str:
    """How a drive ended, and where it collided, nearly did, and missed floor: a line for each place."""
    measures = score.measures
    lines = ['', f'{score.result.outcome.words}: {score.result.message}']
    for what, found in (('collision', measures.collisions), ('near miss', measures.near_misses)):
        lines += [f'{what} at ({event.x:.2f}, {event.y:.2f}) m after {event.time:.1f} s: {_gap(event)}, for '
                  f'{event.duration:.1f} s' for event in found[:PLACES]]
        lines += _more(found)
    lines += [f'never reached: {patch.area:.3f} m2 about ({patch.x:.2f}, {patch.y:.2f}) m'
              for patch in measures.never_reached[:PLACES]]
    lines += _more(measures.never_reached)
    return '\n'.join(lines) + '\n'


def _gap(event: Event) -> str:
    return f'{-event.gap:.3f} m deep' if event.gap < -0.0005 else f'{max(event.gap, 0.0):.3f} m from the wall'


def _more(found: Sequence[Any]) -> List[str]:
    return [f'... and {len(found) - PLACES} more'] if len(found) > PLACES else []


# --- for programs -------------------------------------------------------------------------------------------------

def document(case: Case, result: Result, measures: Optional[Measures] = None) -> Dict[str, Any]:
    """A result, and measures if there are any, as keys with their units and plain values; None for never or unknown."""
    values: Dict[str, Any] = {**case._asdict(), **dataclasses.asdict(result), 'outcome': result.outcome.name.lower()}
    values['time_to_s'] = {str(percent): result.time_to(percent) for percent in LEVELS}
    values['time_to_T'] = {str(percent): result.multiple_to(percent) for percent in LEVELS}
    if measures is not None:
        # `collisions` of a mission are presses of its bumper; here they are contacts, with their places.
        values['bumps'], values['rotations'] = values.pop('collisions'), values.pop('turns')
        values.update(dataclasses.asdict(measures))
        for name in ('collisions', 'near_misses', 'never_reached'):
            values[name] = [item._asdict() for item in getattr(measures, name)]
        values['area_never_reached'] = missed_area(measures)
    return {name: _plain(value) for name, value in values.items()}


def _plain(value: Any) -> Any:
    """A value with None for each number that JSON does not know."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def as_json(documents: Any) -> str:
    """Strictly valid JSON that ends with a line break."""
    return json.dumps(documents, allow_nan=False, indent=2) + '\n'
