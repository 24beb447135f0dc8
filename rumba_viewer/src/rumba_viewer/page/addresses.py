"""What the page remembers of each address that connects: what it used, which tokens it tried, what was refused."""

import collections
from typing import Any, Callable, Deque, Dict

from rumba_sim.model.common.errors import one_line
from rumba_viewer.page.turns import Account, Bucket, Limit

SHARE, BURST = 0.2, 0.1  # of a core, and [s] of CPU time at once, for all requests of one address
GUESSES, GUESS_PERIOD = 10, 12.0  # wrong tokens at once of one address, and [s] until one more
LINES, LINE_PERIOD = 5, 10.0  # lines of the log at once about one address, and [s] until one more
LINES_OF_ALL = 50  # at once about all addresses together
REMEMBERED = 1000  # addresses, at least


class Guesses:
    """Wrong tokens of one address."""

    def __init__(self, now: float) -> None:
        """Begin without any."""
        self._bucket = Bucket(1.0 / GUESS_PERIOD, GUESSES, now, GUESSES)
        self._tried: Deque[int] = collections.deque(maxlen=GUESSES)

    def wait(self, token: str, now: float) -> float:
        """How long until this token may be tried [s]: one that was tried before, as browsers do, is no new guess."""
        return 0.0 if hash(token) in self._tried else max((1.0 - self._bucket.left(now)) * GUESS_PERIOD, 0.0)

    def add(self, token: str, now: float) -> None:
        """Note that a token is wrong."""
        if hash(token) not in self._tried:
            self._tried.append(hash(token))
            self._bucket.pay(1.0, now)


class Lines:
    """Lines of the log about one address: a few at once, then one after the other; the rest is counted."""

    def __init__(self, now: float, most: int = LINES) -> None:
        """Allow so many lines at once."""
        self._bucket = Bucket(1.0 / LINE_PERIOD, most, now, most)
        self.omitted = 0

    def may(self, now: float) -> bool:
        """Whether one more line may be written."""
        return self._bucket.left(now) >= 1.0

    def add(self, now: float) -> None:
        """Note that a line is written."""
        self._bucket.pay(1.0, now)
        self.omitted = 0


class Address:
    """One address."""

    def __init__(self, name: str, now: float) -> None:
        """Begin with nothing used."""
        self.name = name
        self.account = Account(now, Limit(SHARE, BURST, BURST, 'requests'), is_client=False)
        self.guesses = Guesses(now)
        self.lines = Lines(now)
        self.newest = ''  # line that was not written
        self.streams: Dict[Any, None] = {}  # connections that may be closed, the oldest first
        self.asking: Dict[Any, None] = {}  # those of them whose request waits for its turn


class Addresses:
    """All addresses that were seen lately."""

    def __init__(self, clock: Callable[[], float], warn: Callable[[str], object]) -> None:
        """Write lines by `warn`."""
        self._clock, self._warn = clock, warn
        self._known: 'collections.OrderedDict[str, Address]' = collections.OrderedDict()
        self._all = Lines(clock(), LINES_OF_ALL)

    def find(self, name: str) -> Address:
        """What is known of an address; of those without connections, the ones that were seen last are remembered."""
        found = self._known.pop(name, None) or Address(name, self._clock())
        self._known[name] = found
        if len(self._known) > REMEMBERED:
            unused = (known for known in self._known.values() if not known.streams and known is not found)
            for oldest in list(unused)[:1]:
                del self._known[oldest.name]
        return found

    def oldest(self, connections: Callable[[Address], Dict[Any, None]], most: int) -> Any:
        """The oldest of so many connections, or more, of the address that has most of them; None if they are fewer."""
        each = [connections(address) for address in self._known.values()]
        fullest: Dict[Any, None] = max(each, key=len, default={})
        return next(iter(fullest)) if sum(map(len, each)) >= most else None

    def note(self, address: Address, line: str) -> None:
        """Write a line about what was refused to an address, unless there were many."""
        now = self._clock()
        if address.lines.may(now) and self._all.may(now):
            more = f' ({address.lines.omitted} more were refused before)' if address.lines.omitted else ''
            self._warn(one_line(f'client at {address.name}: {line}{more}'))
            self._all.add(now)
            address.lines.add(now)
        else:
            address.lines.omitted += 1
            address.newest = line

    def flush(self) -> None:
        """Write how much was left out, as soon as a line may be written about it."""
        for address in list(self._known.values()):
            if address.lines.omitted and address.lines.may(self._clock()):
                address.lines.omitted -= 1
                self.note(address, address.newest)
