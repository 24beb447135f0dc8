"""A master of its own on the loopback, and the nodes of a scenario: started, asked, and started again."""

import contextlib
import os
import time
import uuid

import psutil
import roslib.message
from common.ros_session import free_port, wait_until

from stress import wire
from stress.failure import Failure
from stress.member import Member, Role

STARTS_WITHIN = 60.0  # [s]
SETTLES_WITHIN = 8.0  # [s] from a start until nothing more opens or closes
STEADY = 0.4  # [s] without a change: it has settled
FORGOTTEN = ('ROS_IP', 'ROS_NAMESPACE', 'ROSCONSOLE_CONFIG_FILE', 'DISPLAY', 'WAYLAND_DISPLAY')


class Ground:
    """The master and the nodes, and what blows and oracles ask of them.

    Attributes:
        scenario: which nodes there are.
        folder: where they work; their home and their logs are in it.
        master: the process of the master.
        members: the processes of the nodes, by name.
        publishers: how messages are sent to them.
        memory: what the oracles know of the world from the last look, None if it is a new one.
    """

    def __init__(self, scenario, folder, publishers):
        """Prepare a scenario in an empty folder."""
        self.scenario, self.folder, self.publishers = scenario, folder, publishers
        self.memory = None
        port = free_port()
        self.uri = f'http://{wire.HOST}:{port}/'
        for name in ('home', 'log'):
            (folder / name).mkdir(0o700, exist_ok=True)
        self.environment = {
            **{name: value for name, value in os.environ.items() if name not in FORGOTTEN},
            'ROS_MASTER_URI': self.uri, 'ROS_HOSTNAME': wire.HOST, 'HOME': str(folder / 'home'),
            'ROS_LOG_DIR': str(folder / 'log'), 'QT_QPA_PLATFORM': 'offscreen', 'XDG_RUNTIME_DIR': str(folder / 'home')}
        self.master = self._member(Role('/master', 'rosmaster', 'rosmaster', arguments=('--core', '-p', str(port)),
                                        keeps=32))
        self.members = {role.name: self._member(role) for role in scenario.roles}

    def _member(self, role):
        return Member(role, self.environment, self.folder)

    # --- life -----------------------------------------------------------------------------------------------------

    def __enter__(self):
        try:
            self.start_master()
            for member in self.members.values():
                self.start(member)
        except BaseException:
            self.close()
            raise
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """End everything."""
        for member in [*self.members.values(), self.master]:
            member.kill()

    def start_master(self):
        """Start the master, and wait until it answers."""
        self.master.start()
        self._wait(self.master, lambda: self._asks('getPid') == self.master.process.pid)
        # As roscore does.
        for name, value in (('/run_id', uuid.uuid4().hex), *self.scenario.parameters):
            self.ask_master('setParam', name, value)

    def start(self, member, **options):
        """Start a node, and wait until it answers, and, if it is the world, until it publishes its state."""
        if member.role.is_world:
            self.memory = None
        member.start(**options)
        self._wait(member, lambda: self.answers(member))

    def _wait(self, member, condition):
        """Wait until a node has started, unless it or another one ends."""
        started = [other for other in self.everybody if other.is_alive]
        try:
            wait_until(lambda: not all(other.is_alive for other in started) or condition(), STARTS_WITHIN)
        except TimeoutError:
            raise Failure('start', member.name, f'does not answer {STARTS_WITHIN:g} s after its start') from None
        for other in started:
            if not other.is_alive:
                raise Failure('start', other.name, f'ended at the start of {member.name} with exit code '
                              f'{other.process.returncode}: ' + ' | '.join(other.printed()[-12:]))

    def answers(self, member):
        """Whether a node is known to the master with all that it registers, and answers itself."""
        ready = member.role.ready
        try:
            uri = self.node_uri(member.name)
            if wire.ask(uri, 'getPid', timeout=2.0) != member.process.pid:
                return False
            own = [name for method in ('getPublications', 'getSubscriptions')
                   for name, _ in wire.ask(uri, method, timeout=2.0)]
            known = [name for names in self.ask_master('getSystemState', timeout=2.0)[:2]
                     for name, nodes in names if member.name in nodes]
            return not ready or ready in own and ready in known
        except wire.WireError:
            return False

    def settle(self):
        """Wait until nodes that have no baseline neither open nor close anything any more, and take it."""
        fresh = [member for member in self.everybody if member.baseline is None and member.is_alive]
        if not fresh:
            return
        end, steady, last = time.monotonic() + SETTLES_WITHIN, time.monotonic(), None
        while time.monotonic() < end and time.monotonic() - steady < STEADY:
            with contextlib.suppress(psutil.Error):
                now = [member.usage()[:3] for member in fresh]
                if now != last:
                    last, steady = now, time.monotonic()
            time.sleep(0.05)
        for member in fresh:
            with contextlib.suppress(psutil.Error):
                member.baseline = member.usage()

    # --- questions ------------------------------------------------------------------------------------------------

    @property
    def everybody(self):
        """All processes, the master first."""
        return [self.master, *self.members.values()]

    @property
    def world(self):
        """The node in which the robots are; None if there is none."""
        return next((member for member in self.members.values() if member.role.is_world), None)

    @property
    def cleaner(self):
        """The node that takes goals; None if there is none."""
        return next((member for member in self.members.values() if member.role.pulse == 'goals'), None)

    def _asks(self, method, *arguments):
        try:
            return self.ask_master(method, *arguments, timeout=2.0)
        except wire.WireError:
            return None

    def ask_master(self, method, *arguments, timeout=wire.PATIENCE):
        """Call a method of the master's API.

        Raises:
            wire.WireError: it fails.
        """
        return wire.ask(self.uri, method, *arguments, timeout=timeout)

    def node_uri(self, name):
        """Where the API of a node is.

        Raises:
            wire.WireError: the master knows no such node.
        """
        return self.ask_master('lookupNode', name)

    def topics(self):
        """All topics of the scenario's nodes: pairs of name and class of messages, and who subscribes and publishes."""
        kinds = dict(self.ask_master('getTopicTypes'))
        publishers, subscribers, _ = self.ask_master('getSystemState')
        found = []
        for name in sorted(kinds):
            kind = roslib.message.get_message_class(kinds[name])
            if kind is not None:
                found.append((name, kind, sorted(set(dict(subscribers).get(name, ())) & set(self.members)),
                              sorted(set(dict(publishers).get(name, ())) & set(self.members))))
        return found

    def services(self):
        """All services of the scenario's nodes: name and URI."""
        _, _, services = self.ask_master('getSystemState')
        names = sorted(name for name, nodes in services if set(nodes) & set(self.members))
        return [(name, self.ask_master('lookupService', name)) for name in names]

    def call(self, name, kind, *fields, timeout=wire.PATIENCE):
        """Call a service once; returns its response.

        Raises:
            wire.WireError: it does not answer.
        """
        with wire.Service(self.ask_master('lookupService', name), name, kind) as service:
            return service.call(kind._request_class(*fields), timeout)

    def listen(self, topic, kind, member=None):
        """A subscription to a topic of a node, by default of the world.

        Raises:
            wire.WireError: it does not publish that.
        """
        return wire.Subscription(self.node_uri((member or self.world).name), topic, kind)

    def read(self, topic, kind, member=None, timeout=wire.PATIENCE):
        """One message of a topic of a node, by default of the world.

        Raises:
            wire.WireError: none comes.
        """
        with self.listen(topic, kind, member) as subscription:
            return subscription.next(timeout)
