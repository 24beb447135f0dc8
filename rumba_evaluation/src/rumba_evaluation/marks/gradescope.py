"""Marks as a file results.json, which Gradescope and the command `mark` read.

Source of the format: gradescope-autograders.readthedocs.io, Autograder Specifications, Output Format.
"""

import json
import os
from typing import List, Sequence

from rumba_evaluation.marks.scheme import Mark, number

VISIBLE = 'visible'
VISIBILITIES = (VISIBLE, 'hidden', 'after_due_date', 'after_published')


def document(marks: Sequence[Mark], visibility: str = VISIBLE, words: str = '') -> str:
    """The text of the file; `words` are for the whole submission."""
    tests = [{'name': mark.name, 'score': mark.score, 'max_score': mark.max_score, 'output': mark.reason,
              'status': 'passed' if mark.score == mark.max_score else 'failed', 'visibility': visibility}
             for mark in marks]
    content = {'score': score(marks), 'output': words or total(marks), 'visibility': visibility, 'tests': tests}
    return json.dumps(content, indent=2, ensure_ascii=False) + '\n'


def marks_of(text: str) -> List[Mark]:
    """The marks of such a file.

    Raises:
        ValueError: it is none.
    """
    try:
        return [Mark(str(test['name']), float(test['score']), float(test['max_score']), str(test['output']))
                for test in json.loads(text)['tests']]
    except (KeyError, TypeError) as error:
        raise ValueError(f'no results.json: {error}') from error


def beside(path: str) -> str:
    """Path of the marks of a test whose JUnit results have a path; empty if that is empty."""
    return os.path.splitext(path)[0] + '.json' if path else ''


def score(marks: Sequence[Mark]) -> float:
    """Sum of the points."""
    return round(sum(mark.score for mark in marks), 2)


def most(marks: Sequence[Mark]) -> float:
    """Sum of the points that could be earned."""
    return round(sum(mark.max_score for mark in marks), 2)


def total(marks: Sequence[Mark]) -> str:
    """The sums in words."""
    return f'{number(score(marks))} of {number(most(marks))} points'
