"""Pictures of all that people see, in every state of a mission, and what axe-core says of the pages.

`faces.py [--folder FOLDER]`: the page for browsers, the window, the live line of the terminal, the report and the site,
at 360, 1280 and 2560 pixels, light and dark. Everything is real: a simulator, a cleaner, and two missions, of which one
succeeds and one ends with an empty battery. Needs chromium-driver and python3-selenium, and axe-core for the check;
the site is there after `./rumba docs`.
"""

import argparse
import collections
import contextlib
import html
import itertools
import os
import pathlib
import shutil
import socket
import subprocess
import tempfile
import urllib.parse

import actionlib
import rosgraph
import rospy
from common import figures, ros_session
from common.browsers import AXE, IS_THERE, SCHEMES, Browser
from common.ports import free_port
from common.terminals import Terminal
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure
from geometry_msgs.msg import Pose2D
from std_srvs.srv import Trigger

from rumba_msg.msg import CleanAction, CleanGoal, CleaningStatus, MissionStatus
from rumba_msg.srv import Kill, Spawn

SIZES = ((360, 740), (1280, 800), (2560, 1440))  # [pixels]
COLUMNS = (40, 80, 160)  # of the terminals
FAST = 20.0  # times real time, from one state to the next
SIMULATOR = {'map': 'apartment', 'speed': 2, 'battery/drain': 20}
EMPTY = 10_000.0  # times as fast as a real battery
TARGET = 0.55  # share of the floor after which the first mission is done
SETTLE = 5.0  # [s] of the simulation, until a new window has got map and coverage
PATIENCE = 900.0  # [s] for a part of a mission
TOKENS = {'token': 'teacher', 'robot_tokens': 'rumba:blue,rumba2:green'}
RECORDED = ('/map', *(f'/{robot}/{name}' for robot in ('rumba', 'rumba2') for name in (
    'ground_truth', 'battery_state', 'cleaning_status', 'bumper', 'dock_status', 'mission_status', 'coverage',
    'clean/goal')))
SITE = pathlib.Path(__file__).resolve().parents[1] / '.ws' / 'docs' / 'html'
PAGES_OF_SITE = ('index.html', 'docs/first_minutes.html', 'docs/interfaces.html')


