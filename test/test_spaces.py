"""The nodes run from the devel space and from the install space, and ROS's own tools show what the lesson says."""

import pytest

BATTERY_STATUS = '''\
int64 percentage_battery
float64 location_x
float64 location_y
float64 orientation_theta
bool brushes_up
string debug_message

'''
TARGET_POSITION = '''\
float64 target_x
float64 target_y
float64 target_theta
---
float64 linear_x
float64 angular_z
bool feedback
string message

'''
IN_BOTH = pytest.mark.parametrize('space', ['devel', 'install'])


@IN_BOTH
def test_ros_tools_show_the_definitions_of_the_lesson(workspace, space):
    here = workspace.space(space)
    assert here.run('rosmsg show rumba_msg/BatteryStatus') == BATTERY_STATUS
    assert here.run('rossrv show rumba_msg/TargetPosition') == TARGET_POSITION
    assert here.run('rosmsg md5 rumba_msg/BatteryStatus') == '8553ab09064a977637e06a24726e1227\n'
    assert here.run('rossrv md5 rumba_msg/TargetPosition') == 'dd76aff00a72b33e8d77950fa07ebddf\n'


@pytest.mark.thorough(except_for=['install'])
@IN_BOTH
def test_publisher_and_listener_meet(workspace, space):
    here = workspace.space(space)
    with here.running(f'rosrun rumba_sim battery_status_publisher __ns:=/{space} _percentage:=42 _location_x:=1.5'):
        echo = here.run(f'rostopic echo -n1 /{space}/rumba/battery_status')
        assert echo.startswith('percentage_battery: 42\nlocation_x: 1.5\nlocation_y: 0.0\n')
        with here.running(f'rosrun rumba_sim battery_status_listener __ns:=/{space}') as listener:
            assert listener.stdout.readline() == f'waiting for /{space}/rumba/battery_status\n'
            assert listener.stdout.readline().startswith('battery  42 %   at (1.50, 0.00) m, 0 deg   brushes down')


@pytest.mark.thorough
def test_the_demo_runs_from_the_install_space_too(workspace):
    here = workspace.space('install')
    with here.running('roslaunch rumba_launch demo.launch percentage:=50 drain:=0') as demo:
        assert any('  battery 50 %' in line for line in demo.stdout)
        assert here.run('rostopic echo -n1 /rumba/battery_status').startswith('percentage_battery: 50\n')


@pytest.mark.thorough(except_for=['install'])
@IN_BOTH
def test_the_stand_in_for_turtlesim_runs(workspace, space):
    here = workspace.space(space)
    assert here.run('rosmsg md5 turtlesim/Pose') == '863b248d5016ca62ea2e895ae5265cf9\n'
    with here.running(f'rosrun turtlesim turtlesim_node __ns:=/{space}'):
        assert here.run(f'rostopic echo -n1 /{space}/turtle1/pose').startswith('x: 5.54444456')
        here.run(f'rosservice call /{space}/spawn 2 3 0 bob')
        with here.running(f'rosrun turtlesim mimic __ns:=/{space} input:=turtle1 output:=bob'):
            assert here.run(f'rostopic echo -n1 /{space}/bob/cmd_vel').startswith('linear: \n  x: 0.0\n')
