"""Prints the faults of the prose of this repository; the exit code is 1 if there are any."""

import pathlib
import sys
from typing import List

from prose import rules, texts

ROOT = pathlib.Path(__file__).resolve().parents[1]
# What people read: pages, changelogs, and what programs and launch files print.
PATTERNS = ['*.md', 'docs/*.md', 'rumba_*/**/*.md', 'compat/**/*.md', 'rumba_*/CHANGELOG.rst',
            'rumba_*/src/**/*.py', 'rumba_launch/launch/*.launch', 'rumba_sim/launch/*.launch', 'rumba']


def main() -> int:
    """Check all files.

    Returns:
        The exit code.
    """
    messages = [f'{path.relative_to(ROOT)}:{fault.line}: {fault.text}' for path in files() for fault in found_in(path)]
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


if __name__ == '__main__':
    sys.exit(main())
