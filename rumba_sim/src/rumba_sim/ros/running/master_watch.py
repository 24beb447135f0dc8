"""Notices that the master was restarted, and registers this node there again; says if time stands still."""

import math
import threading
import time
from typing import Callable, Iterable, List, Optional

import rosgraph
import rospy
from rospy.impl.registration import Registration, get_registration_listeners, get_service_manager, get_topic_manager

from rumba_sim.model.common.errors import RumbaError
from rumba_sim.ros.running import clock, peers
from rumba_sim.ros.running.peers import NO_ANSWER

PERIOD = 1.0  # [s] between two looks at the master
CLOCK_PATIENCE = 5.0  # [s] of the wall clock within which a node that uses /clock should hear it

_before_return: List[Callable[[], object]] = []
_after_return: List[Callable[[], object]] = []


def before_return(check: Callable[[], object]) -> None:
    """Call a function before this node registers at a new master; it may raise a RumbaError, which ends the node."""
    _before_return.append(check)


def after_return(repair: Callable[[], object]) -> None:
    """Call a function after this node has registered at a new master, which knows no parameter of the old one."""
    _after_return.append(repair)


def start() -> None:
    """Watch the master, in a thread of its own, until ROS shuts down; this node is registered."""
    threading.Thread(target=MasterWatch().run, daemon=True).start()


class MasterWatch:
    """Looks at the master again and again."""

    def __init__(self) -> None:
        """This node is registered at the master."""
        self._name = rospy.get_name()
        self._master = peers.hasty_master(self._name)
        self._pid: Optional[int] = None  # of the master at which all of this node is registered; None: unknown
        self._uri = rospy.core.get_node_uri()
        self._is_gone = False
        self._clock_by = time.monotonic() + CLOCK_PATIENCE  # when it should have heard the time

    def run(self) -> None:
        """Look until ROS shuts down."""
        while not rospy.is_shutdown():
            time.sleep(PERIOD)
            self._look_for_time()
            self.look()

    def look(self) -> None:
        """Look once, and do what is necessary."""
        try:
            pid, uri = self._master.getPid(), self._known_uri()
        except NO_ANSWER:
            self._miss()
            return
        if rospy.core.is_shutdown_requested():
            return  # which takes the node from the master
        self._is_gone = False
        self._pid = self._pid or pid
        if not uri:
            self._return(pid, _before_return)
        elif uri != self._uri:
            _end(f'another node has taken the name {self._name}')
        elif pid != self._pid:  # it knows only what was registered since it was restarted
            self._return(pid, [])

    def _known_uri(self) -> str:
        """Where the master says that this node is; empty if it does not know this node."""
        try:
            uri: str = self._master.lookupNode(self._name)
        except rosgraph.MasterException:
            return ''
        return uri

    def _miss(self) -> None:
        if not self._is_gone and not rospy.core.is_shutdown_requested():
            rospy.logwarn(f'the master at {rosgraph.get_master_uri()} does not answer: this node goes on, and '
                          'registers again when there is a master')
        self._is_gone = True

    def _return(self, pid: int, checks: Iterable[Callable[[], object]]) -> None:
        try:
            for check in checks:
                check()
            _register_again()
            self._pid = pid
            for repair in _after_return:
                repair()
        except RumbaError as error:
            _end(str(error))
        except NO_ANSWER:
            self._miss()
        except rospy.ROSInterruptException:
            pass  # ROS shuts down
        else:
            rospy.logwarn('the master was restarted: this node has registered again')

    def _look_for_time(self) -> None:
        if time.monotonic() < self._clock_by:
            return
        self._clock_by = math.inf
        if clock.is_unknown():
            rospy.logwarn('/use_sim_time is true, but nothing publishes /clock: for this node, time stands still. '
                          'Start a simulator; or run `rosparam delete /use_sim_time`, and start this node again')


def _register_again() -> None:
    topics, listeners = get_topic_manager(), get_registration_listeners()
    for kind, registered in ((Registration.PUB, topics.get_publications()),
                             (Registration.SUB, topics.get_subscriptions()),
                             (Registration.SRV, get_service_manager().get_services())):
        for name, what in registered:
            listeners.notify_added(name, what, kind)


def _end(reason: str) -> None:
    """End this node."""
    rospy.logfatal(f'the master was restarted, and this node ends: {reason}')
    rospy.signal_shutdown(reason)
