"""The rules map every message and service of rumba_msg, and ROS 1 and ROS 2 read the same fields."""

import pathlib

import pytest
import yaml

from toward_ros2.definitions import HAS_ROS2_PARSER, bridged, files, in_ros1, in_ros2

PACKAGE = 'rumba_msg'
RULES = yaml.safe_load((pathlib.Path(__file__).parents[1] / 'config' / 'mapping_rules.yaml').read_text())
NEEDS_ROSIDL = pytest.mark.skipif(not HAS_ROS2_PARSER, reason='ROS Noetic has no rosidl')


def test_every_message_and_service_has_its_pair():
    pairs = bridged(RULES, PACKAGE)
    assert set(pairs) == {f'{PACKAGE}/{path.stem}' for path in files(PACKAGE)}
    assert pairs['rumba_msg/BatteryStatus'] == 'rumba_msg/msg/BatteryStatus'
    assert pairs['rumba_msg/TargetPosition'] == 'rumba_msg/srv/TargetPosition'


def test_rules_for_other_packages_map_nothing_and_other_kinds_of_rules_are_refused():
    assert bridged([{'ros1_package_name': 'other', 'ros2_package_name': 'rumba_msg'}], PACKAGE) == {}
    with pytest.raises(ValueError, match='^not a rule for a whole package: '):
        bridged([{**RULES[0], 'ros1_message_name': 'BatteryStatus'}], PACKAGE)


@NEEDS_ROSIDL
@pytest.mark.parametrize('path', files(PACKAGE), ids=lambda path: path.name)
def test_both_read_the_same_fields(path):
    fields = in_ros1(PACKAGE, path)
    assert fields == in_ros2(PACKAGE, path) and any(fields)


@NEEDS_ROSIDL
def test_a_field_name_that_ros_2_does_not_allow_is_refused(tmp_path):
    path = tmp_path / 'Bad.msg'
    path.write_text('float64 targetX\n')
    assert in_ros1(PACKAGE, path) == [[('float64', 'targetX')]]
    with pytest.raises(NameError, match='targetX.* is an invalid field name'):
        in_ros2(PACKAGE, path)
