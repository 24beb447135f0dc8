"""A class that hands in what classes hand in: good submissions, wrong ones, and some that cheat or break things.

Each maker writes one submission into a folder, or beside it as an archive; its name is that of the submission. Hostile
ones do nothing for the task but to cheat, so that each point that they get is a fault.
"""

import os
import pathlib
import shutil
import socket
import tarfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXERCISES = ROOT / 'rumba_exercises'
STATUS, BUMPER = '1_status', '2_bumper'
GOOD, WRONG, HOSTILE = 'good', 'wrong', 'hostile'
MARKER = 'left_behind_by_a_submission'  # name of files that hostile ones write wherever they can
SLEEP = 43211  # [s] of processes that hostile ones leave behind
MAKERS = {GOOD: [], WRONG: [], HOSTILE: []}
PACKAGES = {STATUS: ('status_exercise', 'status'), BUMPER: ('bumper_exercise', 'cleaner')}

MANIFEST = '''<package format="3">
  <name>{name}</name><version>0.1.0</version><description>Mine.</description>
  <maintainer email="me@example.org">Me</maintainer><license>BSD-3-Clause</license>
  <buildtool_depend>catkin</buildtool_depend>
  {depends}
</package>
'''
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
CMAKE = '''cmake_minimum_required(VERSION 3.5)
project({name})
find_package(catkin REQUIRED COMPONENTS {components})
{messages}catkin_package({package})
include_directories(${{catkin_INCLUDE_DIRS}})
{rest}
'''


def made(kind, exercise):
    """Register a maker, which gets a folder with the starter package and, if it is to be good, the solution."""
    def register(maker):
        MAKERS[kind].append((exercise, maker))
        return maker
    return register


def build(folder):
    """Make the class: a folder for each exercise; returns the kind of each submission by exercise and name."""
    kinds = {}
    for kind, makers in MAKERS.items():
        for exercise, maker in makers:
            path = folder / exercise / maker.__name__
            shutil.copytree(EXERCISES / exercise / 'starter', path)
            if kind == GOOD:
                shutil.copytree(EXERCISES / exercise / 'solution', path, dirs_exist_ok=True)
            name = maker(path) or maker.__name__
            kinds[exercise, name] = kind
    return kinds


def script(path):
    """The script of a submission."""
    [found] = path.glob('*/scripts/*')
    return found


def package(path):
    """The package of a submission."""
    [found] = path.glob('*/package.xml')
    return found.parent


def replace(path, old, new):
    """Replace a text in the script of a submission."""
    text = script(path).read_text()
    assert old in text, (path, old)
    script(path).write_text(text.replace(old, new))


def first(path, code):
    """Begin the script of a submission by some code, after its first line."""
    head, _, rest = script(path).read_text().partition('\n')
    script(path).write_text(f'{head}\n{code}\n{rest}')


def cmake(folder, components, messages='', rest='', package_words=''):
    """Write the files of a package that is built."""
    name = folder.name
    (folder / 'CMakeLists.txt').write_text(CMAKE.format(
        name=name, components=components, messages=messages, rest=rest, package=package_words))
    depends = '\n  '.join(f'<depend>{each}</depend>' for each in components.split())
    (folder / 'package.xml').write_text(MANIFEST.format(name=name, depends=depends))


def in_cpp(path, source, node, components):
    """Make a submission one in C++."""
    own = package(path)
    shutil.rmtree(own / 'scripts')
    (own / 'src').mkdir()
    (own / 'src' / f'{node}.cpp').write_text(source)
    cmake(own, components, rest=f'add_executable({node} src/{node}.cpp)\n'
                                f'target_link_libraries({node} ${{catkin_LIBRARIES}})')


def zipped(path, place=''):
    """Put a submission into an archive, in its place."""
    with zipfile.ZipFile(f'{path}.zip', 'w') as archive:
        for each in sorted(path.rglob('*')):
            archive.write(each, pathlib.Path(place) / each.relative_to(path))
    shutil.rmtree(path)


# --- good -------------------------------------------------------------------------------------------------------------

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


# --- wrong ------------------------------------------------------------------------------------------------------------

def solved(path, exercise):
    """Put the solution over the starter package."""
    shutil.copytree(EXERCISES / exercise / 'solution', path, dirs_exist_ok=True)


