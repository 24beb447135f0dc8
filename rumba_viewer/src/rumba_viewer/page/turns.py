"""How much of the page each client may use, and whose turn it is. Whoever calls says what time it is, in seconds."""

import math
from typing import Any, Callable, Dict, List, NamedTuple, Tuple

OF_ALL = 0.5  # of a core that the work for all clients together may take
AT_ONCE = 0.02  # [s] of CPU time that all together may take at once
LATELY = 10.0  # [s] in which what was used is forgotten: the time constant


class Bucket:
    """A token bucket: it fills at a rate, and whoever takes more than is in it must wait."""

    def __init__(self, rate: float, most: float, now: float, first: float) -> None:
        """Fill at a rate [1/s] up to `most`; `first` is in it at first."""
        self._rate, self._most, self._before = rate, most, now
        self._left = first

    def left(self, now: float) -> float:
        """What is in it; less than 0 if more was taken."""
        self._left = min(self._left + (now - self._before) * self._rate, self._most)
        self._before = now
        return self._left

    def pay(self, amount: float, now: float) -> None:
        """Take an amount, even if so much is not in it."""
        self._left = self.left(now) - amount

    def takes(self, now: float) -> bool:
        """Take one; returns whether it was in it."""
        self.pay(1.0, now)
        return self._left >= 0.0

    def wait(self, now: float) -> float:
        """How long until no more is taken than was in it [s]."""
        return max(-self.left(now) / self._rate, 0.0)


class Limit(NamedTuple):
    """How much of something a client may use.

    Attributes:
        rate: in a second.
        most: at once.
        first: at once when it comes.
        words: what a client is told that uses more.
    """

    rate: float
    most: float
    first: float
    words: str


class Account:
    """What one client, or all connections of one address, have used.

    Attributes:
        is_client: whether it is a client's.
    """

    def __init__(self, now: float, cpu: Limit, used: float = 0.0, is_client: bool = True, **others: Limit) -> None:
        """Count CPU time [s], of which so much counts as used already, and others, by name."""
        self.is_client = is_client
        self._limits = {'cpu': cpu, **others}
        self._buckets = {name: Bucket(limit.rate, limit.most, now, limit.first)
                         for name, limit in self._limits.items()}
        self._used, self._before = used, now

    def used(self, now: float) -> float:
        """The CPU time that was used lately [s]."""
        self._used *= math.exp((self._before - now) / LATELY)
        self._before = now
        return self._used

    def pay(self, now: float, cpu: float, **others: float) -> None:
        """Use CPU time [s] and others, by name."""
        self._used = self.used(now) + cpu
        for name, amount in {'cpu': cpu, **others}.items():
            self._buckets[name].pay(amount, now)

    def wait(self, now: float) -> float:
        """How long until this client may go on [s]."""
        return max(bucket.wait(now) for bucket in self._buckets.values())

    def bound(self, now: float) -> str:
        """The words of the limit that lets the client wait longest."""
        return self._limits[max(self._buckets, key=lambda name: self._buckets[name].wait(now))].words


class Turns:
    """Lets clients work one after the other: whoever used least lately is next.

    If both clients and new connections wait, they alternate.
    """

    def __init__(self, clock: Callable[[], float], later: Callable[[float, Callable[[], None]], Any]) -> None:
        """Read the time from a clock; call functions `later`, after a time [s]."""
        self._clock, self._later = clock, later
        self._all = Bucket(OF_ALL, AT_ONCE, clock(), AT_ONCE)
        self._waiting: List[Tuple[Account, Callable[[], None]]] = []
        self._was_client = False
        self._due = math.inf  # when the next look is due

    def ask(self, account: Account, begin: Callable[[], None]) -> None:
        """Call `begin` as soon as it is the turn of an account."""
        self._waiting.append((account, begin))
        self._look(0.0)

    def release(self, account: Account) -> None:
        """Let all go on that wait for the turn of an account, whose client has left."""
        released = [begin for other, begin in self._waiting if other is account]
        self._waiting = [(other, begin) for other, begin in self._waiting if other is not account]
        for begin in released:
            begin()

    def pay(self, account: Account, seconds: float, **others: float) -> None:
        """Note what an account has used: CPU time [s] and others."""
        now = self._clock()
        account.pay(now, seconds, **others)
        self._all.pay(seconds, now)

    def pause(self) -> float:
        """How long until anybody may go on [s]."""
        return self._all.wait(self._clock())

    def _look(self, seconds: float) -> None:
        """Look in some seconds who is next, unless that is done earlier."""
        due = self._clock() + seconds
        if due < self._due:
            self._due = due
            self._later(seconds, self._next)

    def _next(self) -> None:
        """Give the turn to one who waits, if anybody may go on."""
        self._due = math.inf
        now = self._clock()
        pause = self._all.wait(now)
        if not pause:
            waits: Dict[int, float] = {number: account.wait(now) for number, (account, _) in enumerate(self._waiting)}
            ready = [number for number, wait in waits.items() if not wait]
            if ready:
                first = min(ready, key=lambda number: self._rank(self._waiting[number][0], now))
                account, begin = self._waiting.pop(first)
                self._was_client = account.is_client
                begin()
            else:
                pause = min(waits.values(), default=0.0)
        if self._waiting:
            self._look(pause)

    def _rank(self, account: Account, now: float) -> Tuple[bool, float]:
        """The lower, the sooner an account gets its turn."""
        return account.is_client == self._was_client, account.used(now)
