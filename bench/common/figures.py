"""How figures are printed, and how CPU time and memory are read."""

import contextlib
import os
import pathlib
import statistics
import time

CLOCK_TICKS = os.sysconf('SC_CLK_TCK')  # in a second, of what the kernel counts


def heading(title):
    """What was measured, above its figures."""
    print(f'\n{title}', flush=True)


def row(name, figure, at_least=None, below=None):
    """Print a line: what was measured, the figure, and the bound with its verdict if there is one.

    Args:
        name: what was measured.
        figure: its value.
        at_least, below: the bound; give one of them, or none.
    """
    text = f'  {name:<78} {_short(figure):>11}'
    if at_least is not None:
        text += f'   at least {_short(at_least)}: {_verdict(figure >= at_least)}'
    elif below is not None:
        text += f'   below {_short(below)}: {_verdict(figure < below)}'
    print(text, flush=True)


def _verdict(is_met):
    return 'met' if is_met else 'MISSED'


def _short(figure):
    """A number with three significant digits."""
    return f'{figure:,.0f}' if abs(figure) >= 100.0 else f'{figure:.3g}'


def per_cpu_second(work, amount, seconds=0.5, runs=5, prepare=lambda: None):
    """How much work is done in one second of CPU time: the median of several runs.

    Args:
        work: a function that does one portion of the work.
        amount: how much one call counts.
        seconds: CPU time of a run, at least.
        runs: how many.
        prepare: a function that is called before each run, and is not measured.
    """
    figures = []
    for _ in range(runs):
        prepare()
        calls, begin = 0, time.process_time()
        while time.process_time() - begin < seconds or not calls:
            work()
            calls += 1
        figures.append(calls * amount / (time.process_time() - begin))
    return statistics.median(figures)


def cpu_seconds(pid):
    """CPU time of a process so far [s], user and system."""
    fields = pathlib.Path(f'/proc/{pid}/stat').read_text().rpartition(')')[2].split()
    return (int(fields[11]) + int(fields[12])) / CLOCK_TICKS


def cpu_seconds_of_tree(pid):
    """CPU time so far of a process and of all that it started, also of those that have ended [s]."""
    spent, parents = {}, {}
    for stat in pathlib.Path('/proc').glob('[0-9]*/stat'):
        with contextlib.suppress(OSError):  # it has ended meanwhile
            fields = stat.read_text().rpartition(')')[2].split()
            number = int(stat.parent.name)
            spent[number], parents[number] = sum(map(int, fields[11:15])), int(fields[1])
    tree, found = set(), {pid}
    while found:
        tree |= found
        found = {number for number, parent in parents.items() if parent in found}
    return sum(spent.get(number, 0) for number in tree) / CLOCK_TICKS


def resident_megabytes(pid='self'):
    """Resident memory of a process [MB]."""
    for line in pathlib.Path(f'/proc/{pid}/status').read_text().splitlines():
        if line.startswith('VmRSS:'):
            return int(line.split()[1]) / 1024.0
    raise ValueError(f'process {pid} has no memory')
