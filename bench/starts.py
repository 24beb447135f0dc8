"""Whether a mission that is started beside busy loops ends as one on a quiet machine, bit for bit.

    ./rumba shell python3 bench/starts.py --busy 8 --starts 20

Short missions are started with demo.launch, and with simulator.launch and a cleaner beside it, in lockstep and as fast
as possible. The first start of each is quiet; the digests of the others are compared with its digest at the same tick.
With --cold, each of the others compiles everything anew, as the first start after an installation may have to.
"""

import argparse
import contextlib
import os
import sys
import tempfile
import time

import rospy
from common import figures, ros_session
from lockstep import Ends
from std_srvs.srv import Trigger
from tqdm import tqdm

from rumba_msg.srv import Step

MISSION = {'target_coverage': '0.03', 'seed': '1'}
WORLD = {'map': 'studio', 'speed': '0'}
CLEANER = ['rosrun', 'rumba_cleaning', 'cleaner', '_autostart:=true', *(
    f'_{name}:={value}' for name, value in MISSION.items())]
LATER = 30_000  # [ticks] after the end of the quiet mission: digests are compared then
SERVICES = 600.0  # [s] for a simulator to start beside busy loops
TROUBLE = 'goes on without'  # ends what a simulator says of someone for whom it does not wait


def launch(package, file, arguments):
    """The command that launches a file."""
    return ['roslaunch', package, file, *(f'{name}:={value}' for name, value in arguments.items())]


STARTS = {
    'demo.launch': [launch('rumba_launch', 'demo.launch', {**WORLD, **MISSION, 'gui': 'false'})],
    'simulator.launch': [
        launch('rumba_sim', 'simulator.launch', {**WORLD, 'seed': '1', 'wait_for': 'cleaner'}), CLEANER]}


def main():
    """Start the missions and print how many end as the quiet one."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--launches', nargs='+', choices=list(STARTS), default=list(STARTS))
    parser.add_argument('--starts', type=int, default=20, help='beside busy loops, of each launch file')
    parser.add_argument('--busy', type=int, default=8, help='busy loops')
    parser.add_argument('--cold', action='store_true', help='without any compiled code')
    options = parser.parse_args()
    are_equal = True
    with ros_session.master(), tqdm(total=len(options.launches) * (1 + options.starts), unit=' starts',
                                    disable=None) as bar:
        for name in options.launches:
            figures.heading(f'{name} beside {options.busy} busy loops{", without compiled code" * options.cold}')
            quiet = start(STARTS[name])
            bar.update()
            figures.row('quiet: from the start to the end of the mission [s]', quiet.seconds)
            endings = []
            for _ in range(options.starts):
                endings.append(start(STARTS[name], options.busy, quiet.tick, options.cold))
                for line in endings[-1].trouble:
                    print(f'  {line}', flush=True)
                bar.update()
            equal = sum(ending.digest == quiet.digest for ending in endings)
            are_equal &= equal == options.starts
            figures.row('busy: the longest from the start to the end of the mission [s]',
                        max((ending.seconds for ending in endings), default=0.0))
            figures.row('missions that end as the quiet one, bit for bit', equal, at_least=options.starts)
    return 0 if are_equal else 1


class Ending:
    """The world some time after a mission.

    Attributes:
        digest, tick: of it.
        seconds: from the start to the end of the mission.
        trouble: what was said about participants that are not waited for.
    """

    def __init__(self, begin, until):
        """The mission has ended; step to a tick, or, if it is None, to a later one."""
        self.seconds = time.monotonic() - begin
        self.trouble = []
        ask('pause')
        self.digest, self.tick = digest()
        self.until(until or self.tick + LATER)

    def until(self, tick):
        """Go on to a tick; too late is a digest of its own."""
        if self.tick < tick:
            answer = rospy.ServiceProxy('/simulator/step', Step)(tick - self.tick)
            assert answer.success, answer.message
            self.digest, self.tick = digest()


def start(commands, busy=0, until=None, is_cold=False):
    """Start a mission beside busy loops; returns its ending."""
    with contextlib.ExitStack() as stack:
        begin = time.monotonic()
        output = stack.enter_context(tempfile.TemporaryFile('w+'))
        stack.enter_context(cold() if is_cold else contextlib.nullcontext())
        stack.enter_context(ros_session.fresh_parameters())
        with contextlib.ExitStack() as loops:
            for _ in range(busy):
                loops.enter_context(ros_session.process([sys.executable, '-c', 'while True: pass']))
            ends = stack.enter_context(Ends(['rumba']))
            for command in commands:
                stack.enter_context(ros_session.process(command, stdout=output))
            ends.wait_for_begin()
            ends.wait()
        ending = Ending(begin, until)
        output.seek(0)
        ending.trouble = [line.strip() for line in output if TROUBLE in line]
        return ending


@contextlib.contextmanager
def cold():
    """Have nodes find no compiled code."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ['NUMBA_CACHE_DIR'] = folder
        try:
            yield
        finally:
            del os.environ['NUMBA_CACHE_DIR']


def ask(service):
    """Call a service of the simulator that must succeed; returns what it says."""
    rospy.wait_for_service(f'/simulator/{service}', SERVICES)
    answer = rospy.ServiceProxy(f'/simulator/{service}', Trigger)()
    assert answer.success, answer.message
    return answer.message


def digest():
    """The digest of the world, and its tick."""
    text, tick = ask('digest').split()
    return text, int(tick)


if __name__ == '__main__':
    sys.exit(main())
