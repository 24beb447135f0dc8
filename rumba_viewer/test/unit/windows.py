"""What the tests of the window share: a floor without symmetry, and Qt without a display."""

import math
import os
import queue
import time

import numpy as np

os.environ.setdefault('QT_QPA_PLATFORM', 'offscreen')

from PyQt5.QtCore import QEvent, QEventLoop, QPoint, QPointF, Qt  # noqa: E402
from PyQt5.QtGui import QColor, QImage, QKeyEvent, QMouseEvent, QPalette, QWheelEvent  # noqa: E402
from PyQt5.QtWidgets import QApplication  # noqa: E402

from rumba_sim.model.common.geometry import Pose  # noqa: E402
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, UNKNOWN  # noqa: E402
from rumba_viewer.scene.snapshot import (Battery, Cleaning, Grid, Mission, Path, Robot, Simulation,  # noqa: E402
                                         Snapshot)
from rumba_viewer.scene.theme import DARK, LIGHT  # noqa: E402
from rumba_viewer.window.window import Options, Window  # noqa: E402

APPLICATION = QApplication.instance() or QApplication(['test'])
SCALE = 100.0  # [pixels/m] of the pictures
WIDTH, HEIGHT = 400, 300  # [pixels] of a picture of the whole floor
LEFT, BOTTOM = -1.0, 2.0  # [m]
SERVICES = frozenset({'pause', 'resume', 'step', 'reset', 'spawn', 'kill', 'tuning/set_parameters'})
MISSING = 'Waiting for a simulator\nTo start one, in another terminal:\nroslaunch rumba_sim simulator.launch'


def plan(number=1):
    """4 x 3 m of cells of 0.1 m: a wall on the left, a post near the upper right corner; the lower right is unknown."""
    cells = np.full((30, 40), FREE, np.int8)
    cells[:, :3] = OCCUPIED
    cells[24:27, 33:36] = OCCUPIED
    cells[:5, 35:] = UNKNOWN
    return Grid(cells, 0.1, LEFT, BOTTOM, number)


def coverage(number=2):
    """A swept band at the lower edge, above it one that is still to sweep; the rest is out of reach."""
    cells = np.full((30, 40), -1, np.int8)
    cells[:8, 5:30] = 100
    cells[8:12, 5:30] = 0
    return Grid(cells, 0.1, LEFT, BOTTOM, number)


def robot(name='rumba', pose=Pose(0.5, 4.0, 0.0), **known):
    """A robot of which everything is known; arguments replace some of it."""
    told = {'brushes_up': False, 'battery': Battery(0.6, 15.5, -1.7, 'on battery'), 'message': 'no trouble',
            'cleaning': Cleaning(0.25, 1.5, 6.0, 0.8, 12.5), 'has_cleaner': True,
            'mission': Mission('cleaning', True, 'bounce', 'drives straight')}
    return Robot(name, pose, **{**told, **known})


def simulation(**known):
    """A simulator in simulated time, twice as fast as real time; arguments replace some of it."""
    return Simulation(**{**{'node': '/simulator', 'speed': 2.0, 'wanted': 2.0, 'is_simulated': True, 'time': 83.0,
                            'services': SERVICES}, **known})


def snapshot(*robots, **known):
    """The floor with robots on it, and a simulator in simulated time."""
    told = {'plan': plan(), 'coverage': coverage(), 'simulation': simulation()}
    return Snapshot(robots=robots, **{**told, **known})


def path(*points, number=7):
    """A path along points [m]."""
    return Path(np.array(points, float), number)


def pixels(picture):
    """Red, green and blue (rows, columns, 3) of a picture."""
    picture = picture.convertToFormat(QImage.Format_RGB32)
    bits = picture.constBits()
    bits.setsize(picture.bytesPerLine() * picture.height())
    return np.frombuffer(bits, np.uint8).reshape(picture.height(), picture.width(), 4)[..., 2::-1].astype(int)


def near(picture, x, y, colour, tolerance=12):
    """Whether the pixel at a position has a colour, or nearly so."""
    return count(picture, colour, math.floor(x), math.floor(y), math.floor(x) + 1, math.floor(y) + 1, tolerance) == 1


def count(picture, colour, left=0, top=0, right=None, bottom=None, tolerance=12):
    """How many pixels of a part of a picture have a colour."""
    part = pixels(picture)[top:bottom, left:right]
    return int((abs(part - QColor(colour).getRgb()[:3]) <= tolerance).all(axis=2).sum())


