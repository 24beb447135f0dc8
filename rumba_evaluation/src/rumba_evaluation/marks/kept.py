"""What is kept of a submission that was marked, in a folder: for graders, for the teacher, and for the next run."""

import os
from typing import Optional

from rumba_evaluation.marks import gradescope
from rumba_evaluation.marks.submission import Outcome

RESULTS, NOTES, DIGEST = 'results.json', 'notes.txt', '.digest'


def write(folder: str, name: str, text: str) -> None:
    """Write a file at once, so that nobody finds a half of it."""
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, name)
    with open(f'{path}.new', 'w', encoding='utf-8', errors='backslashreplace') as file:
        file.write(text)
    os.replace(f'{path}.new', path)


def outcome(folder: str, found: Outcome, visibility: str) -> None:
    """Keep the marks and the notes."""
    write(folder, NOTES, '\n'.join(found.notes))
    write(folder, RESULTS, gradescope.document(
        found.marks, visibility, '\n'.join([gradescope.total(found.marks), *found.notes])))


def earlier(folder: str, digest: str) -> Optional[Outcome]:
    """The outcome of an earlier run in a folder, if it is that of a digest; it may be damaged."""
    try:
        if _read(folder, DIGEST) == digest:
            return Outcome(gradescope.marks_of(_read(folder, RESULTS)), _read(folder, NOTES).splitlines())
    except (OSError, ValueError):
        pass
    return None


def _read(folder: str, name: str) -> str:
    with open(os.path.join(folder, name), encoding='utf-8') as file:
        return file.read()
