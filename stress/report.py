"""What a person sees: one line while it runs, each failure, and the counts at the end."""

import collections
import statistics
import sys
import time

PERIOD = 0.5  # [s] between two changes of the line
SPOKEN = 60.0  # [s] between two lines where there is no terminal
WIDTH = 30  # of a name in the table


class Report:
    """Counts blows and failures, and prints them.

    Attributes:
        failures: how many there were.
    """

    def __init__(self, seed, seconds, stream=sys.stdout):
        """Begin a run of so many seconds, which prints to a stream."""
        self.failures = 0
        self._seed, self._seconds, self._stream = seed, seconds, stream
        self._begun = self._said = time.monotonic()
        self._blows, self._inputs, self._faults = (collections.Counter() for _ in range(3))
        self._waits = []
        self._is_terminal = stream.isatty()

    @property
    def seconds_left(self):
        """How much time is left [s]."""
        return self._seconds - (time.monotonic() - self._begun)

    def progress(self, what):
        """Say how far the run is, and what it does now."""
        now = time.monotonic()
        if now - self._said < (PERIOD if self._is_terminal else SPOKEN):
            return
        self._said = now
        line = (f'{_clock(now - self._begun)} of {_clock(self._seconds)}  {sum(self._inputs.values()):,} inputs  '
                f'{sum(self._faults.values()):,} faults  {self.failures} failures  {what}')
        print(f'\r{line}\x1b[K' if self._is_terminal else line, end='' if self._is_terminal else '\n',
              file=self._stream, flush=True)

    def count(self, blow):
        """Count a blow."""
        for counter, number in ((self._blows, 1), (self._inputs, blow.inputs), (self._faults, blow.faults)):
            counter[blow.kind.name] += number
        self._waits += blow.waits

    def failed(self, failure, blow, ground):
        """Print a failure at once; blow and ground are None if it came before the first one."""
        self.failures += 1
        number = 'at the start' if blow is None else f'blow {blow.number}'
        self.say(f'FAILED, seed {self._seed}, {number}')
        if blow is not None:
            self.say(f'  asked: {blow}')
        self.say(f'  seen:  {failure}')
        for member in ground.everybody if ground else ():
            for line in () if member.role.talks else member.last:
                self.say(f'  {member.name} printed last: {line[:200]!r}')

    def known(self, failure):
        """Say that a failure is of a sort that was shortened before."""
        self.say(f'  a failure of {failure.who} by {failure.oracle} was shortened before')

    def shortest(self, blows, is_sure):
        """Print the shortest sequence of blows that still shows the last failure."""
        numbers = ','.join(str(blow.number) for blow in blows)
        self.say('  the shortest sequence that shows it:' if is_sure else
                 '  it did not show again; all that led to it:')
        for blow in blows:
            self.say(f'    {blow.number}: {blow}')
        self.say(f'  again: ./rumba stress --seed {self._seed} --only {numbers}')

    def say(self, line):
        """Print a line of its own."""
        print(('\r\x1b[K' if self._is_terminal else '') + line, file=self._stream, flush=True)

    def summary(self):
        """Print the counts."""
        self.say(f'\nseed {self._seed}, {_clock(time.monotonic() - self._begun)}')
        self.say(f'  {"kind":{WIDTH}} {"blows":>8} {"hostile inputs":>15} {"faults":>8}')
        for name, blows in sorted(self._blows.items()):
            self.say(f'  {name:{WIDTH}} {blows:8,} {self._inputs[name]:15,} {self._faults[name]:8,}')
        self.say(f'  {"all":{WIDTH}} {sum(self._blows.values()):8,} {sum(self._inputs.values()):15,} '
                 f'{sum(self._faults.values()):8,}')
        if self._waits:
            median = statistics.median(wait['median'] for wait in self._waits)
            self.say(f'  {sum(wait["calls"] for wait in self._waits):,} calls of a client of the page meanwhile: the '
                     f'median took {1e3 * median:.1f} ms, the slowest '
                     f'{1e3 * max(wait["worst"] for wait in self._waits):.0f} ms')
        self.say(f'{self.failures} failures')


def _clock(seconds):
    return f'{seconds // 3600:.0f}:{seconds // 60 % 60:02.0f}:{seconds % 60:02.0f}'
