"""What the tests of the viewer share: a display, a viewer on it as a user starts it, and a fake cleaner."""

import os
import signal
import subprocess
import tempfile
import time

import numpy as np
import programs
import rospy
from PIL import Image
from simulators import LOOK_PERIOD, TIMEOUT, wait
from std_srvs.srv import Trigger

from rumba_msg.msg import CleanActionGoal, CleanActionResult, CleanResult, GoToActionGoal, MissionStatus, Outcome
from rumba_viewer.window.panel import EDGE, WIDTH

programs.LIBRARIES += ['PyQt5.QtWidgets', 'actionlib_msgs.msg']
BETWEEN = 0.5  # [s] from one press of a key to the next
ROBOT, CARD, CLIFF = (31, 111, 214), (255, 255, 255), (232, 143, 134)  # colours of the light style
PANEL = WIDTH + 2 * EDGE  # [pixels] on the right that are not floor


def of_colour(picture, colour):
    """Which pixels have a colour, or nearly so."""
    return abs(picture - colour).max(axis=2) <= 30


class Display:
    """A virtual screen."""

    def __init__(self, test):
        reads, writes = os.pipe()
        self._process = subprocess.Popen(
            ['Xvfb', '-displayfd', str(writes), '-screen', '0', '1280x800x24', '-nolisten', 'tcp', '-noreset'],
            pass_fds=[writes], stderr=subprocess.DEVNULL)
        test.addCleanup(self._process.wait)
        test.addCleanup(self._process.kill)
        os.close(writes)
        with os.fdopen(reads) as number:
            self.name = f':{number.readline().strip()}'

    def run(self, *arguments):
        """Run xdotool; returns what it prints."""
        return subprocess.run(['xdotool', *arguments], env={**os.environ, 'DISPLAY': self.name}, timeout=TIMEOUT,
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, universal_newlines=True).stdout


class Viewer:
    """A viewer for one test, and what it prints."""

    def __init__(self, test, *arguments, display=None, master=None, **variables):
        self._test, self._display = test, display
        if rospy.has_param('/viewer'):
            rospy.delete_param('/viewer')
        environment = dict(os.environ)
        for name in ('DISPLAY', 'WAYLAND_DISPLAY', 'QT_QPA_PLATFORM'):
            environment.pop(name, None)
        environment.update({'DISPLAY': display.name} if display else {'QT_QPA_PLATFORM': 'offscreen'})
        environment.update({**({'ROS_MASTER_URI': master} if master else {}), **variables})
        self._output = tempfile.TemporaryFile('w+')
        test.addCleanup(self._output.close)
        self.folder = tempfile.TemporaryDirectory()
        test.addCleanup(self.folder.cleanup)
        self.process = programs.start('rumba_viewer', 'viewer', '_style:=light', f'_folder:={self.folder.name}',
                                      *arguments, env=environment, stdout=self._output, stderr=self._output)
        test.addCleanup(self.process.wait)
        test.addCleanup(self.process.kill)

    @property
    def printed(self):
        """What it printed so far."""
        self._output.seek(0)
        return self._output.read()

    def is_there(self):
        """Wait until the master knows it; returns itself."""
        def answers():
            try:
                return self.process.poll() is not None or self.picture() is not None
            except rospy.ServiceException:  # not there yet, or the entry of a killed one
                return False
        wait(self._test, answers, 'the viewer', LOOK_PERIOD)
        self._test.assertIsNone(self.process.poll(), self.printed)
        return self

    def picture(self):
        """The picture of the floor in the window: int (rows, columns, 3)."""
        try:
            answer = rospy.ServiceProxy('/viewer/save_png', Trigger)()
        except rospy.ServiceException as error:
            raise rospy.ServiceException(f'{error}; exit code {self.process.poll()}; {self.printed}')
        self._test.assertTrue(answer.success, answer.message)
        return np.asarray(Image.open(answer.message).convert('RGB')).astype(int)[:, :-PANEL]

    def wait_to_see(self, colour, least, most=10 ** 9):
        """Wait until the floor shows so many pixels of a colour, or nearly so; returns which: bool (rows, columns)."""
        def sees():
            shown = of_colour(self.picture(), colour)
            return [shown] if least <= shown.sum() <= most else []
        return wait(self._test, sees, f'{least} to {most} pixels of {colour}')[0]

    def front(self):
        """Wait for its window, and give it the keyboard."""
        def finds():
            self._test.assertIsNone(self.process.poll(), self.printed)
            return self._display.run('search', '--onlyvisible', '--name', 'Rumba').split()
        self._window = wait(self._test, finds, 'the window')[-1]
        self._display.run('windowfocus', '--sync', self._window)

    def key(self, what, *keys):
        """`key`, `keydown` or `keyup`."""
        self._display.run(what, *keys)

    def key_until(self, key, condition, what):
        """Press a key until a condition holds; returns what the condition returned."""
        def tries():
            self.key('key', key)
            end = time.monotonic() + BETWEEN
            while not condition() and time.monotonic() < end:
                time.sleep(0.01)
            return condition()
        return wait(self._test, tries, what)

    def click(self, x, y, times=1):
        """Click on the point of the floor at a share of its width and height, from its left upper corner.

        Not where the pointer is already: xdotool waits for it to move, for 15 s.
        """
        width, height = (int(line.split('=')[1]) for line in self._display.run(
            'getwindowgeometry', '--shell', self._window).splitlines() if line.startswith(('WIDTH', 'HEIGHT')))
        self._display.run('mousemove', '--sync', '--window', self._window, str(round(x * (width - PANEL))),
                          str(round(y * height)))
        self._display.run('click', '--repeat', str(times), '--delay', '50', '1')

    def ends(self, code=0):
        """Wait for its end, which must be quiet; returns what it printed."""
        wait(self._test, lambda: self.process.poll() is not None, 'the end of the viewer')
        self._test.assertEqual(self.process.returncode, code, self.printed)
        self._test.assertNotIn('Traceback', self.printed)
        return self.printed

    def end(self, number=signal.SIGTERM):
        """End it by a signal."""
        self.process.send_signal(number)
        return self.ends()


class Cleaner:
    """A fake cleaner: it publishes what a test tells it, and collects goals."""

    def __init__(self, test):
        self._test = test
        self._status = rospy.Publisher('/rumba/mission_status', MissionStatus, queue_size=1, latch=True)
        self._result = rospy.Publisher('/rumba/clean/result', CleanActionResult, queue_size=1)
        for publisher in (self._status, self._result):
            test.addCleanup(publisher.unregister)
        self.goals = []
        for name, kind in (('clean', CleanActionGoal), ('go_to', GoToActionGoal)):
            subscriber = rospy.Subscriber(f'/rumba/{name}/goal', kind, self.goals.append)
            test.addCleanup(subscriber.unregister)
            wait(test, subscriber.get_num_connections, f'a client of {name}')

    def tell(self, state, strategy=''):
        """Publish a state of the mission."""
        self._status.publish(MissionStatus(state=state, strategy=strategy, message='told by a test'))
        wait(self._test, self._status.get_num_connections, 'the viewer to listen')

    def ends(self, code):
        """Publish that a cleaning ended with an outcome."""
        wait(self._test, self._result.get_num_connections, 'the viewer to listen')
        self._result.publish(CleanActionResult(result=CleanResult(outcome=Outcome(code=code))))
