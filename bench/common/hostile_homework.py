"""Homework that cheats, or breaks things, and does nothing else for the task."""

import os
import pathlib
import shutil
import socket
import zipfile

from common.homework import (
    BUMPER, EXERCISES, HOSTILE, MARKER, ROOT, SLEEP, cmake, first, made, package, replace, solved)


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
