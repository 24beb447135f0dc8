#!/usr/bin/env python3
"""Mark a class of thirty submissions twice, the second time on a busy machine, and compare the marks.

The class is made of the five exercises of rumba_exercises: of each the solution and a variant of it, both good, three
typical wrong ones, and the starter package as it was handed out.
"""

import argparse
import contextlib
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

from common import figures, ros_session

ROOT = pathlib.Path(__file__).resolve().parents[1]
EXERCISES = sorted((ROOT / 'rumba_exercises').glob('[0-9]_*'))
# How the variant of each solution differs from it.
VARIANTS = {'1_status': ('.1f', '.2f'), '2_bumper': ('= 3, 18', '= 4, 15'), '3_map': ('LANE = 0.15', 'LANE = 0.14'),
            '4_home': ('0.25', '0.3'), '5_position': ('min(0.2, distance)', 'min(0.18, distance)')}
# A shell that starts this in its background has it ignore the signal that ends it.
BUSY = 'import signal; signal.signal(signal.SIGINT, signal.SIG_DFL)\nwhile True: pass'


def main():
    """Make the class, mark it twice, and compare."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--busy', type=int, default=6, help='busy loops beside the second time; default %(default)s')
    parser.add_argument('--jobs', type=int, default=1, help='submissions in parallel; default %(default)s')
    parser.add_argument('--exercises', nargs='+', default=[path.name for path in EXERCISES])
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        base = pathlib.Path(folder)
        for name in options.exercises:
            make(ROOT / 'rumba_exercises' / name, base / 'class' / name)
        figures.heading('A class, marked twice')
        times = [mark(base, number, options, busy) for number, busy in enumerate((0, options.busy))]
        return compare(base, options, times)


def make(exercise, folder):
    """Make the submissions to an exercise."""
    wrong = sorted((exercise / 'wrong').iterdir())
    for name, overlay in [('starter', None), ('solution', exercise / 'solution'), ('variant', exercise / 'solution'),
                          *((path.name, path) for path in wrong)]:
        shutil.copytree(exercise / 'starter', folder / name)
        if overlay is not None:
            shutil.copytree(overlay, folder / name, dirs_exist_ok=True)
    [script] = [path for path in (folder / 'variant').glob('*/scripts/*') if path.is_file()]
    old, new = VARIANTS[exercise.name]
    text = script.read_text()
    assert old in text, f'{script}: {old}'
    script.write_text(text.replace(old, new))


def mark(base, number, options, busy):
    """Mark all exercises; returns how long that took [s]."""
    begin = time.monotonic()
    with contextlib.ExitStack() as stack:
        for _ in range(busy):
            stack.enter_context(ros_session.process([sys.executable, '-c', BUSY]))
        for name in options.exercises:
            subprocess.run(['rosrun', 'rumba_evaluation', 'mark', '--all', str(base / 'class' / name), '--tests',
                            str(ROOT / 'rumba_exercises' / name / 'hidden'), '--output', str(base / str(number) / name),
                            '--jobs', str(options.jobs)], check=True, stdout=subprocess.DEVNULL)
    return time.monotonic() - begin


def compare(base, options, times):
    """Print what became of the class; returns the exit code."""
    good = wrong = same = same_words = 0
    paths = sorted(path.relative_to(base / '0') for path in (base / '0').glob('*/*/results.json'))
    for path in paths:
        first, second = (json.loads((base / str(number) / path).read_text()) for number in (0, 1))
        most = sum(test['max_score'] for test in first['tests'])
        is_good = path.parent.name in ('solution', 'variant')
        good += is_good and first['score'] == most
        wrong += not is_good and first['score'] < most
        is_same = [test['score'] for test in first['tests']] == [test['score'] for test in second['tests']]
        same, same_words = same + is_same, same_words + (first['tests'] == second['tests'])
        print(f'  {str(path.parent):<40} {first["score"]:>6g} {second["score"]:>6g} of {most:g}'
              f'{"" if is_same else "   DIFFERENT"}')
    count = len(paths)
    figures.row('submissions', count, at_least=6 * len(options.exercises))
    figures.row('good ones with all points', good, at_least=2 * len(options.exercises))
    figures.row('wrong ones without', wrong, at_least=4 * len(options.exercises))
    figures.row(f'with the same points beside {options.busy} busy loops', same, at_least=count)
    figures.row('with the same reasons, word by word', same_words)
    figures.row('seconds for each submission', times[0] / count)
    figures.row(f'seconds for each beside {options.busy} busy loops', times[1] / count)
    return 0 if (good, wrong, same) == (2 * len(options.exercises), 4 * len(options.exercises), count) else 1


if __name__ == '__main__':
    sys.exit(main())
