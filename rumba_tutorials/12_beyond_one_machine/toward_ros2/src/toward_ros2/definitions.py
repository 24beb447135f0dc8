"""The fields of the definitions of a ROS 1 package, as ROS 1 and as ROS 2 read them."""

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
    """Return the .msg and .srv files of a package, which ros1_bridge can map; it does not support actions."""
    folder = pathlib.Path(rospkg.RosPack().get_path(package))
    return (path for kind in ('msg', 'srv') for path in sorted((folder / kind).glob(f'*.{kind}')))


def in_ros1(package: str, path: pathlib.Path) -> List[Fields]:
    """Return the fields of a message, or of request and response of a service, as genmsg reads them."""
    texts = re.split(r'^---$', path.read_text(), flags=re.MULTILINE)
    specs = [genmsg.msg_loader.load_msg_from_string(genmsg.MsgContext.create_default(), text, f'{package}/{path.stem}')
             for text in texts]
    return [[(kind.replace(f'{package}/', ''), name) for kind, name in zip(spec.types, spec.names)] for spec in specs]


def in_ros2(package: str, path: pathlib.Path) -> List[Fields]:
    """Return the fields as rosidl reads them; raise its error if the file is not a ROS 2 interface."""
    from rosidl_adapter import parser
    if path.suffix == '.msg':
        messages = [parser.parse_message_string(package, path.stem, path.read_text())]
    else:
        service = parser.parse_service_string(package, path.stem, path.read_text())
        messages = [service.request, service.response]
    return [[(_as_ros1(str(field.type), package), field.name) for field in message.fields] for message in messages]


def bridged(rules: List[Dict[str, str]], package: str) -> Dict[str, str]:
    """Return names of definitions of a ROS 1 package with the names in ROS 2 to which the rules map them.

    Raises:
        ValueError: a rule is not for a whole package; rules for single messages or fields are not supported.
    """
    pairs = {}
    for rule in rules:
        if set(rule) != {'ros1_package_name', 'ros2_package_name'}:
            raise ValueError(f'not a rule for a whole package: {rule}')
        if rule['ros1_package_name'] == package:
            for path in files(package):
                pairs[f'{package}/{path.stem}'] = f'{rule["ros2_package_name"]}/{path.suffix[1:]}/{path.stem}'
    return pairs


def _as_ros1(kind: str, package: str) -> str:
    return OF_ROS2.get(kind, kind).replace(f'{package}/', '')
