"""The wire formats are those of turtlesim, so that any node written for it understands this one."""

import pathlib

import genmsg
import genmsg.msg_loader
import pytest

PACKAGE = pathlib.Path(__file__).resolve().parents[2]
FILES = sorted(path for kind in ('msg', 'srv') for path in (PACKAGE / kind).iterdir())
MD5 = {
    'Color.msg': '353891e354491c51aabe32df673fb446',
    'Pose.msg': '863b248d5016ca62ea2e895ae5265cf9',
    'Kill.srv': 'c1f3d28f1b044c871e6eff2e9fc3c667',
    'SetPen.srv': '9f452acce566bf0c0954594f69a8e41b',
    'Spawn.srv': '0b2d2e872a8e2887d5ed626f2bf2c561',
    'TeleportAbsolute.srv': 'a130bc60ee6513855dc62ea83fcc5b20',
    'TeleportRelative.srv': '9d5c2dcd348ac8f76ce2a4307bd63a13',
}


@pytest.mark.parametrize('path', FILES, ids=lambda path: path.name)
def test_the_wire_format_is_that_of_turtlesim(path):
    context = genmsg.MsgContext.create_default()
    load = {'.msg': genmsg.msg_loader.load_msg_from_file, '.srv': genmsg.msg_loader.load_srv_from_file}[path.suffix]
    assert genmsg.compute_md5(context, load(context, str(path), f'turtlesim/{path.stem}')) == MD5[path.name]


def test_turtlesim_has_these_definitions_and_no_other():
    assert {path.name for path in FILES} == set(MD5)