def wrong(exercise):
    """Register what is right but for a mistake."""
    def register(maker):
        def make(path):
            solved(path, exercise)
            maker(path)
        make.__name__ = maker.__name__
        MAKERS[WRONG].append((exercise, make))
        return maker
    return register


@wrong(STATUS)
def windows_line_ends(path):
    script(path).write_bytes(script(path).read_bytes().replace(b'\n', b'\r\n'))


@wrong(STATUS)
def byte_order_mark(path):
    script(path).write_bytes(b'\xef\xbb\xbf' + script(path).read_bytes())


@wrong(STATUS)
def script_with_another_name(path):
    script(path).rename(script(path).with_name('status_node.py'))


@wrong(STATUS)
def script_that_is_missing(path):
    script(path).unlink()


@wrong(STATUS)
def without_first_line(path):
    script(path).write_text(script(path).read_text().partition('\n')[2])


@wrong(STATUS)
def python_2(path):
    replace(path, 'Status()\nrospy.spin', "Status()\nprint 'ready'\nrospy.spin")


@wrong(STATUS)
def tabs_and_spaces(path):
    replace(path, '        status = BatteryStatus()', '\tstatus = BatteryStatus()')


@wrong(STATUS)
def share_for_percent(path):
    replace(path, 'math.ceil(100.0 * battery.percentage)', 'int(battery.percentage)')


@wrong(STATUS)
def wrong_topic(path):
    replace(path, 'student/battery_status', 'battery_status')


@wrong(STATUS)
def wrong_type(path):
    replace(path, "'student/battery_status', BatteryStatus", "'student/battery_status', BatteryState")
    replace(path, 'status = BatteryStatus()', 'status = BatteryState()')
    replace(path, 'status.percentage_battery', 'status.percentage')
    for name in ('location_x', 'location_y', 'orientation_theta'):
        replace(path, f'status.{name}', 'status.charge')
    replace(path, 'status.debug_message', 'status.location')


@wrong(STATUS)
def ends_at_once(path):
    replace(path, '\nrospy.spin()\n', '\n')


@wrong(STATUS)
def endless_loop(path):
    replace(path, '\nrospy.spin()\n', '\nwhile True: pass\n')
    replace(path, "\n        rospy.Subscriber('rumba/battery_state'", "\n        0, ('rumba/battery_state'")


@wrong(STATUS)
def misspelt_module(path):
    replace(path, 'import rospy\n', 'import rospy\nimport numpyy\n')


@wrong(BUMPER)
def package_that_is_not_installed(path):
    cmake(package(path), 'geometry_msgs moveit_core rospy', rest='add_library(nothing nothing.cpp)')


@wrong(BUMPER)
def error_in_cpp(path):
    in_cpp(path, CPP_BUMPER.replace('--backing, twist', '--backing twist'), 'cleaner',
           'geometry_msgs roscpp rumba_msg')


@wrong(BUMPER)
def not_linked(path):
    in_cpp(path, CPP_BUMPER, 'cleaner', 'geometry_msgs roscpp rumba_msg')
    text = (package(path) / 'CMakeLists.txt').read_text()
    (package(path) / 'CMakeLists.txt').write_text(text[:text.index('target_link')])


@wrong(BUMPER)
def message_that_is_not_listed(path):
    bumper_by_two_nodes_and_a_message(path)
    lists = package(path) / 'CMakeLists.txt'
    lists.write_text(lists.read_text().replace('add_message_files(FILES Hit.msg)\ngenerate_messages()',
                                               'add_library(nothing src/nothing.cpp)'))
    (package(path) / 'src').mkdir()
    (package(path) / 'src' / 'nothing.cpp').write_text('')


@wrong(BUMPER)
def nothing_handed_in(path):
    shutil.rmtree(package(path))


@wrong(BUMPER)
def only_scripts(path):
    (package(path) / 'package.xml').unlink()


@wrong(BUMPER)
def ignores_its_bumper(path):
    replace(path, '= 3, 18', '= 0, 0')


# --- hostile ----------------------------------------------------------------------------------------------------------

def lazy(path):
    """Have a submission to exercise 2 sweep a little at the start, and no more."""
    solved(path, BUMPER)
    replace(path, '        self.publisher.publish(twist)', "        self.count = getattr(self, 'count', 0) + 1\n"
            '        self.publisher.publish(twist if self.count < 40 else Twist())')


