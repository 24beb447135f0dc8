"""Prints the faults of the prose of this repository; the exit code is 1 if there are any."""

import pathlib
import sys
from typing import Dict, Iterator, List

from prose import rules, texts

ROOT = pathlib.Path(__file__).resolve().parents[1]
TO_DO = pathlib.Path(__file__).with_name('to_do.txt')
# What people read: pages, changelogs, and what programs and launch files print.
PATTERNS = ['*.md', 'docs/*.md', 'rumba_*/**/*.md', 'compat/**/*.md', 'rumba_*/CHANGELOG.rst',
            'rumba_*/src/**/*.py', 'rumba_launch/launch/*.launch', 'rumba_sim/launch/*.launch', 'rumba']


def main() -> int:
    """Check all files.

    Returns:
        The exit code.
    """
    allowed = to_do(TO_DO.read_text())
    messages: List[str] = []
    for path in files():
        name = str(path.relative_to(ROOT))
        messages += judged(name, found_in(path), allowed.pop(name, 0))
    messages += [f'prose/to_do.txt: {name} is no file that is checked: remove it' for name in allowed]
    print(*messages, sep='\n', end='\n' if messages else '')
    return 1 if messages else 0


def files() -> List[pathlib.Path]:
    """All files with prose, in order."""
    return sorted({path for pattern in PATTERNS for path in ROOT.glob(pattern) if path.is_file()})


def found_in(path: pathlib.Path) -> List[rules.Fault]:
    """The faults of a file."""
    sentences = texts.sentences(path)
    found = list(rules.faults(sentences))
    if path == ROOT / 'README.md':
        found += rules.fault_of_length(sentences, rules.MOST_OF_FIRST)
    elif path.parent == ROOT / 'docs':
        found += rules.fault_of_length(sentences, rules.MOST_OF_PAGE)
    return found


def to_do(listed: str) -> Dict[str, int]:
    """How many faults files may still have, by name."""
    rows = [line.split() for line in listed.splitlines() if line and not line.startswith('#')]
    return {name: int(count) for count, name in rows}


def judged(name: str, found: List[rules.Fault], allowed: int) -> Iterator[str]:
    """What to print of the faults of a file that may still have some: the number that is listed."""
    if len(found) > allowed:
        yield from (f'{name}:{fault.line}: {fault.text}' for fault in found)
    elif len(found) < allowed:
        yield f'prose/to_do.txt: {name} has {len(found)} faults now, not {allowed}: write that'


if __name__ == '__main__':
    sys.exit(main())
