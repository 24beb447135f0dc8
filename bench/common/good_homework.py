"""Homework that is right, in Python and C++, however it is handed in."""

import os
import shutil
import tarfile

from common.homework import BUMPER, GOOD, STATUS, cmake, in_cpp, made, package, replace, script, zipped

CPP_STATUS = r'''#include <cmath>
#include <ros/ros.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/BatteryState.h>
#include <rumba_msg/BatteryStatus.h>

geometry_msgs::Pose pose;
ros::Publisher publisher;

void on_odometry(const nav_msgs::Odometry& odometry) { pose = odometry.pose.pose; }

void on_battery(const sensor_msgs::BatteryState& battery)
{
  rumba_msg::BatteryStatus status;
  status.percentage_battery = std::ceil(100.0 * battery.percentage);
  status.location_x = pose.position.x;
  status.location_y = pose.position.y;
  status.orientation_theta = 2.0 * std::atan2(pose.orientation.z, pose.orientation.w);
  publisher.publish(status);
}

int main(int argc, char** argv)
{
  ros::init(argc, argv, "status");
  ros::NodeHandle node;
  publisher = node.advertise<rumba_msg::BatteryStatus>("student/battery_status", 1);
  ros::Subscriber odometry = node.subscribe("rumba/odom", 1, on_odometry);
  ros::Subscriber battery = node.subscribe("rumba/battery_state", 1, on_battery);
  ros::spin();
}
'''
CPP_BUMPER = r'''#include <geometry_msgs/Twist.h>
#include <ros/ros.h>
#include <rumba_msg/Bumper.h>

ros::Publisher publisher;
int backing = 20, turning = 12;

void on_bumper(const rumba_msg::Bumper& bumper)
{
  if (bumper.is_left_pressed || bumper.is_right_pressed)
    backing = 3, turning = 18;
  geometry_msgs::Twist twist;
  if (backing > 0)
    --backing, twist.linear.x = -0.2;
  else if (turning > 0)
    --turning, twist.angular.z = 1.1;
  else
    twist.linear.x = 0.3;
  publisher.publish(twist);
}

int main(int argc, char** argv)
{
  ros::init(argc, argv, "cleaner");
  ros::NodeHandle node;
  publisher = node.advertise<geometry_msgs::Twist>("rumba/cmd_vel", 1);
  ros::Subscriber bumper = node.subscribe("rumba/bumper", 1, on_bumper);
  ros::spin();
}
'''


@made(GOOD, STATUS)
def status_solution(_):
    """The solution."""


@made(GOOD, STATUS)
def status_with_more_digits(path):
    replace(path, '.1f', '.2f')


@made(GOOD, STATUS)
def status_without_mode(path):
    script(path).chmod(0o644)


@made(GOOD, STATUS)
def status_zipped_on_a_mac(path):
    (path / '__MACOSX').mkdir()
    (path / '__MACOSX' / '._package.xml').write_bytes(b'\x00\x05\x16\x07')
    zipped(path, 'My Homework')


@made(GOOD, STATUS)
def status_in_a_workspace(path):
    (path / 'src').mkdir()
    shutil.move(str(package(path)), str(path / 'src'))
    (path / 'src' / 'CMakeLists.txt').symlink_to('/usr/share/catkin/cmake/toplevel.cmake')
    for name in ('build', 'devel'):
        (path / name).mkdir()
        (path / name / 'setup.bash').write_text('exit 1\n')


@made(GOOD, STATUS)
def status_as_one_script(path):
    shutil.copy(script(path), f'{path}.py')
    shutil.rmtree(path)


@made(GOOD, STATUS)
def status_from_a_platform(path):
    with tarfile.open(f'{path}.tar.gz', 'w:gz') as archive:
        archive.add(package(path), arcname='work')
    shutil.rmtree(path)
    path.mkdir()
    os.replace(f'{path}.tar.gz', path / 'Zoë_4711_file_homework final.tar.gz')


@made(GOOD, STATUS)
def status_in_cpp(path):
    in_cpp(path, CPP_STATUS, 'status', 'nav_msgs roscpp rumba_msg sensor_msgs')


@made(GOOD, STATUS)
def status_with_a_module(path):
    own = package(path)
    module = own / 'src' / own.name
    module.mkdir(parents=True)
    (module / '__init__.py').write_text('')
    (module / 'percent.py').write_text('import math\n\n\ndef percent(share):\n    return math.ceil(100.0 * share)\n')
    replace(path, 'math.ceil(100.0 * battery.percentage)', 'percent(battery.percentage)')
    replace(path, '\nimport rospy', f'\nfrom {own.name}.percent import percent\n\nimport rospy')
    (own / 'setup.py').write_text(
        'from catkin_pkg.python_setup import generate_distutils_setup\nfrom setuptools import setup\n\n'
        f"setup(**generate_distutils_setup(packages=['{own.name}'], package_dir={{'': 'src'}}))\n")
    cmake(own, 'rospy', messages='catkin_python_setup()\n')


