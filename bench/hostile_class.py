#!/usr/bin/env python3
"""Mark a class of sixty as an examination, twice, the second time on a busy machine.

Twenty are good, ten of them built; twenty have the mistakes of beginners; twenty cheat, or break things.
"""

import argparse
import contextlib
import csv
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time

from common import classroom, figures, ros_session
from common.homework import EXERCISES, GOOD, HOSTILE, MARKER, ROOT, SLEEP, WRONG

BUSY = 'import signal; signal.signal(signal.SIGINT, signal.SIG_DFL)\nwhile True: pass'
MEMORY = 200.0  # [MB] of mark itself


def main():
    """Make the class, mark it twice, and compare; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--busy', type=int, default=4, help='busy loops beside the second time; default %(default)s')
    parser.add_argument('--jobs', type=int, default=2, help='submissions in parallel; default %(default)s')
    parser.add_argument('--keep', default='', metavar='FOLDER', help='a folder for the class, and what became of it')
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        base = pathlib.Path(options.keep or temporary).resolve()
        kinds = classroom.build(base / 'class')
        figures.heading('A class of sixty, in an examination')
        quiet, busy = (Marking(base, name, kinds, options.jobs, loops)
                       for name, loops in (('quiet', 0), ('busy', options.busy)))
        quiet.run()
        busy.run()
        return tell(base, kinds, quiet, busy)


class Marking:
    """The class, marked once.

    Attributes:
        rows: of the sheets, by exercise and submission.
        seconds: how long it took.
        memory: the most that mark itself took [MB].
    """

    def __init__(self, base, name, kinds, jobs, loops):
        """Mark in a folder below `base`."""
        self.rows, self.seconds, self.memory = {}, 0.0, 0.0
        self._base, self._folder, self._jobs, self._loops = base, base / name, jobs, loops
        self._exercises = sorted({exercise for exercise, _ in kinds})

    def run(self):
        """Mark all exercises."""
        begin = time.monotonic()
        with contextlib.ExitStack() as stack:
            for _ in range(self._loops):
                stack.enter_context(ros_session.process([sys.executable, '-c', BUSY]))
            for exercise in self._exercises:
                self._mark(exercise)
        self.seconds = time.monotonic() - begin

    def _mark(self, exercise):
        command = ['rosrun', 'rumba_evaluation', 'mark', '--all', str(self._base / 'class' / exercise), '--tests',
                   str(EXERCISES / exercise / 'hidden'), '--output', str(self._folder / exercise),
                   '--jobs', str(self._jobs), 'exam:=true']
        with subprocess.Popen(command, stdout=subprocess.PIPE, universal_newlines=True) as process:
            watch = threading.Thread(target=self._watch, args=(process,))
            watch.start()
            for line in process.stdout:
                print('   ', line.rstrip()[:160], flush=True)
            watch.join()
        with open(self._folder / exercise / 'marks.csv', encoding='utf-8', newline='') as file:
            self.rows.update(((exercise, row['submission']), row) for row in csv.DictReader(file))

    def _watch(self, process):
        """Look at the memory of mark, which rosrun becomes."""
        while process.poll() is None:
            with contextlib.suppress(OSError, AttributeError):
                status = pathlib.Path(f'/proc/{process.pid}/status').read_text()
                self.memory = max(self.memory, int(re.search(r'VmHWM:\s+(\d+)', status).group(1)) / 1000.0)
            time.sleep(0.5)


def tell(base, kinds, quiet, busy):
    """Print what became of the class; returns the exit code."""
    counts = {GOOD: 0, WRONG: 0, HOSTILE: 0}
    same = 0
    for key, kind in sorted(kinds.items()):
        row, again = quiet.rows.get(key, {}), busy.rows.get(key, {})
        points, notes = row.get('points', 'none'), row.get('notes', '')
        is_right = {GOOD: points == '10', WRONG: points not in ('10', 'none') and bool(notes or points != '0'),
                    HOSTILE: points == '0' or points != 'none' and bool(notes)}[kind]
        is_same = points == again.get('points')
        counts[kind], same = counts[kind] + is_right, same + is_same
        print(f'  {kind:<8}{"/".join(key):<52}{points:>6}{again.get("points", "none"):>6}'
              f'{"" if is_right and is_same else "   WRONG"}  {notes[:90]}')
    left = leftovers(base)
    rows = [*((f'{kind} ones marked as such', count, 20) for kind, count in counts.items()),
            (f'with the same points beside {busy._loops} busy loops', same, len(kinds)),
            ('with a row in marks.csv', sum(key in quiet.rows and key in busy.rows for key in kinds), len(kinds))]
    for name, count, bound in rows:
        figures.row(name, count, at_least=bound)
    figures.row('processes and files left behind', len(left), below=1)
    figures.row('memory of mark itself, at most [MB]', max(quiet.memory, busy.memory), below=MEMORY)
    figures.row('seconds for each submission', quiet.seconds / len(kinds))
    figures.row(f'seconds for each beside {busy._loops} busy loops', busy.seconds / len(kinds))
    print(*left, sep='\n')
    return int(any(count < bound for _, count, bound in rows) or bool(left))


def leftovers(base):
    """Processes and files that hostile submissions have left outside of what is theirs."""
    found = []
    for path in pathlib.Path('/proc').glob('[0-9]*/cmdline'):
        with contextlib.suppress(OSError):
            words = path.read_bytes().split(b'\0')
            if str(SLEEP).encode() in words or any(b'/rumba_mark_' in word for word in words):
                found.append(f'process {path.parent.name}: {words}')
    places = ['/tmp', '/var/tmp', '/dev/shm', '/etc', '/usr/lib/python3/dist-packages', ROOT,
              EXERCISES, pathlib.Path.home(), base, base / 'class', *(base / 'class').iterdir()]
    found += [str(path) for place in places for path in [pathlib.Path(place) / MARKER] if path.exists()]
    return found + [str(path) for path in pathlib.Path(tempfile.gettempdir()).glob('rumba_mark_*')]


if __name__ == '__main__':
    sys.exit(main())
