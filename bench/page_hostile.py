"""How long a client of the page waits for an answer while ten others do their worst, within the limits and beyond them.

The victim calls a service of the page fifty times a second and listens to the odometry. Each kind of attack is tried
for some seconds; with arguments, those alone whose names contain one of them.
"""

import contextlib
import json
import pathlib
import subprocess
import sys
import time

from common import figures, hostile_page, ros_session
from common.ports import free_port
from page import is_served

COMMON = pathlib.Path(__file__).with_name('common')
TOKEN = 'secret'
HOSTILE = 10  # clients
SECONDS = 8.0
MEDIAN, WORST = 5.0, 100.0  # [ms] of the round trip of the victim, at most
CASES = {'watchers': ([f'_token:={TOKEN}'], ''),
         'clients that may change everything': ([f'_write:={hostile_page.ALLOWED}'], '')}


def main():
    """Measure and print."""
    with ros_session.master(), ros_session.simulator(map='apartment'):
        for case, (arguments, query) in CASES.items():
            figures.heading(f'The page beside {HOSTILE} hostile {case}')
            for kind in ('nothing', *hostile_page.KINDS):
                if len(sys.argv) == 1 or any(part in kind for part in sys.argv[1:]):
                    beside(kind, arguments, query)


def beside(kind, arguments, query):
    """The round trip of the victim beside one kind of attack, on a fresh page."""
    port = free_port()
    with contextlib.ExitStack() as until_the_end:
        page = until_the_end.enter_context(ros_session.process(
            ['rosrun', 'rumba_viewer', 'page', f'_port:={port}', *arguments]))
        ros_session.wait_until(lambda: is_served(port))
        victim = started(until_the_end, 'page_victim', port)
        if kind != 'nothing':
            started(until_the_end, 'hostile_page', port, kind, HOSTILE, query)
        begin, before = time.monotonic(), figures.cpu_seconds(page.pid)
        time.sleep(SECONDS)
        share = 100.0 * (figures.cpu_seconds(page.pid) - before) / (time.monotonic() - begin)
        seen = json.loads(victim.communicate(timeout=ros_session.PATIENCE)[0].splitlines()[-1])
    figures.row(f'{kind}: round trip, median [ms]', 1e3 * seen['median'], below=MEDIAN)
    figures.row('  99 % [ms]', 1e3 * seen['most'])
    figures.row('  worst [ms]', 1e3 * seen['worst'], below=WORST)
    figures.row('  messages of the odometry in a second', seen['odometry'])
    figures.row('  share of a core [%]', share)


def started(until_the_end, name, *arguments):
    """A module of this folder as a process, once it says that it is ready."""
    process = until_the_end.enter_context(subprocess.Popen(
        [sys.executable, '-m', f'common.{name}', *map(str, arguments)], cwd=str(COMMON.parent),
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, universal_newlines=True))
    until_the_end.callback(process.terminate)
    assert process.stdout.readline().strip() == 'ready'
    return process


if __name__ == '__main__':
    main()
