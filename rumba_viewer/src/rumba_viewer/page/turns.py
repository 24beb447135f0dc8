"""How much of the page each client may use, and whose turn it is. Whoever calls says what time it is, in seconds."""

import collections
import functools
import heapq
import itertools
import math
from typing import Any, Callable, Deque, Dict, Iterable, List, NamedTuple, Optional, Tuple

OF_CLIENTS, OF_CONNECTIONS = 0.35, 0.15  # of a core that all clients, and all new connections, may take
AT_ONCE = 0.02  # [s] of CPU time that either may take at once
LATELY = 10.0  # [s] in which what was used is forgotten: the time constant
Begin = Callable[[], None]  # lets one that waited go on


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
        rank: the lower, the less was used lately: all forget at the same rate, so that time changes no order.
    """

    def __init__(self, now: float, cpu: Limit, used: float = 0.0, is_client: bool = True, **others: Limit) -> None:
        """Count CPU time [s], of which so much counts as used already, and others, by name."""
        self.is_client = is_client
        self._limits = {'cpu': cpu, **others}
        self._buckets = {name: Bucket(limit.rate, limit.most, now, limit.first)
                         for name, limit in self._limits.items()}
        self.rank = _logarithm(used) + now / LATELY

    def used(self, now: float) -> float:
        """The CPU time that was used lately [s]."""
        return math.exp(self.rank - now / LATELY)

    def pay(self, now: float, cpu: float, **others: float) -> None:
        """Use CPU time [s] and others, by name."""
        self.rank = _logarithm(self.used(now) + cpu) + now / LATELY
        for name, amount in {'cpu': cpu, **others}.items():
            self._buckets[name].pay(amount, now)

    def wait(self, now: float) -> float:
        """How long until this client may go on [s]."""
        return max(bucket.wait(now) for bucket in self._buckets.values())

    def bound(self, now: float) -> str:
        """The words of the limit that lets the client wait longest."""
        return self._limits[max(self._buckets, key=lambda name: self._buckets[name].wait(now))].words


class Queue:
    """Accounts that wait for their turn, and what all together may use: whoever used least lately is next."""

    def __init__(self, share: float, now: float) -> None:
        """Let all together use a share of a core."""
        self.together = Bucket(share, AT_ONCE, now, AT_ONCE)
        self._waiting: Dict[Account, Deque[Begin]] = {}
        self._resting: List[Tuple[float, int, Account]] = []  # a heap, by when they may go on
        self._ready: List[Tuple[float, int, Account]] = []  # a heap, by rank
        self._numbers = itertools.count()  # of equals, whoever came first goes first

    def add(self, account: Account, begin: Begin, now: float) -> None:
        """Have an account wait for one more turn."""
        if account not in self._waiting:
            self._waiting[account] = collections.deque()
            self._line_up(account, now)
        self._waiting[account].append(begin)

    def remove(self, account: Account) -> Iterable[Begin]:
        """Let an account wait no longer; returns what it waited for."""
        return self._waiting.pop(account, ())

    def wait(self, now: float) -> float:
        """How long until one of them may go on [s]; infinite if none waits."""
        if not self._waiting:
            return math.inf
        first = 0.0 if self._ready else self._resting[0][0] - now
        return max(first, self.together.wait(now))

    def take(self, now: float) -> Optional[Begin]:
        """What the account that is next waited for; None if none may go on."""
        while self._resting and self._resting[0][0] <= now:
            _, number, account = heapq.heappop(self._resting)
            heapq.heappush(self._ready, (account.rank, number, account))
        while self._ready and not self.together.wait(now):
            rank, _, account = heapq.heappop(self._ready)
            if account.rank > rank:
                self._line_up(account, now)  # it used more while it waited
            elif account in self._waiting:
                return self._first(account, now)
        return None

    def _first(self, account: Account, now: float) -> Begin:
        queue = self._waiting[account]
        begin = queue.popleft()
        if queue:
            self._line_up(account, now)
        else:
            del self._waiting[account]
        return begin

    def _line_up(self, account: Account, now: float) -> None:
        wait = account.wait(now)
        heap, key = (self._resting, now + wait) if wait else (self._ready, account.rank)
        heapq.heappush(heap, (key, next(self._numbers), account))


class Turns:
    """Lets clients work one after the other, and new connections, which have a queue of their own.

    So no client has to wait until many new connections are paid for.
    """

    def __init__(self, clock: Callable[[], float], later: Callable[[float, Begin], Any]) -> None:
        """Read the time from a clock; call functions `later`, after a time [s]."""
        self._clock, self._later = clock, later
        self._clients, self._connections = Queue(OF_CLIENTS, clock()), Queue(OF_CONNECTIONS, clock())
        self._due = math.inf  # when the next look is due

    def ask(self, account: Account, begin: Begin) -> None:
        """Call `begin` as soon as it is the turn of an account."""
        self._queue(account).add(account, begin, self._clock())
        self._look(0.0)

    def release(self, account: Account) -> None:
        """Let all go on that wait for the turn of an account, whose client has left."""
        for begin in self._queue(account).remove(account):
            begin()

    def pay(self, account: Account, seconds: float, **others: float) -> None:
        """Note what an account has used: CPU time [s] and others."""
        now = self._clock()
        account.pay(now, seconds, **others)
        self._queue(account).together.pay(seconds, now)

    def pause(self) -> float:
        """How long until new connections may be let in [s]."""
        return self._connections.together.wait(self._clock())

    def _queue(self, account: Account) -> Queue:
        return self._clients if account.is_client else self._connections

    def _look(self, seconds: float) -> None:
        """Look in some seconds who is next, unless that is done earlier."""
        due = self._clock() + seconds
        if due < self._due:
            self._due = due
            self._later(seconds, functools.partial(self._next, due))

    def _next(self, due: float) -> None:
        """Give the turn to one client and one new connection that may go on, unless an earlier look did."""
        if due != self._due:
            return
        self._due = math.inf
        now = self._clock()
        for begin in filter(None, (self._clients.take(now), self._connections.take(now))):
            begin()
        wait = min(self._clients.wait(now), self._connections.wait(now))
        if wait < math.inf:
            self._look(wait)


def _logarithm(value: float) -> float:
    return math.log(value) if value else -math.inf
