"""The definitions of a ROS 1 package, as ROS 1 and as ROS 2 read them."""

import importlib.util
import pathlib
import re
from typing import Dict, Iterator, List, Tuple

import genmsg
import genmsg.msg_loader
import rospkg

HAS_ROS2_PARSER = importlib.util.find_spec('rosidl_adapter') is not None
Fields = List[Tuple[str, str]]  # (type, name), in order; a type of the same package without the package's name
OF_ROS2 = {'builtin_interfaces/Time': 'time', 'builtin_interfaces/Duration': 'duration'}


def files(package: str) -> Iterator[pathlib.Path]:
    """The .msg and .srv files of a package: what ros1_bridge can map (it knows no actions)."""
    folder = pathlib.Path(rospkg.RosPack().get_path(package))
    return (path for kind in ('msg', 'srv') for path in sorted((folder / kind).glob(f'*.{kind}')))


def in_ros1(package: str, path: pathlib.Path) -> List[Fields]:
    """Fields as genmsg reads them: of a message, or of a service's request and response."""
    texts = re.split(r'^---$', path.read_text(), flags=re.MULTILINE)
    specs = [genmsg.msg_loader.load_msg_from_string(genmsg.MsgContext.create_default(), text, f'{package}/{path.stem}')
             for text in texts]
    return [[(kind.replace(f'{package}/', ''), name) for kind, name in zip(spec.types, spec.names)] for spec in specs]


def in_ros2(package: str, path: pathlib.Path) -> List[Fields]:
    """Fields as rosidl reads them; raises its errors where the file is no ROS 2 interface."""
    from rosidl_adapter import parser
    if path.suffix == '.msg':
        messages = [parser.parse_message_string(package, path.stem, path.read_text())]
    else:
        service = parser.parse_service_string(package, path.stem, path.read_text())
        messages = [service.request, service.response]
    return [[(_as_ros1(str(field.type), package), field.name) for field in message.fields] for message in messages]


def bridged(rules: List[Dict[str, str]], package: str) -> Dict[str, str]:
    """Which definitions of a ROS 1 package the rules map by whole packages, to what: name to name.

    Raises:
        ValueError: a rule is for single messages or fields, of which this knows nothing.
    """
    pairs = {}
    for rule in rules:
        if set(rule) != {'ros1_package_name', 'ros2_package_name'}:
            raise ValueError(f'not a rule for a package: {rule}')
        if rule['ros1_package_name'] == package:
            for path in files(package):
                pairs[f'{package}/{path.stem}'] = f'{rule["ros2_package_name"]}/{path.suffix[1:]}/{path.stem}'
    return pairs


def _as_ros1(kind: str, package: str) -> str:
    return OF_ROS2.get(kind, kind).replace(f'{package}/', '')
