"""Marks as lines that GitHub turns into annotations, and that GitHub Classroom reads.

Source of the last two lines: classroom-resources/autograding-grading-reporter, src/notify-classroom.js.
"""

import json
from typing import List, Sequence

from rumba_evaluation.marks.gradescope import most, score
from rumba_evaluation.marks.scheme import Mark, number


def lines(marks: Sequence[Mark]) -> List[str]:
    """A line for each mark, and two for the sum."""
    points, full = score(marks), most(marks)
    each = [_line('notice' if mark.score == mark.max_score else 'error', mark.name,
                  f'{number(mark.score)}/{number(mark.max_score)} points. {mark.reason}') for mark in marks]
    return [*each, _line('notice', 'Autograding complete', f'Points {number(points)}/{number(full)}'),
            _line('notice', 'Autograding report', json.dumps({'totalPoints': points, 'maxPoints': full}))]


def _line(kind: str, title: str, text: str) -> str:
    return f'::{kind} title={_escaped(title).replace(":", "%3A").replace(",", "%2C")}::{_escaped(text)}'


def _escaped(text: str) -> str:
    """Text of a workflow command, in which % and the ends of lines have a meaning."""
    return text.replace('%', '%25').replace('\r', '%0D').replace('\n', '%0A')
