"""This package's definitions as genmsg sees them: files, parts, fields, md5 sums."""

import pathlib
import re
from typing import Iterator, List, NamedTuple

import genmsg
import genmsg.msg_loader
import rospkg

PACKAGE = pathlib.Path(__file__).resolve().parents[1]
NAME = 'rumba_msg'
FILES = sorted(path for kind in ('msg', 'srv', 'action') for path in (PACKAGE / kind).iterdir())
PART_SUFFIXES = {'.msg': ('',), '.srv': ('Request', 'Response'), '.action': ('Goal', 'Result', 'Feedback')}


class Part(NamedTuple):
    """One message of a definition: a whole .msg, or what stands between the `---` of a .srv or an .action."""

    name: str
    text: str

    @property
    def spec(self) -> genmsg.MsgSpec:
        """The part as genmsg parses it."""
        return genmsg.msg_loader.load_msg_from_string(_new_context(), self.text, f'{NAME}/{self.name}')


def parts(path: pathlib.Path) -> List[Part]:
    """The messages that a definition consists of, named as the generators name them."""
    texts = re.split(r'^---$', path.read_text(), flags=re.MULTILINE)
    return [Part(path.stem + suffix, text) for suffix, text in zip(PART_SUFFIXES[path.suffix], texts)]


def md5(path: pathlib.Path) -> Iterator[str]:
    """The md5 sums by which ROS tells whether two nodes mean the same: one, or an action's three."""
    context = _new_context()
    if path.suffix == '.srv':
        specs = [genmsg.msg_loader.load_srv_from_file(context, str(path), f'{NAME}/{path.stem}')]
    else:
        specs = [part.spec for part in parts(path)]
    ros = rospkg.RosPack()
    search_path = {name: [f'{ros.get_path(name)}/msg'] for name in ('geometry_msgs', 'std_msgs')}
    search_path[NAME] = [str(PACKAGE / 'msg')]
    for spec in specs:
        genmsg.load_depends(context, spec, search_path)
        yield genmsg.compute_md5(context, spec)


def _new_context() -> genmsg.MsgContext:
    return genmsg.MsgContext.create_default()
