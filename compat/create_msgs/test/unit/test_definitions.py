"""The wire formats are those of create_msgs, so that any node written for a Create understands them."""

import pathlib

import genmsg
import genmsg.msg_loader
import pytest
import rospkg

PACKAGE = pathlib.Path(__file__).resolve().parents[2]
FILES = sorted((PACKAGE / 'msg').iterdir())
# By genmsg of the definitions in https://github.com/AutonomyLab/create_robot, folder create_msgs/msg (or ca_msgs/msg).
MD5 = {
    'Bumper': '18fe5b1d31e6a8db180b924157ac665e',
    'ChargingState': 'e4da1ef814a2def80691224a5e5883ea',
    'Cliff': '52f9ca1c0878e942bfdd1e74ef36146c',
    'DefineSong': 'ae0ef1f2fad74bf546a9e5f037c27a5d',
    'Mode': 'b4faf4b68b6555d4656417971bee31a0',
    'MotorSetpoint': '6b1e8af79e9957aa39f0d7274f652afb',
    'PlaySong': 'eb55a5c354f06b6572d1ec46a28b6e6a',
}


@pytest.mark.parametrize('path', FILES, ids=lambda path: path.stem)
def test_the_wire_format_is_that_of_create_msgs(path):
    context = genmsg.MsgContext.create_default()
    spec = genmsg.msg_loader.load_msg_from_file(context, str(path), f'create_msgs/{path.stem}')
    folder = pathlib.Path(rospkg.RosPack().get_path('std_msgs')) / 'msg'
    genmsg.msg_loader.load_depends(context, spec, {'std_msgs': [str(folder)]})
    assert genmsg.compute_md5(context, spec) == MD5[path.stem]


def test_create_msgs_has_these_definitions_and_no_other():
    assert {path.stem for path in FILES} == set(MD5)
