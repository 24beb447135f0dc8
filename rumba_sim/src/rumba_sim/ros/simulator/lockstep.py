"""The lockstep of a simulator: what it publishes after each control tick, and the answers."""

import collections
import functools
import threading
import time
from typing import Callable, Dict, List, Optional, Set, Tuple

import rospy
from std_msgs.msg import Header

from rumba_msg.msg import Lockstep as LockstepMessage
from rumba_msg.msg import LockstepAnswer
from rumba_sim.ros.running.shared_reception import share
from rumba_sim.ros.participants.examiner import ExaminerServer
from rumba_sim.ros.participants.lockstep import ANSWERS, QUEUE, TOPIC
from rumba_sim.ros.participants.requests import Requests
from rumba_sim.ros.robot.latecomers import Latecomers
from rumba_sim.ros.robot.rates import Due
from rumba_sim.ros.running import peers
from rumba_sim.ros.simulator.participants import STARTING, Participants

LOOK_PERIOD = 0.1  # [s] of the wall clock between two looks at those who do not answer


class Lockstep:
    """Has a world wait after each control tick until everybody who takes part has answered."""

    def __init__(self, requests: Requests, run: str, awaited: str, patience: float,
                 has_publisher: Callable[[str], bool], examiner: Optional[ExaminerServer]) -> None:
        """Open the topics.

        Args:
            requests: to the owner of the world, who calls everything here.
            run: identifies this run of the node.
            awaited: names of nodes and of topics of commands to wait for from the first tick on, with spaces between.
            patience: how long to wait for someone [s] of the wall clock.
            has_publisher: whether a topic has a publisher now, given by its full name.
            examiner: in an examination, gets each tick, and answers.
        """
        self._requests = requests
        self._has_publisher = has_publisher
        self._participants = Participants([rospy.resolve_name(name) for name in awaited.split()], patience)
        self._is_connecting = False  # whether the world waits for connections
        self._is_new = True  # whether it has not waited yet
        self._lost: Set[Tuple[str, str]] = set()  # topics, and nodes that never connected to them
        self._asked: Optional[threading.Thread] = None  # asks whether someone who is silent has ended
        self._tick = LockstepMessage(run=run)
        self._publisher = rospy.Publisher(TOPIC, LockstepMessage, Latecomers(requests, self._held), queue_size=QUEUE)
        share(rospy.resolve_name(ANSWERS))
        self._subscriber = rospy.Subscriber(ANSWERS, LockstepAnswer, self._on_answer, queue_size=QUEUE)
        self._examiner = examiner
        self._judges: Set[str] = set()  # nodes that have answered as the examiner: no other node answers for them
        if examiner is not None:
            examiner.declare(self._publisher.resolved_name, LockstepMessage)

    def publish(self, due: Due, stamp: rospy.Time, resets: int) -> None:
        """Publish a tick, if it is a control tick, after everything else of that tick; the world must wait then.

        Args:
            due: what else was published.
            stamp: of the tick.
            resets: of the world.
        """
        tick = self._tick
        if due.odom:
            tick.odom = stamp
        if due.scan:
            tick.scan = stamp
        if due.cleaning and self._examiner is None:
            tick.cleaning = stamp
        if due.sensors:
            tick.header, tick.resets = Header(stamp=stamp), resets
            self._participants.begin(stamp)
            if self._examiner is not None:
                self._examiner.tell(self._publisher.resolved_name, tick, stamp)
            if self._publisher.get_num_connections():
                self._publisher.publish(tick)

    def wake(self) -> None:
        """Wait for those who rest too after the next tick: while the world stood, they may have got something to do."""
        self._participants.wake()

    def reset(self) -> None:
        """The world was reset: what was published before belongs to another one."""
        self._tick.odom = self._tick.scan = self._tick.cleaning = rospy.Time()

    def wait(self, meanwhile: Callable[[], None], but: str = '') -> None:
        """Serve requests until no answer is missing.

        Who takes long may be starting, and with it others: then those who have subscribed connect, before time passes.

        Args:
            meanwhile: called from time to time.
            but: name of a node for which not to wait.
        """
        begin = time.monotonic()
        self._wait_for_answers(meanwhile, but)
        if self._is_new or time.monotonic() > begin + LOOK_PERIOD:
            self._is_new = False
            self._is_connecting = True
            self._wait_for_connections(meanwhile)
            self._is_connecting = False

    def _wait_for_answers(self, meanwhile: Callable[[], None], but: str) -> None:
        while self._participants.missing(but) and not rospy.is_shutdown():
            self._requests.serve(time.monotonic() + LOOK_PERIOD, lambda: not self._participants.missing(but))
            self._look_for_the_ended()
            for name, patience in self._participants.give_up(self._has_publisher):
                rospy.logwarn(f'lockstep: no answer of {name} for {patience:g} s: the world goes on without it '
                              'until it answers again')
            if self._participants.missing(but):
                meanwhile()

    def _look_for_the_ended(self) -> None:
        """Ask, in a thread, whether those who are silent have ended: nobody needs to wait for these."""
        silent = self._participants.silent()
        if silent and (self._asked is None or not self._asked.is_alive()):
            self._asked = threading.Thread(target=self._ask, args=[silent], daemon=True)
            self._asked.start()

    def _ask(self, nodes: List[str]) -> None:
        for node in filter(peers.has_ended, nodes):
            self._requests.post(functools.partial(self._lose, node))

    def _lose(self, node: str) -> None:
        """Wait no longer for a node that has ended, unless it was started again meanwhile."""
        if node in self._participants.silent():
            self._participants.forget(node)
            rospy.logwarn(f'lockstep: {node} has ended without a word: the world goes on without it until it answers '
                          'again')

    def _wait_for_connections(self, meanwhile: Callable[[], None]) -> None:
        """Serve requests, and so send this tick to new subscribers, until all who have subscribed are connected."""
        begin = time.monotonic()
        ended: Dict[str, bool] = {}  # by the names of nodes, whether they have ended
        while True:
            lacking = self._unconnected(ended)
            self._requests.serve(time.monotonic())  # also for those who connected just before that look
            if not lacking or time.monotonic() > begin + self._patience_with(lacking) or rospy.is_shutdown():
                break
            self._requests.serve(time.monotonic() + LOOK_PERIOD)
            meanwhile()
        topics = collections.defaultdict(list)
        for topic, node in sorted(lacking):
            topics[node].append(topic)
        for node, names in topics.items():
            rospy.logwarn(f'lockstep: {node} has subscribed to {", ".join(names)}, but does not connect: the world '
                          'goes on without it')
        self._lost |= lacking

    def _patience_with(self, lacking: Set[Tuple[str, str]]) -> float:
        """How long to wait for connections [s]: a participant that starts has more time."""
        is_awaited = any(self._participants.has(node) for _, node in lacking)
        return self._participants.patience * (STARTING if is_awaited else 1.0)

    def _unconnected(self, ended: Dict[str, bool]) -> Set[Tuple[str, str]]:
        """Topics, and nodes that have subscribed and may still connect; `ended` keeps what is known of these."""
        try:
            lacking = peers.unconnected() - self._lost
        except peers.NO_ANSWER:  # the master has ended
            return set()
        for node in {node for _, node in lacking}.difference(ended):
            ended[node] = peers.has_ended(node)
        return {(topic, node) for topic, node in lacking if not ended[node]}

    def wait_for_commanders(self, meanwhile: Callable[[], None]) -> None:
        """Serve requests until each topic that is waited for from the first tick on has a publisher, for its patience.

        Otherwise the first command might be lost or not, as its publisher connects before or after it.

        Args:
            meanwhile: called from time to time.
        """
        end = time.monotonic() + self._participants.patience

        def are_all_here() -> bool:
            return all(map(self._has_publisher, self._participants.topics))
        while not are_all_here() and time.monotonic() < end and not rospy.is_shutdown():
            self._requests.serve(time.monotonic() + LOOK_PERIOD, are_all_here)
            meanwhile()

    def on_command(self, topic: str) -> None:
        """A command came on a topic, given by its full name; may be called from any thread."""
        self._requests.post(lambda: self._participants.commanded(topic))

    def on_examiner(self, answer: LockstepAnswer) -> None:
        """The judge of an examination has answered; may be called from any thread."""
        self._judges.add(answer.node)
        self._take(answer)

    def _on_answer(self, answer: LockstepAnswer) -> None:
        if answer.node not in self._judges:
            self._take(answer)

    def _take(self, answer: LockstepAnswer) -> None:
        if answer.run == self._tick.run:
            self._requests.post(lambda: self._participants.take(answer))

    @property
    def is_waiting(self) -> bool:
        """Whether an answer or a connection is missing."""
        return self._is_connecting or bool(self._participants.missing())

    def _held(self) -> Optional[LockstepMessage]:
        """What those who come late have missed."""
        return self._tick if self.is_waiting else None
