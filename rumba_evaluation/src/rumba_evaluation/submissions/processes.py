"""Processes below a process: how many there are, how much memory they have, and how to end them all."""

import contextlib
import ctypes
import os
import signal
import threading
import time
from typing import Collection, Dict, List, NamedTuple

PAGE = os.sysconf('SC_PAGE_SIZE')
PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36  # of linux/prctl.h
ROUND = 0.005  # [s] of the wall clock between two looks for processes that were started while others were ended
ENDS_WITHIN = 10.0  # [s] of the wall clock until it gives up, as for a process that waits for a disk
_adopts = threading.Event()  # is set if children of this process may be orphans


class Load(NamedTuple):
    """What processes take."""

    number: int
    memory: int  # [bytes] resident; what is shared counts for each


class _Entry(NamedTuple):
    parent: int
    session: int
    state: str
    pages: int


def below(root: int) -> List[int]:
    """The processes that a process has started, those that they have started, and so on; the dead are left out."""
    return _below(root, _table())


def load(root: int) -> Load:
    """What the processes below a process take."""
    table = _table()
    found = _below(root, table)
    return Load(len(found), PAGE * sum(table[number].pages for number in found))


def end_all(root: int) -> None:
    """Kill all processes below a process: they are stopped first, so that none starts others in the meantime."""
    limit = time.monotonic() + ENDS_WITHIN
    while time.monotonic() < limit:
        found = below(root)
        if not found:
            return
        for sent in (signal.SIGSTOP, signal.SIGKILL):
            for number in found:
                with contextlib.suppress(ProcessLookupError, PermissionError):
                    os.kill(number, sent)
        time.sleep(ROUND)


def end_strangers(known: Collection[int]) -> None:
    """End all children in other sessions that are not known, with all below them, if this process adopts orphans.

    What this process starts in its own session, such as a tool, is no orphan: none can come into that.
    """
    own, session = os.getpid(), os.getsid(0)
    if not _adopts.is_set():
        return
    for number, entry in _table().items():
        if entry.parent == own and entry.session != session and number not in known:
            with contextlib.suppress(OSError):
                os.kill(number, signal.SIGSTOP)
                end_all(number)
                os.kill(number, signal.SIGKILL)
                os.waitpid(number, 0)


def adopt_orphans() -> None:
    """Become the parent of processes below this one that lose theirs: otherwise they would be below nobody.

    From now on, this process tells `end_strangers` of each that it starts in another session.
    """
    _prctl(PR_SET_CHILD_SUBREAPER, 1)
    _adopts.set()


def end_with_parent(sent: signal.Signals) -> None:
    """Get a signal as soon as the thread ends that has started this process."""
    _prctl(PR_SET_PDEATHSIG, sent)


def _prctl(option: int, value: int) -> None:
    if ctypes.CDLL(None, use_errno=True).prctl(option, value, 0, 0, 0) != 0:
        raise OSError(ctypes.get_errno(), f'prctl {option}')


def _table() -> Dict[int, _Entry]:
    """All processes, by number. Source of the format: proc_pid_stat(5)."""
    found = {}
    for name in filter(str.isdigit, os.listdir('/proc')):
        with contextlib.suppress(OSError):
            with open(f'/proc/{name}/stat', 'rb') as file:
                words = file.read().rpartition(b')')[2].split()  # the name before may hold anything
            found[int(name)] = _Entry(int(words[1]), int(words[3]), words[0].decode(), int(words[21]))
    return found


def _below(root: int, table: Dict[int, _Entry]) -> List[int]:
    children: Dict[int, List[int]] = {}
    for number, entry in table.items():
        children.setdefault(entry.parent, []).append(number)
    found: List[int] = []
    waiting = [root]
    while waiting:
        for number in children.get(waiting.pop(), []):
            waiting.append(number)
            if table[number].state not in 'ZX':
                found.append(number)
    return found