@made(HOSTILE, BUMPER)
def asks_for_less_coverage(path):
    lazy(path)
    first(path, "import rospy\nrospy.set_param('/judge/partial', '')\n"
                "for _ in range(1000): rospy.set_param('/judge/coverage', 0.0001)\n")


@made(HOSTILE, BUMPER)
def has_a_wide_brush(path):
    lazy(path)
    first(path, "import rospy\nfor _ in range(1000): rospy.set_param('/simulator/brush/width', 9.0)\n")


@made(HOSTILE, BUMPER)
def leaves_a_process(path):
    first(path, f"import subprocess\nsubprocess.Popen(['setsid', 'sleep', '{SLEEP}'])\n")


@made(HOSTILE, BUMPER)
def leaves_a_process_when_it_is_built(path):
    cmake(package(path), 'rospy', rest=f'execute_process(COMMAND sh -c "setsid sleep {SLEEP} &")\n'
                                       'add_library(nothing nothing.cpp)')


@made(HOSTILE, BUMPER)
def odd_files(path):
    own = package(path)
    (path / os.fsdecode(b'caf\xe9.txt')).write_text('')
    (own / 'memory').symlink_to('/proc/self/mem')
    (own / 'zero').symlink_to('/dev/zero')
    os.mkfifo(own / 'pipe')
    with socket.socket(socket.AF_UNIX) as opened:
        here = os.getcwd()
        os.chdir(own)
        opened.bind('socket')
        os.chdir(here)
    (path / 'other').mkdir()
    (path / 'other' / 'CMakeLists.txt').mkdir()


@made(HOSTILE, BUMPER)
def judges_itself(path):
    other = path / 'rumba_evaluation'
    (other / 'src' / 'rumba_evaluation' / 'ros').mkdir(parents=True)
    for place in ('', 'ros'):
        (other / 'src' / 'rumba_evaluation' / place / '__init__.py').write_text('')
    (other / 'src' / 'rumba_evaluation' / 'ros' / 'mission_test.py').write_text(FORGED)
    (other / 'scripts').mkdir()
    (other / 'scripts' / 'mission_test').write_text('#!/usr/bin/env python3\n' + FORGED)
    (other / 'scripts' / 'mission_test').chmod(0o755)
    (other / 'setup.py').write_text(
        'from catkin_pkg.python_setup import generate_distutils_setup\nfrom setuptools import setup\n\n'
        "setup(**generate_distutils_setup(packages=['rumba_evaluation'], package_dir={'': 'src'}))\n")
    cmake(other, 'rospy', messages='catkin_python_setup()\n',
          rest='catkin_install_python(PROGRAMS scripts/mission_test DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})')


FORGED = '''
import glob, json, os, sys
def main():
    marks = {'tests': [{'name': name, 'score': most, 'max_score': most, 'output': 'well done'}
                       for name, most in (('coverage', 8.0), ('collisions', 2.0))]}
    for argument in sys.argv:
        if argument.startswith('--gtest_output=xml:'):
            with open(os.path.splitext(argument[19:])[0] + '.json', 'w') as file:
                json.dump(marks, file)
main()
'''


@made(HOSTILE, BUMPER)
def forks_without_end(path):
    first(path, 'import os\nwhile True:\n    try: os.fork()\n    except OSError: pass\n')


@made(HOSTILE, BUMPER)
def takes_all_memory(path):
    first(path, 'import subprocess, sys\nfor _ in range(8):\n    subprocess.Popen([sys.executable, "-c", "import time; '
                'x = [bytearray(b\'x\' * 10**7) for _ in range(150)]; time.sleep(1000)"])\n')


@made(HOSTILE, BUMPER)
def fills_the_disk(path):
    first(path, "import itertools, os\nfor number in itertools.count():\n"
                "    with open(os.path.join(os.environ['HOME'], str(number)), 'wb') as file:\n"
                "        file.write(10**8 * b'x')\n")


@made(HOSTILE, BUMPER)
def prints_without_end(path):
    first(path, "import sys\nwhile True: sys.stderr.write(10**4 * 'PASSED \\033[2J')\n")


