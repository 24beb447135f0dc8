"""Updates pages of results: ./rumba bench PAGE ...

A command at the beginning of a paragraph, `./rumba shell ...`, is run, and what it prints replaces the block of output
below it, with the commit that ran. Commands with several blocks below them, or with a FOLDER to fill in, are named and
left as they are.
"""

import pathlib
import re
import shlex
import subprocess
import sys
from typing import Iterator, NamedTuple, Tuple

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMMAND = re.compile(r'^`\./rumba shell ([^`]+)`', re.MULTILINE)
BLOCK = re.compile(r'^```\n.*?^```\n(?:\nRecorded at \w+\.\n)?', re.MULTILINE | re.DOTALL)
BLANK = re.compile(r'\b[A-Z]{3,}\b')  # something to fill in


class Part(NamedTuple):
    """A command, and where its block of output lies in the text of the page."""

    command: str
    begin: int
    end: int


def parts(page: str) -> Tuple[Tuple[Part, ...], Tuple[str, ...]]:
    """The parts of a page that can be updated, the last first, and the commands that must be run by hand."""
    found, by_hand = [], []
    commands = list(COMMAND.finditer(page))
    ends = [command.start() for command in commands[1:]] + [len(page)]
    for command, end in zip(commands, ends):
        blocks = list(BLOCK.finditer(page, command.end(), end))
        text = ' '.join(command.group(1).split())
        if len(blocks) == 1 and not BLANK.search(text):
            found.append(Part(text, blocks[0].start(), blocks[0].end()))
        else:
            by_hand.append(text)
    return tuple(reversed(found)), tuple(by_hand)


def renewed(page: str, part: Part, output: str, commit: str) -> str:
    """The page with another output of a part."""
    return f'{page[:part.begin]}```\n{output.strip(chr(10))}\n```\n\nRecorded at {commit}.\n{page[part.end:]}'


def renew(path: pathlib.Path, commit: str) -> Iterator[str]:
    """Run the commands of a page, and write it after each; gives a line for each command."""
    ready, by_hand = parts(path.read_text())
    for part in ready:  # the last first, so that the others stay where they are
        done = subprocess.run(shlex.split(part.command), cwd=ROOT, stdout=subprocess.PIPE, universal_newlines=True)
        if done.returncode:
            yield f'{path.name}: exit code {done.returncode}, nothing is changed: {part.command}'
        else:
            path.write_text(renewed(path.read_text(), part, done.stdout, commit))
            yield f'{path.name}: written: {part.command}'
    yield from (f'{path.name}: run by hand: {command}' for command in by_hand)


def main(names: Tuple[str, ...]) -> int:
    """Renew pages by their names, such as results_speed.

    Returns:
        The exit code.
    """
    pages = {path.stem: path for path in (ROOT / 'docs').glob('results_*.md')}
    unknown = [name for name in names if name not in pages]
    if unknown:
        print(f'bench: there is no page {unknown[0]}: known are {", ".join(sorted(pages))}', file=sys.stderr)
        return 2
    commit = subprocess.check_output(['git', 'rev-parse', '--short=8', 'HEAD'], cwd=ROOT, universal_newlines=True)
    for name in names:
        for line in renew(pages[name], commit.strip()):
            print(line, flush=True)
    return 0


if __name__ == '__main__':
    sys.exit(main(tuple(sys.argv[1:])))
