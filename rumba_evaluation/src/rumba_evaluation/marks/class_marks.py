"""The marks of a class: a folder with one folder for each submission, marked in parallel, and again only if need be."""

import collections
import csv
import hashlib
import io
import json
import os
import pathlib
from typing import Dict, Iterable, List, NamedTuple, Sequence

from rumba_evaluation.marks.gradescope import most, score
from rumba_evaluation.marks.hidden_tests import HiddenTest
from rumba_evaluation.marks.scheme import Mark, number
from rumba_evaluation.marks.submission import Launch, Outcome
from rumba_evaluation.submissions import intake


class Row(NamedTuple):
    """A submission in the tables."""

    name: str
    outcome: Outcome


def submissions(folder: str) -> List[str]:
    """The paths of the submissions of a class, by name."""
    with os.scandir(folder) as entries:
        return sorted(entry.path for entry in entries if intake.is_submission(entry))


def names(sources: Sequence[str]) -> Dict[str, str]:
    """The names of submissions by their paths, without endings such as .zip if those do not tell them apart."""
    short = collections.Counter(map(intake.name_of, sources))
    return {source: name if short[name] == 1 else os.path.basename(source)
            for source, name in ((source, intake.name_of(source)) for source in sources)}


def digest_of_tests(folder: str, tests: Sequence[HiddenTest], launches: Sequence[Launch]) -> str:
    """Identifies what marks: all files in the folder of the tests, their arguments, and files that parameters name.

    Beside a file that a parameter names, such as a map, there may be others that belong to it, such as its picture.
    """
    named = {os.path.dirname(os.path.realpath(value)) for launch in launches for value in launch.parameters.values()
             if isinstance(value, str) and os.path.isabs(value) and os.path.isfile(value)}
    found = hashlib.sha256(json.dumps([test.arguments for test in tests]).encode() + intake.digest(folder).encode())
    for place in sorted(named):
        for entry in sorted(pathlib.Path(place).iterdir()):
            if entry.is_file():
                found.update(f'{entry}\0{intake.digest(str(entry))}'.encode(errors='surrogateescape'))
    return found.hexdigest()


def table(marks: Iterable[Mark]) -> str:
    """The marks of one submission, and why points were lost."""
    marks = list(marks)
    rows = [(mark.name, f'{number(mark.score)} of {number(mark.max_score)}',
             '' if mark.score == mark.max_score else mark.reason) for mark in marks]
    rows.append(('total', f'{number(score(marks))} of {number(most(marks))}', ''))
    widths = [max(len(row[column]) for row in rows) for column in range(2)]
    return '\n'.join(f'{name.ljust(widths[0])}  {points.rjust(widths[1])}  {reason}'.rstrip()
                     for name, points, reason in rows)


def sheet(rows: Sequence[Row], points: Dict[str, float]) -> str:
    """The marks of a class as CSV: points in all and for each condition, and what went wrong.

    Where nothing went wrong beside the task, the first reason for points that were lost stands there.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator='\n')
    writer.writerow(['submission', 'points', 'of', *points, 'notes'])
    for row in rows:
        each = {mark.name: mark.score for mark in row.outcome.marks}
        notes = row.outcome.notes or [mark.reason for mark in row.outcome.marks if mark.score < mark.max_score][:1]
        writer.writerow([_harmless(row.name), number(score(row.outcome.marks)), number(sum(points.values())),
                         *(number(each.get(name, 0.0)) for name in points), _harmless('; '.join(notes))])
    return text.getvalue()


def _harmless(text: str) -> str:
    """A cell that no spreadsheet takes for a formula: students choose what is in it."""
    return f"'{text}" if text[:1] in ('=', '+', '-', '@', '\t', '\r') else text
