"""Takes part in the lockstep of a simulator: the world waits until this node has answered for a control tick."""

import contextlib
import math
import threading
import time
from typing import Any, Callable, Optional

import rospy
from std_msgs.msg import Header

from rumba_msg.msg import Lockstep, LockstepAnswer

TOPIC = 'simulator/lockstep'  # in the namespace of the simulator, as `simulator/state`
ANSWERS = 'simulator/lockstep_answers'
QUEUE = 10  # answers that may be on their way
SIGN_PERIOD = 0.25  # [s] of the wall clock between two signs of life of a node that is busy
LONGEST = 600.0  # [s] of the wall clock for which the world waits for one piece of work; what takes longer has hung


class Work:
    """Whether a loop is at work, as other threads see it: from `with` to its end, for LONGEST at most.

    A node that starts is at work, too: from the beginning until its loop says `rest`.
    """

    def __init__(self) -> None:
        """Begin with the start of the node."""
        self._since = time.monotonic()

    def __enter__(self) -> None:
        self._since = time.monotonic()

    def __exit__(self, *_: Any) -> None:
        self.rest()

    def rest(self) -> None:
        """Nothing is to be done until the next `with`."""
        self._since = -math.inf

    @property
    def goes_on(self) -> bool:
        """Whether the loop is at work now."""
        return time.monotonic() - self._since < LONGEST


class Resent(rospy.SubscribeListener):
    """Sends to each new subscriber of a topic what the world waits for, in case it was sent just before."""

    def __init__(self) -> None:
        """Send nothing yet."""
        self.message: Optional[Any] = None

    def peer_subscribe(self, topic_name: str, topic_publish: Any, peer_publish: Callable[[Any], None]) -> None:
        """There is a new subscriber."""
        message = self.message
        if message is not None:
            peer_publish(message)


class Participant:
    """This node's part in a lockstep. A node takes part from its first answer on."""

    def __init__(self, on_tick: Callable[[Lockstep], None], is_busy: Callable[[], bool] = lambda: False) -> None:
        """Listen.

        Args:
            on_tick: called once for each control tick, in a thread of rospy; while it works, this node is alive.
            is_busy: whether something else takes long, so that this node tells that it is alive; asked in another
                thread.
        """
        self._work = Work()
        self._work.rest()
        self._last = Resent()
        self._newest: Optional[Lockstep] = None
        self._on_tick = on_tick
        self._is_busy = is_busy
        self._publisher = rospy.Publisher(ANSWERS, LockstepAnswer, self._last, queue_size=QUEUE)
        rospy.Subscriber(TOPIC, Lockstep, self._take, queue_size=QUEUE)
        threading.Thread(target=self._give_signs, daemon=True).start()

    def _take(self, tick: Lockstep) -> None:
        before, self._newest = self._newest, tick
        is_repeated = before is not None and (before.run, before.header.stamp) == (tick.run, tick.header.stamp)
        if not is_repeated:
            with self._work:
                self._on_tick(tick)

    def answer(self, stamp: rospy.Time, command: str = '', rests: bool = False) -> None:
        """Say that everything is done for a control tick.

        Args:
            stamp: of the tick.
            command: name of the topic on which this node has sent a velocity for it; empty if it has not.
            rests: whether the world need not wait for the next answer, since there is nothing to do; see `wake`.
        """
        state = LockstepAnswer.RESTS if rests else LockstepAnswer.DONE
        self._last.message = self._message(stamp, state, rospy.resolve_name(command) if command else '')
        self._publisher.publish(self._last.message)

    def wake(self) -> None:
        """Say that there is something to do again: the world waits for the answer to the next tick."""
        if self._rests:
            self._last.message = self._message(rospy.Time(), LockstepAnswer.BUSY)
            self._publisher.publish(self._last.message)

    def leave(self) -> None:
        """Take part no longer."""
        if self._last.message is not None:
            self._publisher.publish(self._message(self._last.message.header.stamp, LockstepAnswer.LEAVES))
            self._last.message = None

    def _message(self, stamp: rospy.Time, state: int, command: str = '') -> LockstepAnswer:
        run = self._newest.run if self._newest is not None else ''
        return LockstepAnswer(Header(stamp=stamp), run, rospy.get_name(), state, command)

    @property
    def _rests(self) -> bool:
        return self._last.message is not None and self._last.message.state == LockstepAnswer.RESTS

    def _give_signs(self) -> None:
        while not rospy.is_shutdown():
            time.sleep(SIGN_PERIOD)
            if not self._rests and (self._work.goes_on or self._is_busy()):
                with contextlib.suppress(rospy.ROSException):  # the node ends
                    self._publisher.publish(self._message(rospy.Time(), LockstepAnswer.BUSY))