@made(GOOD, STATUS)
def status_with_a_message_of_its_own(path):
    own = package(path)
    (own / 'msg').mkdir()
    (own / 'msg' / 'Share.msg').write_text('float64 share\n')
    cmake(own, 'message_generation rospy std_msgs',
          messages='add_message_files(FILES Share.msg)\ngenerate_messages()\n')
    replace(path, '\nclass Status', f'\nfrom {own.name}.msg import Share\n\n\nclass Status')
    replace(path, 'math.ceil(100.0 * battery.percentage)', 'math.ceil(100.0 * Share(battery.percentage).share)')


@made(GOOD, STATUS)
def status_in_two_packages(path):
    other = path / 'percent_words'
    (other / 'src' / 'percent_words').mkdir(parents=True)
    (other / 'src' / 'percent_words' / '__init__.py').write_text(
        'import math\n\n\ndef percent(share):\n    return math.ceil(100.0 * share)\n')
    (other / 'setup.py').write_text(
        'from catkin_pkg.python_setup import generate_distutils_setup\nfrom setuptools import setup\n\n'
        "setup(**generate_distutils_setup(packages=['percent_words'], package_dir={'': 'src'}))\n")
    cmake(other, 'rospy', messages='catkin_python_setup()\n')
    replace(path, 'math.ceil(100.0 * battery.percentage)', 'percent(battery.percentage)')
    replace(path, '\nimport rospy', '\nfrom percent_words import percent\n\nimport rospy')


@made(GOOD, BUMPER)
def bumper_solution(_):
    """The solution."""


@made(GOOD, BUMPER)
def bumper_with_other_figures(path):
    replace(path, '= 3, 18', '= 4, 15')


@made(GOOD, BUMPER)
def bumper_in_cpp(path):
    in_cpp(path, CPP_BUMPER, 'cleaner', 'geometry_msgs roscpp rumba_msg')


@made(GOOD, BUMPER)
def bumper_in_cpp_and_zipped(path):
    in_cpp(path, CPP_BUMPER, 'cleaner', 'geometry_msgs roscpp rumba_msg')
    zipped(path)


@made(GOOD, BUMPER)
def bumper_by_two_nodes_and_a_message(path):
    own = package(path)
    (own / 'msg').mkdir()
    (own / 'msg' / 'Hit.msg').write_text('bool is_hit\n')
    cmake(own, 'geometry_msgs message_generation rospy std_msgs',
          messages='add_message_files(FILES Hit.msg)\ngenerate_messages()\n')
    replace(path, '\n\nclass Cleaner', f'\nfrom {own.name}.msg import Hit\n\n\nclass Cleaner')
    replace(path, 'bumper.is_left_pressed or bumper.is_right_pressed',
            'Hit(bumper.is_left_pressed or bumper.is_right_pressed).is_hit')


@made(GOOD, BUMPER)
def bumper_with_a_service_of_its_own(path):
    own = package(path)
    (own / 'srv').mkdir()
    (own / 'srv' / 'Turn.srv').write_text('int32 most\n---\nint32 ticks\n')
    cmake(own, 'geometry_msgs message_generation rospy std_msgs',
          messages='add_service_files(FILES Turn.srv)\ngenerate_messages()\n')
    replace(path, '\n\nclass Cleaner', f'\nfrom {own.name}.srv import TurnRequest\n\n\nclass Cleaner')
    replace(path, '= 3, 18', '= 3, TurnRequest(18).most')


@made(GOOD, BUMPER)
def bumper_with_a_library_in_cpp(path):
    in_cpp(path, CPP_BUMPER.replace('ros::Publisher publisher;', '#include "bumper_exercise/figures.h"\n'
                                    'ros::Publisher publisher;').replace('= 18', '= turn_ticks()'), 'cleaner',
           'geometry_msgs roscpp rumba_msg')
    own = package(path)
    (own / 'include' / own.name).mkdir(parents=True)
    (own / 'include' / own.name / 'figures.h').write_text('int turn_ticks();\n')
    (own / 'src' / 'figures.cpp').write_text('#include "bumper_exercise/figures.h"\nint turn_ticks() { return 18; }\n')
    text = (own / 'CMakeLists.txt').read_text()
    (own / 'CMakeLists.txt').write_text(text.replace('include_directories(', 'include_directories(include ').replace(
        'add_executable', 'add_library(figures src/figures.cpp)\nadd_executable').replace(
        'cleaner ${catkin_LIBRARIES}', 'cleaner figures ${catkin_LIBRARIES}'))


@made(GOOD, BUMPER)
def bumper_with_a_module_beside_its_script(path):
    (script(path).parent / 'figures.py').write_text('TURN = 18\n')
    [cleaner] = path.glob('*/scripts/cleaner')
    cleaner.write_text(cleaner.read_text().replace('\nimport rospy', '\nimport figures\nimport rospy').replace(
        '= 3, 18', '= 3, figures.TURN'))


@made(GOOD, BUMPER)
def bumper_with_notes_in_the_log(path):
    replace(path, 'twist = Twist()', "twist = Twist()\n        rospy.loginfo_throttle(1.0, 'Traceback \\033[2J')")
