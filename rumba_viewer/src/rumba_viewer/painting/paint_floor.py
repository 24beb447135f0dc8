"""Paints the floor: walls, carpet, cliffs, what is swept and what is not, and the paths of robots.

Each layer is drawn to the size of the picture once, and kept until it, or the view, is another.
"""

from typing import Dict, Iterator, Optional, Tuple

import numpy as np
from PyQt5.QtCore import QPointF, QRectF, Qt
from PyQt5.QtGui import QColor, QImage, QPainter, QPen, QPolygonF

from rumba_sim.model.floor_plan import FREE, OCCUPIED
from rumba_viewer.scene.snapshot import Array, Grid, Path, Place, Snapshot
from rumba_viewer.scene.theme import Theme, robot_colour
from rumba_viewer.scene.view_transform import ViewTransform

CRISP = 4.0  # [pixels] of a cell from which on its edges are not smoothed
COARSE = 0.5  # [pixels] of a cell below which several make one pixel
PATH_WIDTH = 1.4  # [pixels]
PATH_ALPHA = 150
CORNERS = 4.0  # [pixels] from one corner of a path to the next, at least
STRIPES = 0.12  # [m] from one to the next, along an axis
SWEPT, TO_SWEEP = 100, 0  # in the coverage grid


class FloorPainter:
    """Keeps the floor as it was painted last."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self._cells: Tuple[object, Optional[QImage]] = (None, None)
        self._view: Tuple[object, Optional[QImage]] = (None, None)

    def paint(self, painter: QPainter, snapshot: Snapshot, view: ViewTransform, theme: Theme) -> None:
        """Paint the floor of a snapshot that has a plan."""
        plan, coverage, place = snapshot.plan, snapshot.coverage, snapshot.place
        assert plan is not None
        content = (plan.number, coverage and coverage.number, id(place), theme)
        if self._cells[0] != content:
            self._cells = content, floor_image(plan, coverage, place, theme)
        if self._view[0] != (content, view):
            self._view = (content, view), _scaled(self._cells[1], plan, view, theme)
        painter.drawImage(0, 0, self._view[1])


def floor_image(plan: Grid, coverage: Optional[Grid], place: Place, theme: Theme) -> QImage:
    """One pixel a cell, the top row that of the highest y."""
    colours = np.full(plan.cells.shape, _rgb(theme.unknown), np.uint32)
    free = plan.cells == FREE
    colours[plan.cells == OCCUPIED] = _rgb(theme.wall)
    colours[free] = _rgb(theme.out_of_reach if coverage is not None else theme.swept)
    if coverage is not None and coverage.cells.shape == plan.cells.shape:
        colours[free & (coverage.cells == TO_SWEEP)] = _rgb(theme.to_sweep)
        colours[free & (coverage.cells == SWEPT)] = _rgb(theme.swept)
    if place.carpet is not None and place.carpet.shape == plan.cells.shape:
        _tint(colours, free & place.carpet, QColor(theme.carpet))
    if place.cliff is not None and place.cliff.shape == plan.cells.shape:
        rows, columns = np.nonzero(free & place.cliff)
        striped = (rows + columns) * plan.resolution % STRIPES < 0.5 * STRIPES
        colours[rows[striped], columns[striped]] = _rgb(theme.cliff)
    rows, columns = colours.shape
    top_first = np.ascontiguousarray(colours[::-1])
    return QImage(top_first.data, columns, rows, 4 * columns, QImage.Format_RGB32).copy()


def _rgb(colour: str) -> int:
    return int(QColor(colour).rgb())


def _tint(colours: Array, where: Array, tint: QColor) -> None:
    """Lay a colour that shines through over some cells."""
    alpha = tint.alphaF()
    chosen = colours[where]
    mixed = np.full(chosen.shape, 0xff000000, np.uint32)
    for shift, value in ((16, tint.red()), (8, tint.green()), (0, tint.blue())):
        below = (chosen >> np.uint32(shift)) & np.uint32(0xff)
        mixed |= (below * (1.0 - alpha) + value * alpha).astype(np.uint32) << np.uint32(shift)
    colours[where] = mixed


def _scaled(cells: QImage, plan: Grid, view: ViewTransform, theme: Theme) -> QImage:
    """The part of the floor that a view shows, at its size."""
    picture = QImage(max(int(view.width), 1), max(int(view.height), 1), QImage.Format_RGB32)
    picture.fill(QColor(theme.background))
    box = plan.box
    (left, top), (right, bottom) = view.to_pixel(box.left, box.top), view.to_pixel(box.right, box.bottom)
    target = QRectF(left, top, right - left, bottom - top)
    side = plan.resolution * view.scale
    painter = QPainter(picture)
    if side < COARSE:  # else every other cell would be left out
        cells = cells.scaled(max(round(target.width()), 1), max(round(target.height()), 1), Qt.IgnoreAspectRatio,
                             Qt.SmoothTransformation)
    painter.setRenderHint(QPainter.SmoothPixmapTransform, side < CRISP)
    painter.drawImage(target, cells, QRectF(cells.rect()))
    painter.end()
    return picture


class PathPainter:
    """Keeps the paths as they were painted last, and adds only what is new."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self._content: object = None
        self._picture: Optional[QImage] = None
        self._drawn: Dict[str, int] = {}

    def paint(self, painter: QPainter, snapshot: Snapshot, view: ViewTransform, theme: Theme) -> None:
        """Paint the paths of all robots."""
        paths = {robot.name: robot.path for robot in snapshot.robots if robot.path is not None}
        content = (view, theme, tuple((name, path.number) for name, path in paths.items()))
        if content != self._content:
            self._content, self._drawn = content, {}
            self._picture = QImage(max(int(view.width), 1), max(int(view.height), 1),
                                   QImage.Format_ARGB32_Premultiplied)
            self._picture.fill(Qt.transparent)
        for name, path in paths.items():
            self._add(name, path, view, theme)
        if paths:
            painter.drawImage(0, 0, self._picture)

    def _add(self, name: str, path: Path, view: ViewTransform, theme: Theme) -> None:
        first = max(self._drawn.get(name, 0) - 1, 0)  # from the last point that was drawn
        if len(path.points) - first < 2 or self._drawn.get(name) == len(path.points):
            return
        self._drawn[name] = len(path.points)
        colour = QColor(robot_colour(theme, name))
        colour.setAlpha(PATH_ALPHA)
        painter = QPainter(self._picture)
        painter.setRenderHint(QPainter.Antialiasing)
        painter.setCompositionMode(QPainter.CompositionMode_Source)  # where lines cross they do not add up
        painter.setPen(QPen(colour, PATH_WIDTH, Qt.SolidLine, Qt.SquareCap, Qt.BevelJoin))
        for line in _lines(path.points[first:], view):
            painter.drawPolyline(QPolygonF([QPointF(x, y) for x, y in line.tolist()]))
        painter.end()


def _lines(points: Array, view: ViewTransform) -> Iterator[Array]:
    """Corners (n, 2) [pixels] of the lines between rows of NaN, but for those that are close to the one before."""
    pixels = np.stack(view.to_pixel(points[:, 0], points[:, 1]), axis=1)
    for line in np.split(pixels, np.flatnonzero(np.isnan(points[:, 0]))):
        line = line[~np.isnan(line[:, 0])]
        if len(line) > 1:
            way = np.cumsum(np.hypot(*np.diff(line, axis=0).T)) // CORNERS
            keep = np.concatenate([[True], way[1:] != way[:-1], [True]])
            yield line[keep]
