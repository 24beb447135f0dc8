"""Results as tables for people, and coverage over time as a table for programs."""

import csv
import math
import statistics
from typing import Dict, Iterable, List, NamedTuple, Sequence

from rumba_evaluation.trials.cases import LEVELS, Case, Result

TEXTS = ('map', 'strategy', 'outcomes')  # columns that are aligned to the left
NEVER = '-'


class Effort(NamedTuple):
    """A column of the second table."""

    title: str
    field: str  # of a result
    factor: float
    decimals: int


EFFORTS = (
    Effort('dirt %', 'dirt_left', 100.0, 1), Effort('distance m', 'distance', 1.0, 0), Effort('turns', 'turns', 1.0, 0),
    Effort('collisions', 'collisions', 1.0, 0), Effort('charges', 'charges', 1.0, 0),
    Effort('Wh/m2', 'energy_per_area', 1.0, 3), Effort('total s', 'time', 1.0, 0))


class Group(NamedTuple):
    """The missions of one row of the tables."""

    map: str
    strategy: str
    robots: int


def group(case: Case) -> Group:
    """The row that a case belongs to."""
    return Group(case.map, case.strategy, case.robots)


def grouped(cases: Sequence[Case], found: Dict[Case, Result]) -> Dict[Group, List[Result]]:
    """Results by group, in the order of the cases; cases without a result are left out."""
    groups: Dict[Group, List[Result]] = {}
    for case in cases:
        if case in found:
            groups.setdefault(group(case), []).append(found[case])
    return groups


def text(groups: Dict[Group, List[Result]]) -> str:
    """Two tables: the time to coverage with the outcomes, and the effort."""
    efforts = [['map', 'strategy', 'robots', 'least %', *(effort.title for effort in EFFORTS), 'in walls']]
    for name, results in groups.items():
        penetrated = sum(result.penetrated for result in results)
        efforts.append([*map(str, name), least(results), *(_median(results, effort) for effort in EFFORTS),
                        str(penetrated)])
    return (f'{times(groups)}\nLeast coverage, medians of the runs, and runs in which a robot was in a wall\n'
            f'{aligned(efforts)}')


def times(groups: Dict[Group, List[Result]]) -> str:
    """A table of the time to coverage with the outcomes."""
    ideal = {name.map: results[0] for name, results in groups.items()}
    floors = ', '.join(f'{name} {result.ideal_time:.0f} s ({result.area:.1f} m2)' for name, result in ideal.items())
    rows = [['map', 'strategy', 'robots', 'runs', *(f'{percent} %' for percent in LEVELS), 'failed', 'outcomes']]
    for name, results in groups.items():
        failed = sum(result.has_failed for result in results)
        rows.append([*map(str, name), str(len(results)), *(_median_and_worst(results, percent) for percent in LEVELS),
                     str(failed), _outcomes(results)])
    return f'Working time to coverage in multiples of T, median and worst of the runs; T: {floors}\n{aligned(rows)}'


def least(results: Iterable[Result]) -> str:
    """The least coverage of some runs [%]."""
    return f'{100.0 * min(result.coverage for result in results):.1f}'


def _outcomes(results: Sequence[Result]) -> str:
    """How often each outcome occurred, in the order of their codes."""
    found = [result.outcome for result in results]
    return ', '.join(f'{found.count(outcome)} {outcome.words}' for outcome in sorted(set(found)))


def _median_and_worst(results: Iterable[Result], percent: int) -> str:
    multiples = [result.multiple_to(percent) for result in results]
    return f'{_multiple(statistics.median(multiples)):>5} {_multiple(max(multiples)):>5}'


def _multiple(value: float) -> str:
    return f'{value:.2f}' if math.isfinite(value) else NEVER


def _median(results: Iterable[Result], effort: Effort) -> str:
    values = [effort.factor * getattr(result, effort.field) for result in results]
    known = [value for value in values if not math.isnan(value)]
    return f'{statistics.median(known):.{effort.decimals}f}' if known else NEVER


def aligned(rows: Sequence[Sequence[str]]) -> str:
    """Rows, the first of them titles, as lines with columns below one another."""
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    lines = ['  '.join(cell.ljust(width) if title in TEXTS else cell.rjust(width)
                       for title, cell, width in zip(rows[0], row, widths)) for row in rows]
    return ''.join(f'{line.rstrip()}\n' for line in lines)


def write_curves(path: str, cases: Sequence[Case], found: Dict[Case, Result]) -> None:
    """Coverage over time as a CSV file: a row for each whole percent of each case."""
    with open(path, 'w', encoding='utf-8', newline='') as file:
        writer = csv.writer(file, lineterminator='\n')
        writer.writerow([*Case._fields, 'percent', 's', 'T'])
        for case in cases:
            for percent, seconds in enumerate(found[case].curve if case in found else (), 1):
                writer.writerow([*case, percent, f'{seconds:.1f}', f'{found[case].multiple_to(percent):.4f}'])
