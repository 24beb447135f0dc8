"""The definitions are well documented, parse in ROS 1 and ROS 2, and their wire formats stay what they are."""

import importlib.util
import re

import pytest
from definitions import FILES, NAME, md5, parts

MD5 = {
    'Clean.action': [
        '5520a1c6e8a152c7ac1f5c4fe608b442',
        '39e9ffb7d99eb6865c50f392bae7340d',
        '0d748d8d3231932a4b6b2a7d1cea9318'],
    'Dock.action': [
        '1f5cb61fc531052411e5e7b804abd313',
        '511fe5243b2dfc2fdfa5e46f2b6b5631',
        'e4b9ae907daf8089dc36f0f979c46ed8'],
    'GoTo.action': [
        '4a583f82c50523a742b8ac903242685d',
        '8431718871231402abc7c6c527e38fe4',
        'e46fb0854dc85a00cd3de9ea8446b383'],
    'Undock.action': [
        '1f5cb61fc531052411e5e7b804abd313',
        '511fe5243b2dfc2fdfa5e46f2b6b5631',
        '1092bf11150d7a9e1554cca2e9dde9b1'],
    'BatteryStatus.msg': ['8553ab09064a977637e06a24726e1227'],
    'Bumper.msg': ['082df846252723b63047bfcdd7401c21'],
    'CleaningStatus.msg': ['787ea9853338b08dda5c7e31306cafc8'],
    'Cliff.msg': ['f4f281313287b2b493f1c4188d2a65ac'],
    'DockStatus.msg': ['c48de8dbe236629249e0a17b3210e4b8'],
    'Lockstep.msg': ['0ee5539633c36786a042805782056911'],
    'LockstepAnswer.msg': ['ee9cc01718c8f4146b76ccc28498b21b'],
    'MissionStatus.msg': ['b5dc28a8c8d879395d4353c7e03795b4'],
    'Outcome.msg': ['a70673e9425e07411f8380f0a44dbf9b'],
    'SimulatorState.msg': ['f9b4dcc49d5285d3df3d11c9d29d19b5'],
    'TeamPlan.msg': ['2eed0994a800fa164588bb991605d45e'],
    'TeamReport.msg': ['9b7a98c3683ee32acca6452e160dcb69'],
    'AddObstacle.srv': ['c0b79402098083bb719b5f6fb4d6ddb9'],
    'Kill.srv': ['d82dc6474dd88dad5e1615ab1b2ca74c'],
    'RemoveObstacle.srv': ['d82dc6474dd88dad5e1615ab1b2ca74c'],
    'Spawn.srv': ['b632bbf32aa077e9544add486db4fe8a'],
    'Step.srv': ['70fefd98c6c6d5e009e2a5b9432fedf7'],
    'TargetPosition.srv': ['dd76aff00a72b33e8d77950fa07ebddf'],
    'Teleport.srv': ['3bd059df70d5e80971945ad044457a3c'],
}
UNIT_OF_A_NUMBER = re.compile(r'\[(%|0\.\.1|m|m\^2|rad|s|m/s|rad/s|Hz|ticks|resets|times real time)\]'
                              r'|constants? above|number of |sum of the beams above|seed of')
PARTS = [part for path in FILES for part in parts(path)]
ROSIDL_PARSERS = {'.msg': 'parse_message_string', '.srv': 'parse_service_string', '.action': 'parse_action_string'}


@pytest.mark.parametrize('path', FILES, ids=lambda path: path.name)
def test_the_wire_format_is_pinned(path):
    assert list(md5(path)) == MD5[path.name]


def test_every_pinned_definition_exists():
    assert {path.name for path in FILES} == set(MD5)


@pytest.mark.parametrize('path', FILES, ids=lambda path: path.name)
def test_a_definition_begins_with_what_it_is_for(path):
    assert re.match(r'# \S.*\.', path.read_text())


@pytest.mark.parametrize('part', PARTS, ids=lambda part: part.name)
def test_every_field_and_constant_says_its_meaning(part):
    for line in filter(_is_declaration, part.text.splitlines()):
        assert re.search(r'# \S.{8,}', line), f'{part.name}: no comment at: {line}'


@pytest.mark.parametrize('part', PARTS, ids=lambda part: part.name)
def test_every_number_has_a_unit(part):
    comments = {line.split()[1]: line.partition('#')[2] for line in part.text.splitlines() if _is_declaration(line)}
    spec = part.spec
    for base_type, name in zip(spec.types, spec.names):
        if re.match(r'u?int|float', base_type):
            assert UNIT_OF_A_NUMBER.search(comments[name]), f'{part.name}.{name}: no unit in:{comments[name]}'
        if base_type == 'geometry_msgs/Pose2D':
            assert '[m, rad]' in comments[name] and 'frame' in comments[name], f'{part.name}.{name}'


@pytest.mark.parametrize('part', PARTS, ids=lambda part: part.name)
def test_a_header_comes_first_and_names_its_frame(part):
    spec = part.spec
    if 'std_msgs/Header' in spec.types:
        assert spec.types.index('std_msgs/Header') == 0
        assert re.search(r'std_msgs/Header header +# stamp: .*; frame_id: ', part.text)


@pytest.mark.skipif(not importlib.util.find_spec('rosidl_adapter'), reason='ROS Noetic has no rosidl')
@pytest.mark.parametrize('path', FILES, ids=lambda path: path.name)
def test_ros_2_parses_the_same_fields(path):
    from rosidl_adapter import parser
    parsed = getattr(parser, ROSIDL_PARSERS[path.suffix])(NAME, path.stem, path.read_text())
    messages = {'.msg': lambda: [parsed],
                '.srv': lambda: [parsed.request, parsed.response],
                '.action': lambda: [parsed.goal, parsed.result, parsed.feedback]}[path.suffix]()
    for part, message in zip(parts(path), messages):
        assert [field.name for field in message.fields] == part.spec.names
        assert [constant.name for constant in message.constants] == [constant.name for constant in part.spec.constants]


def _is_declaration(line: str) -> bool:
    return bool(line.strip()) and not line.lstrip().startswith('#')
