"""Listens to the map of the floor: the robot's, or the true one with the robot's own over it."""

import itertools
import threading
from typing import Any, Callable, NamedTuple, Optional, Tuple

import numpy as np
from nav_msgs.msg import OccupancyGrid
from rospy.numpy_msg import numpy_msg
from tf2_msgs.msg import TFMessage

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import UNKNOWN
from rumba_sim.model.maps.laid_over import laid_over
from rumba_sim.ros.participants import maps
from rumba_viewer.ros import readings
from rumba_viewer.ros.subscription import Subscription
from rumba_viewer.scene.map_frame import SAME
from rumba_viewer.scene.snapshot import Grid


class Maps(NamedTuple):
    """The maps of a snapshot; see `Snapshot`."""

    plan: Optional[Grid] = None
    known: Optional[Grid] = None
    frame: Optional[Pose] = SAME


class MapListener:
    """Callbacks of rospy store; the window asks."""

    def __init__(self, on_floor: Callable[[], object], on_news: Callable[[], object]) -> None:
        """Subscribe.

        Args:
            on_floor: called when there is another floor, in a thread of rospy.
            on_news: called when there is something else to show of the same one, likewise.
        """
        self._on_floor, self._on_news = on_floor, on_news
        self._lock = threading.Lock()  # held while something of the next four changes
        self._own: Optional[Grid] = None
        self._true: Optional[Grid] = None
        self._frame: Optional[Pose] = None
        self._known: Optional[Grid] = None  # the robot's own map on the cells of the true one
        self._numbers = itertools.count()
        grid = numpy_msg(OccupancyGrid)
        self._truth = Subscription(maps.TRUE_TOPIC, grid, readings.grid, self._take_true)
        self._subscriptions: Tuple[Subscription[Any], ...] = (
            self._truth, Subscription(maps.TOPIC, grid, readings.grid, self._take_own),
            Subscription('/tf_static', TFMessage, readings.map_frame, self._take_frame, queue_size=10))

    def close(self) -> None:
        """Stop listening."""
        for subscription in self._subscriptions:
            subscription.close()

    @property
    def maps(self) -> Maps:
        """What is there to show: the true map counts as long as a simulator tells it."""
        with self._lock:
            if self._is_true_map_told:
                return Maps(self._true, self._known, self._frame)
            return Maps(self._own)

    @property
    def _is_true_map_told(self) -> bool:
        return self._true is not None and self._truth.is_connected

    def _take_own(self, own: Grid) -> None:
        with self._lock:
            self._own = own
            self._lay_over()
            is_same_floor = self._is_true_map_told
        (self._on_news if is_same_floor else self._on_floor)()

    def _take_true(self, true: Grid) -> None:
        with self._lock:
            self._true = true
            self._lay_over()
        self._on_floor()

    def _take_frame(self, frame: Optional[Pose]) -> None:
        if frame is not None:  # many nodes publish on this topic
            with self._lock:
                self._frame = frame
                self._lay_over()
            self._on_news()

    def _lay_over(self) -> None:
        if self._true is None:
            return
        if self._own is None or self._frame is None:
            cells = np.full(self._true.cells.shape, UNKNOWN, np.int8)
        else:
            cells = laid_over(self._own, self._frame, self._true)
        self._known = Grid(cells, self._true.resolution, self._true.left, self._true.bottom, next(self._numbers))