def main():
    """Take the pictures, and print how many there are and what is wrong."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--folder', type=pathlib.Path, default=pathlib.Path(tempfile.gettempdir(), 'rumba_faces'))
    folder = parser.parse_args().folder
    figures.heading(f'What people see: pictures in {folder}')
    if not IS_THERE:
        print('  none, without chromium-driver and python3-selenium')
        return
    folder.mkdir(parents=True, exist_ok=True)
    with contextlib.closing(Album(folder)) as album, ros_session.master():
        missions(album)
        album.site()
        figures.row('pictures', len(album.taken))
        if AXE.exists():
            figures.row('rules of axe-core that a page breaks', len(album.broken), below=1)
        else:
            print('  axe-core was not run: npm install axe-core, and its node_modules in NODE_PATH')
        for line, pictures in album.broken.items():
            print(f'  {line}\n    in {", ".join(pictures)}')


class Album:
    """The pictures in a folder, and what is wrong with those of pages."""

    def __init__(self, folder):
        """Start a browser."""
        self.folder, self.taken, self.broken = folder, [], collections.defaultdict(list)
        self._browser = Browser()
        self.driver = self._browser.driver

    def close(self):
        """Close the browser."""
        self._browser.quit()

    def page(self, name):
        """Take what the browser shows, in all sizes and schemes."""
        for size, scheme in itertools.product(SIZES, SCHEMES):
            self._browser.look(size, scheme)
            picture = f'{name}_{size[0]}_{scheme}.png'
            self.driver.save_screenshot(str(self.folder / picture))
            self.taken.append(picture)
            for line in self._browser.violations():
                self.broken[line].append(picture)

    def keep(self, path, name):
        """Take a picture that is there already."""
        shutil.move(path, self.folder / name)
        self.taken.append(name)

    def text(self, name, lines):
        """Take lines of a terminal."""
        (self.folder / f'{name}.txt').write_text(lines)
        page = (f'<!DOCTYPE html><html lang="en"><title>{name}</title><meta name="color-scheme" content="light dark">'
                f'<main><h1>Terminal</h1><pre>{html.escape(lines)}</pre></main>')
        self.driver.get(f'data:text/html;charset=utf-8,{urllib.parse.quote(page)}')
        for scheme in SCHEMES:
            self._browser.look(SIZES[1], scheme)
            self.driver.save_screenshot(str(self.folder / f'{name}_{scheme}.png'))
            self.taken.append(f'{name}_{scheme}.png')

    def site(self):
        """Take pages of the documentation, if it was made."""
        for page in PAGES_OF_SITE if SITE.exists() else ():
            self.driver.get((SITE / page).as_uri())
            self.page(f'site_{pathlib.Path(page).stem}')


class Faces:
    """Page, windows and terminals beside one simulator."""

    def __init__(self, album, stack):
        """Open them; they are closed with the stack."""
        self.album, self._folder = album, stack.enter_context(tempfile.TemporaryDirectory())
        self._pictures, self._port = tempfile.TemporaryDirectory(), free_port()
        stack.enter_context(self._pictures)
        self.server = stack.enter_context(contextlib.ExitStack())
        self.server.enter_context(ros_session.process(
            ['rosrun', 'rumba_viewer', 'page', f'_port:={self._port}',
             *(f'_{key}:={value}' for key, value in TOKENS.items())]))
        os.environ['QT_QPA_PLATFORM'] = 'offscreen'
        self._stack = stack
        for size, scheme in itertools.product(SIZES, SCHEMES):
            self._open_window(window(size, scheme), size, scheme)
        self.terminals = [stack.enter_context(contextlib.closing(Terminal(
            ['rosrun', 'rumba_viewer', 'console', f'__name:=console_{columns}'], columns))) for columns in COLUMNS]
        ros_session.wait_until(lambda: is_served(self._port))
        self.open('teacher')

    def _open_window(self, name, size, scheme):
        """Open one more window."""
        self._stack.enter_context(ros_session.process(
            ['rosrun', 'rumba_viewer', 'viewer', f'__name:={name}', f'_width:={size[0]}', f'_height:={size[1]}',
             f'_style:={scheme}', f'_folder:={self._pictures.name}']))

    def take_late(self):
        """Take a window that is opened now, while a mission goes on: it shows how long that has lasted."""
        self._open_window('window_late', SIZES[1], 'light')
        rospy.wait_for_service('/window_late/save_png', PATIENCE)
        ros_session.wait_until(lambda: listens('/window_late', '/rumba/coverage'))
        rospy.sleep(SETTLE)
        self._keep_window('window_late', 'window_late.png')

    def open(self, token=''):
        """Open the page with a token, until it shows a robot."""
        self.album.driver.get('about:blank')
        self.album.driver.get(f'http://127.0.0.1:{self._port}/#token={token}')
        self.wait_for('waiting', lambda text: not text)

    def wait_for(self, name, condition):
        """Wait until the text of an element of the page meets a condition."""
        ros_session.wait_until(lambda: condition(self.album.driver.execute_script(
            'return document.getElementById(arguments[0])?.textContent ?? "?"', name)))

    def take(self, state):
        """Take what all of them show."""
        self.album.page(f'page_{state}')
        for size, scheme in itertools.product(SIZES, SCHEMES):
            self._keep_window(window(size, scheme), f'window_{state}_{size[0]}_{scheme}.png')
        return [(f'terminal_{state}_{terminal.columns}', terminal.line()) for terminal in self.terminals]

    def _keep_window(self, name, picture):
        self.album.keep(rospy.ServiceProxy(f'/{name}/save_png', Trigger)().message, picture)


def listens(node, topic):
    """Whether a node subscribes to a topic."""
    return node in dict(rosgraph.Master('/faces').getSystemState()[1]).get(topic, [])


def is_served(port):
    """Whether somebody listens at a port of this machine."""
    with socket.socket() as trial:
        return trial.connect_ex(('127.0.0.1', port)) == 0


def window(size, scheme):
    """The name of the node of a window."""
    return f'window_{size[0]}_{scheme}'


class Latest:
    """The newest message of a topic, by the fields of the message."""

    def __init__(self, topic, kind):
        """Listen to it."""
        self._message = kind()
        rospy.Subscriber(topic, kind, self._take)

    def _take(self, message):
        self._message = message

    def __getattr__(self, name):
        return getattr(self._message, name)


def tune(**values):
    """Change settings of the simulator."""
    rospy.ServiceProxy('/simulator/tuning/set_parameters', Reconfigure)(
        Config(doubles=[DoubleParameter(name, value) for name, value in values.items()]))


def reach(condition):
    """Let time pass quickly until a condition is met."""
    tune(speed=FAST)
    ros_session.wait_until(condition, PATIENCE)
    tune(speed=1.0)


@contextlib.contextmanager
def recorded(path):
    """Record a mission during the block."""
    with ros_session.process(['rosbag', 'record', '-O', str(path), *RECORDED]):
        yield


def missions(album):
    """Pictures of two missions in each of their states, and of their reports."""
    with tempfile.TemporaryDirectory() as bags:
        lines = missions_recorded(album, pathlib.Path(bags))
        for name, shown in lines:
            album.text(name, shown)
        for name in ('done', 'stuck'):
            subprocess.run(['rosrun', 'rumba_evaluation', 'mission_report', f'{bags}/{name}.bag'], check=True)
            album.driver.get(f'file://{bags}/{name}.html')
            album.page(f'report_{name}')


def missions_recorded(album, bags):
    """Record two missions in a folder, and take pictures meanwhile; returns what the terminals showed."""
    with contextlib.ExitStack() as stack:
        stack.enter_context(ros_session.simulator(**SIMULATOR))
        stack.enter_context(ros_session.process(['rosrun', 'rumba_cleaning', 'cleaner']))
        tune(speed=1.0)
        faces = Faces(album, stack)
        cleaner = actionlib.SimpleActionClient('/rumba/clean', CleanAction)
        cleaner.wait_for_server()
        with recorded(bags / 'done.bag'):
            lines = first_mission(faces, cleaner)
        with recorded(bags / 'stuck.bag'):
            lines += second_mission(faces, cleaner)
        faces.server.close()
        faces.wait_for('state', lambda text: text == 'Not connected')
        album.page('page_disconnected')
        return lines


def first_mission(faces, cleaner):
    """One that is refused before it begins, and then succeeds; returns what the terminals showed."""
    mission, floor = Latest('/rumba/mission_status', MissionStatus), Latest('/rumba/cleaning_status', CleaningStatus)
    faces.wait_for('state', lambda text: text == 'Idle')
    faces.album.driver.execute_script('for (const name of ["x", "y"]) document.getElementById(name).value = 0;'
                                      'document.getElementById("go").requestSubmit()')
    faces.wait_for('notice', bool)
    lines = faces.take('refused')
    cleaner.send_goal(CleanGoal(target_coverage=TARGET))
    ros_session.wait_until(lambda: mission.state == MissionStatus.CLEANING)
    lines += faces.take('planning')
    reach(lambda: floor.coverage > 0.3)
    lines += faces.take('cleaning')
    faces.take_late()
    faces.open()
    faces.album.page('page_token')
    faces.open('teacher')
    rospy.ServiceProxy('/simulator/spawn', Spawn)(name='rumba2', pose=Pose2D(5.6, 3.9, 2.0))
    lines += faces.take('two_robots')
    rospy.ServiceProxy('/simulator/kill', Kill)(name='rumba2')
    reach(lambda: mission.state == MissionStatus.CHARGING)
    lines += faces.take('charging')
    reach(lambda: mission.state == MissionStatus.IDLE)
    return lines + faces.take('done')


def second_mission(faces, cleaner):
    """One that ends with an empty battery; returns what the terminals showed."""
    mission, floor = Latest('/rumba/mission_status', MissionStatus), Latest('/rumba/cleaning_status', CleaningStatus)
    ros_session.wait_until(lambda: floor.distance)
    far = floor.distance
    cleaner.send_goal(CleanGoal())
    reach(lambda: floor.distance > far + 2.0)
    tune(battery_drain=EMPTY)
    reach(lambda: mission.state == MissionStatus.STRANDED)
    return faces.take('stuck')


if __name__ == '__main__':
    main()
