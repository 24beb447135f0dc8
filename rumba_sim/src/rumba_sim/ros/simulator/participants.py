"""For whom a world in lockstep waits after a control tick, and how long."""

import time
from typing import Callable, List, Optional, Set, Tuple

import rospy

from rumba_msg.msg import LockstepAnswer

COMMANDS = '/cmd_vel'  # a name that ends so is that of a topic, every other one that of a node
STARTING = 3.0  # times the usual patience for a participant that was never heard: it may still be starting
SILENT = 1.0  # [s] of the wall clock without a sign, after which it is worth asking whether a node has ended
FIRST_COMMAND = 1.0  # [s] of the wall clock from the first publisher of a topic to its first command, which may be lost


class Member:
    """Someone for whom the world waits: a node that answers, or whoever commands on a topic.

    Attributes:
        patience: how long the world waits for a sign of it [s] of the wall clock.
        heard: when it gave the last sign, as a time of `time.monotonic`.
        was_heard: whether it has ever given a sign.
        command: the topic whose command it has announced, and that has not come yet; empty if there is none.
        rests: whether it has nothing to do, so that the world does not wait for it.
        first_until: time of `time.monotonic` until which the world waits for a first command that may be lost.
    """

    def __init__(self, patience: float) -> None:
        """Nothing was heard of it, until now."""
        self.patience = patience
        self.heard = time.monotonic()
        self.was_heard = False
        self.command = ''
        self.rests = False
        self.first_until: Optional[float] = None


class Participants:
    """The members of a lockstep, and whose answer to the newest control tick is missing.

    Not thread-safe: all calls are made by the owner of the world.

    Attributes:
        patience: how long to wait for someone who was heard before [s] of the wall clock.
        topics: full names of the topics of commands that are waited for from the first tick on.
    """

    def __init__(self, awaited: List[str], patience: float) -> None:
        """Wait for these from the first tick on.

        Args:
            awaited: full names of nodes, and of topics of commands.
            patience: how long to wait for someone who was heard before [s] of the wall clock.
        """
        self.patience = patience
        self.topics = [name for name in awaited if name.endswith(COMMANDS)]
        self._members = {name: Member(STARTING * patience) for name in awaited}
        self._missing: Set[str] = set()
        self._commanded: Set[str] = set()  # topics on which a command came since the tick
        self._stamp = rospy.Time()

    def begin(self, stamp: rospy.Time) -> None:
        """A control tick was published."""
        self._stamp = stamp
        self._missing = {name for name, member in self._members.items() if not member.rests}
        self._commanded.clear()
        now = time.monotonic()
        for member in self._members.values():
            member.heard, member.command = now, ''

    def wake(self) -> None:
        """Wait for those who rest too at the next tick: they may have got something to do."""
        for member in self._members.values():
            member.rests = False

    def missing(self, but: str = '') -> Set[str]:
        """Whose answer is missing; `but` is the name of someone who does not count."""
        return self._missing - {but} if but else self._missing

    def commanded(self, topic: str) -> None:
        """A command came on a topic, given by its full name."""
        self._commanded.add(topic)
        if topic in self.topics:
            self._hear(topic)
        for name in [name for name in self._missing if topic in (name, self._members[name].command)]:
            self._missing.discard(name)

    def take(self, answer: LockstepAnswer) -> None:
        """Someone has answered; a sign of life alone makes nobody a member."""
        if answer.state == LockstepAnswer.LEAVES:
            self.forget(answer.node)
            return
        if answer.state == LockstepAnswer.BUSY and not self.has(answer.node):
            return
        member = self._hear(answer.node)
        if answer.state != LockstepAnswer.RESTS:
            member.rests = False
        if answer.state != LockstepAnswer.BUSY and answer.header.stamp == self._stamp:
            member.rests = answer.state == LockstepAnswer.RESTS
            member.command = answer.command
            if not answer.command or answer.command in self._commanded:
                self._missing.discard(answer.node)

    def has(self, name: str) -> bool:
        """Whether someone takes part."""
        return name in self._members

    def forget(self, name: str) -> None:
        """Someone takes part no longer, until it answers again."""
        self._members.pop(name, None)
        self._missing.discard(name)

    def silent(self) -> List[str]:
        """The nodes whose answer is missing, and that have been silent for a while: they may have ended."""
        now = time.monotonic()
        return [name for name in sorted(self._missing) if not name.endswith(COMMANDS) and self._members[name].was_heard
                and now - self._members[name].heard > SILENT]

    def _hear(self, name: str) -> Member:
        """Note a sign of someone, who is a member from the next tick on."""
        member = self._members.setdefault(name, Member(self.patience))
        member.heard, member.patience, member.first_until = time.monotonic(), self.patience, None
        member.was_heard = True
        return member

    def give_up(self, has_publisher: Callable[[str], bool]) -> List[Tuple[str, float]]:
        """Wait no longer for those of whom nothing was heard for too long, until they answer again.

        Whoever commands at a rate of its own may have lost its first command, and sends the next one only when time
        has passed: the world does not wait long for the first one.

        Args:
            has_publisher: whether a topic has a publisher now, given by its full name.

        Returns:
            their names, and how long the world has waited for each [s] of the wall clock.
        """
        late = []
        for name in sorted(self._missing):
            member = self._members[name]
            if member.patience > self.patience and name in self.topics and has_publisher(name):
                member.patience, member.first_until = self.patience, time.monotonic() + FIRST_COMMAND
            if member.first_until is not None:
                if time.monotonic() > member.first_until:
                    self._missing.discard(name)
                    member.first_until = None
            elif time.monotonic() - member.heard > member.patience:
                self.forget(name)
                late.append((name, member.patience))
        return late
