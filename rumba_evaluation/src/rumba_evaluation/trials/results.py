"""Results in a CSV file: a row is written as soon as its mission has ended, so that an interrupted run can go on."""

import csv
import dataclasses
import io
import math
import os
from typing import Any, Dict, List, Sequence, Tuple

from rumba_cleaning.outcome import Outcome
from rumba_evaluation.trials.cases import LEVELS, Case, Conditions, Curve, Result
from rumba_sim.model.common.errors import ConfigError

DIGITS = 7  # of a number: enough for 0.1 s in ten days
SHORTEST = 1e-6  # [s] ideal time of a mission
PARTS: Tuple[Any, ...] = (Case, Conditions, Result)
TRUTH = {'True': True, 'False': False}


class Results:
    """The rows of one file, all made under the same conditions.

    Attributes:
        path: of the file.
        found: result by case.
    """

    def __init__(self, path: str, conditions: Conditions) -> None:
        """Open a file and read its rows; an incomplete last line is removed.

        Raises:
            ConfigError: the file cannot be read or written, is of another kind, or was made under other conditions.
        """
        self.path = path
        self._conditions = conditions
        self.found: Dict[Case, Result] = {}
        self._rows: Dict[Case, List[str]] = {}  # as they are in the file
        try:
            self._file = open(path, 'ab+')  # creates it if it does not exist
        except OSError as error:
            raise ConfigError(f'{path}: {error.strerror}: --output must be a writable folder') from None
        self._file.seek(0)
        whole, end, cut = self._file.read().rpartition(b'\n')
        try:
            self._read(list(csv.reader(io.StringIO((whole or cut).decode('utf-8', 'replace')))), is_whole=bool(end))
        except csv.Error:
            self._file.close()
            raise self._refusal('is not a file of results of this version') from None
        except ConfigError:
            self._file.close()
            raise
        self._file.truncate(len(whole) + len(end))
        if not end:
            self._write(_header())

    def _read(self, rows: List[List[str]], is_whole: bool) -> None:
        header = _header()
        first = rows[0] if rows else []
        if first != header if is_whole else not ','.join(header).startswith(','.join(first)):
            raise self._refusal('is not a file of results of this version')
        for number, row in enumerate(rows[1:], 2):
            try:
                case, conditions, result = _parts([_value(kind, text) for kind, text in zip(_kinds(), row)])
                _check(result)
            except (LookupError, TypeError, ValueError, ConfigError):
                raise self._refusal(f'cannot be read in line {number}') from None
            for field in dataclasses.fields(Conditions):
                old, new = (_text(getattr(each, field.name)) for each in (conditions, self._conditions))
                if old != new:
                    raise self._refusal(f'was made with {field.name} {old}, not {new}')
            self.found[case] = result
            self._rows[case] = row

    def _refusal(self, what: str) -> ConfigError:
        return ConfigError(f'{self.path} {what}: choose another --output, or delete it')

    def add(self, case: Case, result: Result) -> None:
        """Write a row, and wait until it is on the disk."""
        values = [*case, *dataclasses.astuple(self._conditions), *dataclasses.astuple(result)]
        times = [time for percent in LEVELS for time in (result.time_to(percent), result.multiple_to(percent))]
        texts = [_text(value) for value in values]
        self._rows[case] = texts + [_text(time) for time in times]
        self._write(self._rows[case])
        # Rounded as in the file, so that an interrupted run ends with the same table.
        _, _, self.found[case] = _parts([_value(kind, text) for kind, text in zip(_kinds(), texts)])

    def _write(self, row: List[str]) -> None:
        self._file.write(_line(row))
        self._file.flush()
        os.fsync(self._file.fileno())

    def arrange(self, cases: Sequence[Case]) -> None:
        """Put the rows of cases into their order, before those of others: they were written as missions ended.

        Either the whole new file is there afterwards, or the old one.
        """
        order = {case: number for number, case in enumerate(cases)}
        rows = sorted(self._rows, key=lambda case: order.get(case, len(order)))
        if rows == list(self._rows):
            return
        beside = f'{self.path}.new'
        with open(beside, 'wb') as file:
            file.write(_line(_header()) + b''.join(_line(self._rows[case]) for case in rows))
            file.flush()
            os.fsync(file.fileno())
        os.replace(beside, self.path)
        self._file.close()
        self._file = open(self.path, 'ab+')

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def _line(row: List[str]) -> bytes:
    line = io.StringIO()
    csv.writer(line, lineterminator='\n').writerow(row)
    return line.getvalue().encode('utf-8')


def _header() -> List[str]:
    """Names of all columns; the last ones, seconds and multiples of T, are for people and are not read."""
    return [name for part in PARTS for name in part.__annotations__] + [
        f'to_{percent}_{unit}' for percent in LEVELS for unit in ('s', 'T')]


def _kinds() -> List[Any]:
    """Types of the columns that are read."""
    return [kind for part in PARTS for kind in part.__annotations__.values()]


def _parts(values: List[Any]) -> Tuple[Case, Conditions, Result]:
    """The values of a row as objects; raises TypeError if there are too few."""
    parts, begin = [], 0
    for part in PARTS:
        end = begin + len(part.__annotations__)
        parts.append(part(*values[begin:end]))
        begin = end
    return parts[0], parts[1], parts[2]


def _check(result: Result) -> None:
    """Refuse times that no mission has, by ValueError: with them, no table can be made."""
    if not (SHORTEST <= result.ideal_time < math.inf and 0.0 <= result.charging_time <= result.time < math.inf
            and all(0.0 <= time < math.inf for time in result.curve) and len(result.curve) <= 100):
        raise ValueError


def _text(value: Any) -> str:
    if isinstance(value, Outcome):
        return value.name.lower()
    if isinstance(value, float):
        return f'{value:.{DIGITS}g}'
    if isinstance(value, tuple):
        return ' '.join(_text(number) for number in value)
    return ' '.join(str(value).split())  # a row is a line


def _value(kind: Any, text: str) -> Any:
    """The value of a text; raises LookupError or ValueError if it is not of that kind."""
    if kind is Outcome:
        return Outcome[text.upper()]
    if kind is Curve:
        return tuple(float(number) for number in text.split())
    return TRUTH[text] if kind is bool else kind(text)
