"""What clients may reach, and which token permits which change.

A pattern is a name of ROS in which `*` stands for the name of one robot. Whatever no pattern matches is not there for a
client, whatever token it has.
"""

import fnmatch
import hmac
import re
from typing import FrozenSet, Mapping, NamedTuple, Optional, Sequence, Tuple

from rumba_sim.model.common.errors import ConfigError, quoted
from rumba_viewer.page.messages.errors import Refusal

ACTIONS = ('clean', 'dock', 'undock', 'go_to')
READ = ('/map', '/clock', '/tf', '/tf_static', 'simulator/state', 'simulator/map', 'simulator/obstacles',
        *(f'*/{name}' for name in (
            'battery_status', 'battery_state', 'odom', 'ground_truth', 'scan', 'bumper', 'cliff', 'dock_status',
            'cleaning_status', 'coverage', 'mission_status', 'plan', 'amcl_pose', 'particlecloud',
            *(f'{action}/{part}' for action in ACTIONS for part in ('status', 'feedback', 'result')))))
WRITE = ('*/cmd_vel', '*/teleop/cmd_vel', *(f'*/{action}/{part}' for action in ACTIONS for part in ('goal', 'cancel')))
CALL = ('*/set_brushes_up', '*/go_to_position', 'simulator/pause', 'simulator/resume', 'simulator/reset',
        'simulator/tuning/set_parameters', 'turtlesim_body/reset')
DEFAULTS = {'read': READ, 'write': WRITE, 'call': CALL, 'serve': (), 'get': (), 'set': ()}
VERBS = {'read': 'subscribed to', 'write': 'published to', 'call': 'called', 'serve': 'served', 'get': 'read',
         'set': 'set'}


class Rights(NamedTuple):
    """What a client may change.

    Attributes:
        everything: all that the allow-list names.
        robots: otherwise, what belongs to these robots, by full name.
    """

    everything: bool = False
    robots: FrozenSet[str] = frozenset()

    @property
    def are_none(self) -> bool:
        """Whether the client can only watch."""
        return not self.everything and not self.robots

    def may_change(self, robot: Optional[str]) -> bool:
        """Whether something of a robot may be changed; None: something that belongs to no robot."""
        return self.everything or robot is not None and robot in self.robots


class AllowList:
    """Names of topics that clients may read and write, of services to call and serve, of parameters to get and set."""

    def __init__(self, namespace: str = '/', defaults: bool = True, **more: Sequence[str]) -> None:
        """Allow the names that the page needs, unless `defaults` is false, and others.

        Args:
            namespace: that of the node, with a `/` at its end; patterns without a leading `/` begin there.
            defaults: whether what the page needs is allowed.
            more: further patterns for `read`, `write`, `call`, `serve`, `get` and `set`.

        Raises:
            ConfigError: a pattern is no name of ROS with `*`.
        """
        self._patterns = {}
        for what, known in DEFAULTS.items():
            texts = [*(known if defaults else ()), *more.get(what, ())]
            self._patterns[what] = [_compiled(text, namespace) for text in texts]

    def robot(self, what: str, name: str) -> Optional[str]:
        """The robot to which a name belongs, None if to none.

        Args:
            what: `read`, `write`, `call`, `serve`, `get` or `set`.
            name: full name of a topic, service or parameter.

        Raises:
            Refusal: the name is not on the list.
        """
        for pattern in self._patterns[what]:
            found = pattern.fullmatch(name)
            if found is not None:
                return found.groupdict().get('robot')
        raise Refusal(f'{quoted(name)} cannot be {VERBS[what]} here: the allow-list of this page does not name it')