class Source:
    """A fake listener: it has the snapshot that a test gives it."""

    def __init__(self, first):
        self.next = first
        self.selected = []

    def has_news(self, _):
        return self.next is not None

    def snapshot(self, _):
        found, self.next = self.next, None
        return found

    def select(self, *what):
        self.selected.append(what)


class Actor:
    """A fake actor: it records the calls of its methods; what the window records by itself is apart."""

    def __init__(self):
        self.done, self.recorded = [], []
        self.notices = queue.SimpleQueue()
        self.report = ''
        self.can_record = self.can_keep = True

    def record_mission(self, *what):
        """Whether it records."""
        (self.done if what[-1] else self.recorded).append(('record_mission', *what))
        return self.can_record

    def keep_recording(self, bag):
        """Whether the bag can stay."""
        self.done.append(('keep_recording', bag))
        return self.can_keep

    def __getattr__(self, name):
        return lambda *arguments: self.done.append((name, *arguments))


class Opened:
    """A window that shows a snapshot, and the events of a person who uses it."""

    def __init__(self, shown, style='light', size=(900, 600), folder='', **options):
        self.source, self.actor = Source(shown), Actor()
        self.window = Window(self.source, self.actor, Options(
            options.get('linear', 0.3), options.get('angular', 1.5), folder, ('bounce', 'spiral'), False), Snapshot())
        theme = DARK if style == 'dark' else LIGHT
        self.window.setPalette(QPalette(QColor(theme.background)))
        self.window.resize(*size)
        self.window.show()
        self.window.update_picture()
        APPLICATION.processEvents()

    def show(self, shown):
        """Make the listener have another snapshot."""
        self.source.next = shown
        self.window.update_picture()

    def press(self, key, modifiers=Qt.NoModifier):
        """A key goes down."""
        APPLICATION.sendEvent(self.window, QKeyEvent(QEvent.KeyPress, key, modifiers))

    def release(self, key, stays=True):
        """A key goes up, and stays up until the window takes that for a release."""
        APPLICATION.sendEvent(self.window, QKeyEvent(QEvent.KeyRelease, key, Qt.NoModifier))
        end = time.monotonic() + 5.0
        while stays and not self.window.keyboard.is_idle and time.monotonic() < end:
            APPLICATION.processEvents(QEventLoop.AllEvents, 10)

    def type(self, key, modifiers=Qt.NoModifier):
        """A key goes down and up."""
        self.press(key, modifiers=modifiers)
        self.release(key)

    def mouse(self, kind, x, y, button=Qt.LeftButton):
        """An event of the mouse at a pixel of the floor."""
        held = Qt.NoButton if kind == QEvent.MouseButtonRelease else button
        APPLICATION.sendEvent(self.window.floor, QMouseEvent(
            kind, QPointF(x, y), Qt.NoButton if kind == QEvent.MouseMove else button, held, Qt.NoModifier))

    def drag(self, start, end, button=Qt.LeftButton):
        """The mouse goes down, moves and goes up."""
        self.mouse(QEvent.MouseButtonPress, *start, button)
        for share in (0.5, 1.0):
            self.mouse(QEvent.MouseMove, *(a + share * (b - a) for a, b in zip(start, end)), button)
        self.mouse(QEvent.MouseButtonRelease, *end, button)

    def click(self, x, y):
        """A click at a pixel of the floor."""
        self.mouse(QEvent.MouseButtonPress, x, y)
        self.mouse(QEvent.MouseButtonRelease, x, y)

    def double_click(self, x, y):
        """A double click at a pixel of the floor: the events that Qt makes of it."""
        self.click(x, y)
        self.mouse(QEvent.MouseButtonDblClick, x, y)
        self.mouse(QEvent.MouseButtonRelease, x, y)

    def wheel(self, x, y, notches):
        """The wheel turns by so many notches."""
        position = QPointF(x, y)
        APPLICATION.sendEvent(self.window.floor, QWheelEvent(
            position, self.window.floor.mapToGlobal(position.toPoint()), QPoint(), QPoint(0, round(120 * notches)),
            Qt.NoButton, Qt.NoModifier, Qt.NoScrollPhase, False))

    def picture(self):
        """What the window looks like."""
        return self.window.grab().toImage()