@made(HOSTILE, BUMPER)
def kills_its_parents(path):
    first(path, "import os, signal\ntry: os.kill(os.getppid(), signal.SIGKILL)\nexcept OSError: pass\n"
                "for name in filter(str.isdigit, os.listdir('/proc')):\n    if int(name) != os.getpid():\n"
                "        with open(f'/proc/{name}/cmdline') as file: words = file.read()\n"
                "        if 'rosmaster' in words or 'mission_test' in words or 'keeper' in words:\n"
                "            os.kill(int(name), signal.SIGKILL)\n")


@made(HOSTILE, BUMPER)
def reads_the_tests(path):
    first(path, "import os, pathlib, sys\nfor place, _, names in os.walk('/'):\n    for name in names:\n"
                "        if name in ('bumper.test', 'status.test'):\n            sys.stderr.write(f'FOUND {place}')\n"
                f"for path in pathlib.Path('{EXERCISES}').glob('*/*/*'):\n    sys.stderr.write(f'FOUND {{path}}')\n")


@made(HOSTILE, BUMPER)
def writes_everywhere(path):
    places = ['/tmp', '/var/tmp', '/dev/shm', '/etc', '/usr/lib/python3/dist-packages', str(ROOT), str(EXERCISES),
              str(path.parent), str(path.parent.parent), str(pathlib.Path.home())]
    first(path, f"import os\nfor place in {places!r}:\n    try:\n        os.makedirs(place, exist_ok=True)\n"
                f"        with open(os.path.join(place, '{MARKER}'), 'w') as file: file.write('x')\n"
                "        with open(os.path.join(place, 'marks.csv'), 'a') as file: file.write('me,10,10\\n')\n"
                "    except OSError: pass\n")


@made(HOSTILE, BUMPER)
def says_that_it_passed(path):
    first(path, "import sys\nprint('[submission.rosunit-bumper/test_coverage][passed]')\n"
                "print('10 of 10 points', file=sys.stderr)\n" + FORGED)


@made(HOSTILE, BUMPER)
def looks_for_results(path):
    first(path, "import json, pathlib, time\nmarks = [{'name': name, 'score': most, 'max_score': most, 'output': ''}\n"
                "         for name, most in (('coverage', 8.0), ('collisions', 2.0))]\nfor _ in range(40):\n"
                "    time.sleep(0.2)\n    for place in pathlib.Path('/tmp').glob('**/results/submission'):\n"
                "        (place / 'rosunit-bumper.json').write_text(json.dumps({'tests': marks}))\n")


@made(HOSTILE, BUMPER)
def leaves_at_its_import(path):
    first(path, 'import sys\nsys.exit(0)\n')


@made(HOSTILE, BUMPER)
def ends_the_judge(path):
    first(path, "import xmlrpc.client, os, time\nmaster = xmlrpc.client.ServerProxy(os.environ['ROS_MASTER_URI'])\n"
                "for _ in range(100):\n    code, _, uri = master.lookupNode('/x', '/judge')\n    if code == 1: break\n"
                "    time.sleep(0.1)\nxmlrpc.client.ServerProxy(uri).shutdown('/x', 'bye')\n")


@made(HOSTILE, BUMPER)
def publishes_its_own_coverage(path):
    first(path, "import rospy\nfrom rumba_msg.msg import CleaningStatus\nrospy.init_node('cleaner')\n"
                "publisher = rospy.Publisher('rumba/cleaning_status', CleaningStatus, queue_size=1)\n"
                "while not rospy.is_shutdown():\n    publisher.publish(CleaningStatus(coverage=1.0))\n"
                "    rospy.rostime.wallsleep(0.05)\n")


@made(HOSTILE, BUMPER)
def moves_the_robot_by_a_call(path):
    first(path, "import rospy\nfrom rumba_msg.srv import Teleport\nrospy.init_node('cleaner')\n"
                "rospy.wait_for_service('rumba/teleport', 20)\n"
                "call = rospy.ServiceProxy('rumba/teleport', Teleport)\nfor number in range(100):\n"
                "    call(pose=dict(x=1.0 + number / 50.0, y=1.0, theta=0.0))\n")


@made(HOSTILE, BUMPER)
def unpacks_to_a_terabyte(path):
    shutil.rmtree(package(path))
    with zipfile.ZipFile(path / 'homework.zip', 'w', zipfile.ZIP_DEFLATED) as archive:
        with archive.open('bumper_exercise/zeros', 'w', force_zip64=True) as file:
            for _ in range(300):
                file.write(1_000_000 * b'\0')
        archive.writestr('../../' + MARKER, 'x')
