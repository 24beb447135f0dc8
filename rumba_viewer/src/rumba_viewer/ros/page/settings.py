"""The parameters of the page, and what is made of them."""

import dataclasses
import pathlib
import socket
import time
from typing import Any, Callable, List

import rospkg
import rospy

from rumba_sim.model.common.config import setting
from rumba_viewer.page.allow_list import AllowList, Tokens, robot_tokens
from rumba_viewer.page.server import Bounds, Hub, check_address


@dataclasses.dataclass(frozen=True)
class Settings:
    """The node's private parameters."""

    address: str = setting('127.0.0.1', 'address at which to serve; 0.0.0.0: all of this machine, needs a token')
    port: int = setting(8080, 'port; 0: any free one, which a line names', '', 0, 65535)
    token: str = setting('', 'text that permits changes; empty: everybody may change everything')
    robot_tokens: str = setting('', 'texts that permit to drive one robot, as in rumba:blue,rumba2:green')
    read: str = setting('', 'further topics that can be subscribed to, separated by commas; * stands for a robot')
    write: str = setting('', 'further topics that can be published to')
    call: str = setting('', 'further services that can be called')
    serve: str = setting('', 'services that clients can serve')
    get: str = setting('', 'parameters that can be read')
    set: str = setting('', 'parameters that can be set and deleted')
    defaults: bool = setting(True, 'whether what the page itself needs can be reached')
    origins: str = setting('', 'further origins of web pages that may connect, as in http://example.org; * matches any')
    connections: int = setting(200, 'clients at the same time', '', 1, 10000)
    rate: float = setting(100.0, 'messages of one client', '1/s', 1.0, 10000.0)
    size: int = setting(65536, 'size of a message of a client', 'bytes', 1024, 16777216)
    bandwidth: int = setting(524288, 'what one client may send', 'bytes/s', 1024, 1073741824)
    elements: int = setting(20000, 'values in a message of a client, and in all of a second', '', 100, 100000000)
    share: float = setting(0.05, 'share of a core that one client may use', '', 0.001, 1.0)


def tokens_of(settings: Settings) -> Tokens:
    """The tokens.

    Raises:
        ConfigError: they do not fit together, or others could change everything.
    """
    tokens = Tokens(settings.token, robot_tokens(settings.robot_tokens, rospy.get_namespace()))
    check_address(settings.address, tokens)
    return tokens


def hub_of(settings: Settings, encode: Callable[..., Any], warn: Callable[[str], object]) -> Hub:
    """A hub without clients; `encode` and `warn` as in `Hub`.

    Raises:
        ConfigError: a name cannot be allowed.
    """
    namespace = rospy.get_namespace()
    allowed = AllowList(namespace, settings.defaults, **{
        what: _parts(getattr(settings, what)) for what in ('read', 'write', 'call', 'serve', 'get', 'set')})
    bounds = Bounds(**{field.name: getattr(settings, field.name) for field in dataclasses.fields(Bounds)})
    return Hub(namespace, allowed, _parts(settings.origins), bounds, encode, time.thread_time, warn)


def folder() -> pathlib.Path:
    """Where the files of the page are."""
    return pathlib.Path(rospkg.RosPack().get_path('rumba_viewer')) / 'page'


def url(settings: Settings, where: List[socket.socket]) -> str:
    """Where the page is that is served at these sockets."""
    return f'http://{_shown(settings.address)}:{where[0].getsockname()[1]}'


def _parts(text: str) -> List[str]:
    """The parts of a text between commas and spaces."""
    return text.replace(',', ' ').split()


def _shown(address: str) -> str:
    return {'0.0.0.0': 'THIS_MACHINE', '::': 'THIS_MACHINE'}.get(address, f'[{address}]' if ':' in address else address)