def _compiled(text: str, namespace: str) -> 're.Pattern[str]':
    full = text if text.startswith('/') else namespace + text
    if not re.fullmatch(r'/(\*|[A-Za-z][\w-]*)(/(\*|[A-Za-z][\w-]*))*', full):
        raise ConfigError(f'{quoted(text)} cannot be allowed: must be a name such as /chatter or */scan')
    belongs_to_a_robot = not text.startswith('/') and '*' in text
    before, _, after = full.partition('*')
    if not belongs_to_a_robot:
        return re.compile(re.escape(full).replace(r'\*', '[A-Za-z][A-Za-z0-9_]*'))
    return re.compile(f'(?P<robot>{re.escape(before)}[A-Za-z][A-Za-z0-9_]*)'
                      + re.escape(after).replace(r'\*', '[A-Za-z][A-Za-z0-9_]*'))


class Tokens:
    """Who may change what, by a token."""

    def __init__(self, everything: str = '', robots: Mapping[str, str] = {}) -> None:
        """Ask for tokens if there are any; otherwise, everybody may change everything.

        Args:
            everything: the token that permits every change.
            robots: the token of each robot, by full name.

        Raises:
            ConfigError: two tokens are the same, or robots have tokens and the rest has none.
        """
        if robots and not everything:
            raise ConfigError('robot_tokens are given, but no token: it is needed for what belongs to no robot')
        if everything and everything in robots.values():
            raise ConfigError('a robot token is the same as the token for everything: choose another one')
        self._everything, self._robots = everything, dict(robots)

    @property
    def are_needed(self) -> bool:
        """Whether changes need a token."""
        return bool(self._everything)

    def rights(self, token: Optional[str]) -> Rights:
        """What a token permits; None: no token was given.

        Raises:
            Refusal: the token is wrong.
        """
        if not self.are_needed:
            return Rights(everything=True)
        if token is None:
            return Rights()
        if _same(token, self._everything):
            return Rights(everything=True)
        robots = frozenset(robot for robot, other in self._robots.items() if _same(token, other))
        if not robots:
            raise Refusal('wrong token: ask the person who started this page, or open it without a token to watch')
        return Rights(robots=robots)


def _same(one: str, other: str) -> bool:
    """Whether two texts are the same; the time that this takes tells nothing about them."""
    return hmac.compare_digest(one.encode(), other.encode())


def robot_tokens(text: str, namespace: str) -> Mapping[str, str]:
    """The token of each robot, by full name, from a text such as `rumba:blue, rumba2:green`.

    Raises:
        ConfigError: the text has another form, or names a robot twice.
    """
    found = {}
    for part in filter(None, (part.strip() for part in text.split(','))):
        name, colon, token = (piece.strip() for piece in part.partition(':'))
        if not colon or not token or not re.fullmatch(r'[A-Za-z]\w*', name):
            raise ConfigError('robot_tokens must be robots with their tokens, as in rumba:blue,rumba2:green')
        if namespace + name in found:
            raise ConfigError(f'robot_tokens names {name} twice')
        found[namespace + name] = token
    return found


def is_origin_allowed(origin: Optional[str], host: str, others: Sequence[str]) -> bool:
    """Whether a connection may come from a page of an origin.

    Args:
        origin: of the page that opens the connection, such as `http://host:8080`; None: no browser opened it.
        host: under which that page or program reached this server, such as `host:8080`.
        others: patterns of further origins.
    """
    if origin is None:
        return True
    return origin.lower() in (f'http://{host.lower()}', f'https://{host.lower()}') or any(
        fnmatch.fnmatchcase(origin.lower(), other.lower()) for other in others)


def is_loopback(address: str) -> bool:
    """Whether an address can be reached from this machine alone."""
    return address == 'localhost' or address == '::1' or re.fullmatch(r'127(\.\d{1,3}){3}', address) is not None


def host_name(host: str) -> Tuple[str, str]:
    """Name and port of the header `Host`."""
    found = re.fullmatch(r'(\[[^\]]*\]|[^:]*)(?::(\d*))?', host)
    return (found.group(1).strip('[]').lower(), found.group(2) or '') if found else ('', '')
