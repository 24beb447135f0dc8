"""Paints the floor: walls, carpet, cliffs, what is swept and what is not, and the paths of robots.

Each layer is drawn at the size of the picture once, and kept until its content or the view changes.
"""

from typing import Any, Dict, Iterator, List, Optional, Sequence, Tuple

import numpy as np
from PyQt5.QtCore import QPointF, QRectF, Qt
from PyQt5.QtGui import QColor, QImage, QPainter, QPen, QPolygonF

from rumba_sim.model.maps.floor_colours import DOTS, STRIPES, FloorColours
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, UNKNOWN
from rumba_viewer.scene.snapshot import Array, Grid, MapFeatures, Path, Snapshot
from rumba_viewer.scene.theme import Theme, line_colour
from rumba_viewer.scene.view_transform import ViewTransform

CRISP = 4.0  # [pixels] side of a cell; larger cells are drawn with sharp edges
COARSE = 0.5  # [pixels] side of a cell; smaller cells are averaged
PATH_WIDTH = 2.0  # [pixels]; thinner lines are nowhere as dark as their colour
PLAN_WIDTH = 2.0  # [pixels]
MIN_SEGMENT = 4.0  # [pixels] from one corner of a path to the next
SHADES = 101  # of a cell, from 0 to 100 % swept


class FloorPainter:
    """Paints floors, and keeps the last picture of one."""

    def __init__(self) -> None:
        """Start with no picture."""
        self._cells: Tuple[object, QImage] = (None, QImage())
        self._view: Tuple[object, QImage] = (None, QImage())

    def paint(self, painter: QPainter, snapshot: Snapshot, view: ViewTransform, theme: Theme) -> None:
        """Paint the floor of a snapshot that has a plan."""
        plan, known, coverage, features = snapshot.plan, snapshot.known, snapshot.coverage, snapshot.features
        assert plan is not None
        content = (plan.number, known and known.number, coverage and coverage.number, id(features), theme)
        if self._cells[0] != content:
            self._cells = content, floor_image(plan, known, coverage, features, theme)
        if self._view[0] != (content, view):
            self._view = (content, view), _scaled(self._cells[1], plan, view, theme)
        painter.drawImage(0, 0, self._view[1])


def floor_image(plan: Grid, known: Optional[Grid], coverage: Optional[Grid], features: MapFeatures,
                theme: Theme) -> QImage:
    """The floor with one pixel for each cell; the top row has the highest y. What is not `known` is faint."""
    floor = theme.floor
    colours = np.full(plan.cells.shape, _rgb(floor.unknown), np.uint32)
    free = plan.cells == FREE
    colours[plan.cells == OCCUPIED] = _rgb(floor.wall)
    colours[free] = _rgb(floor.swept)
    if coverage is not None:
        _stripe(colours, free, plan.resolution, floor.out_of_reach, floor.stripe)
    if coverage is not None and coverage.cells.shape == plan.cells.shape:
        is_known = free & (coverage.cells >= 0) & (coverage.cells < SHADES)
        colours[is_known] = _shades(QColor(floor.to_sweep), QColor(floor.swept))[coverage.cells[is_known]]
    if features.carpet is not None and features.carpet.shape == plan.cells.shape:
        _dot(colours, free & features.carpet, plan.resolution, floor)
    if features.cliff is not None and features.cliff.shape == plan.cells.shape:
        _stripe(colours, free & features.cliff, plan.resolution, floor.cliff, floor.drop)
    if known is not None:
        _tint(colours, (known.cells == UNKNOWN) | (plan.cells == OCCUPIED), QColor(theme.veil))
        colours[known.cells == OCCUPIED] = _rgb(floor.wall)
    height, width = colours.shape
    pixels: Any = np.ascontiguousarray(colours[::-1]).data
    return QImage(pixels, width, height, 4 * width, QImage.Format_RGB32).copy()  # which owns its pixels


def _shades(none: QColor, full: QColor) -> Array:
    """The colours from one to another in SHADES equal steps: uint32 (SHADES)."""
    ends = np.array([[none.red(), none.green(), none.blue()], [full.red(), full.green(), full.blue()]], np.float64)
    share = np.linspace(0.0, 1.0, SHADES)[:, np.newaxis]
    red, green, blue = np.rint(ends[0] + share * (ends[1] - ends[0])).astype(np.uint32).T
    return np.asarray(0xff000000 | red << 16 | green << 8 | blue, np.uint32)


def _rgb(colour: str) -> int:
    return int(QColor(colour).rgb())


def _stripe(colours: Array, cells: Array, resolution: float, one: str, other: str) -> None:
    """Fill some cells of a size [m] with stripes of two colours."""
    rows, columns = np.nonzero(cells)
    is_one = (rows + columns) * resolution % STRIPES < 0.5 * STRIPES
    colours[rows, columns] = np.where(is_one, np.uint32(_rgb(one)), np.uint32(_rgb(other)))


def _dot(colours: Array, cells: Array, resolution: float, floor: FloorColours) -> None:
    """Put dots of a carpet on some cells of a size [m]."""
    apart = max(round(DOTS / resolution), 2)
    dots = np.zeros(cells.shape, bool)
    dots[::apart, ::apart] = True
    colours[cells & dots] = _rgb(floor.carpet)


def _tint(colours: Array, cells: Array, tint: QColor) -> None:
    """Mix a transparent colour into the colours of some cells."""
    alpha = tint.alphaF()
    chosen = colours[cells]
    mixed = np.full(chosen.shape, 0xff000000, np.uint32)
    for shift, value in ((16, tint.red()), (8, tint.green()), (0, tint.blue())):
        below = (chosen >> np.uint32(shift)) & np.uint32(0xff)
        mixed |= (below * (1.0 - alpha) + value * alpha).astype(np.uint32) << np.uint32(shift)
    colours[cells] = mixed


def _scaled(cells: QImage, plan: Grid, view: ViewTransform, theme: Theme) -> QImage:
    """The part of the floor that a view shows, at the size of the view."""
    picture = QImage(max(int(view.width), 1), max(int(view.height), 1), QImage.Format_RGB32)
    picture.fill(QColor(theme.background))
    box = plan.box
    (left, top), (right, bottom) = view.to_pixel(box.left, box.top), view.to_pixel(box.right, box.bottom)
    target = QRectF(left, top, right - left, bottom - top)
    side = plan.resolution * view.scale
    painter = QPainter(picture)
    if side < COARSE:  # QPainter would leave out whole cells
        cells = cells.scaled(max(round(target.width()), 1), max(round(target.height()), 1), Qt.IgnoreAspectRatio,
                             Qt.SmoothTransformation)
    painter.setRenderHint(QPainter.SmoothPixmapTransform, side < CRISP)
    painter.drawImage(target, cells, QRectF(cells.rect()))
    painter.end()
    return picture


class PathPainter:
    """Paints paths: keeps the last picture of them and adds only what is new."""

    def __init__(self) -> None:
        """Start with no picture."""
        self._content: object = None
        self._picture = QImage()
        self._drawn: Dict[str, int] = {}

    def paint(self, painter: QPainter, snapshot: Snapshot, view: ViewTransform, theme: Theme) -> None:
        """Paint the paths of all robots."""
        paths = {robot.name: robot.path for robot in snapshot.robots if robot.path is not None}
        content = (view, theme, tuple((name, path.number) for name, path in paths.items()))
        if content != self._content:
            self._content, self._drawn = content, {}
            self._picture = _blank(view)
        for name, path in paths.items():
            self._add(name, path, view, theme)
        if paths:
            painter.drawImage(0, 0, self._picture)

    def _add(self, name: str, path: Path, view: ViewTransform, theme: Theme) -> None:
        first = max(self._drawn.get(name, 0) - 1, 0)  # start at the last point that was drawn
        if len(path.points) - first < 2 or self._drawn.get(name) == len(path.points):
            return
        self._drawn[name] = len(path.points)
        painter = QPainter(self._picture)
        painter.setRenderHint(QPainter.Antialiasing)
        painter.setCompositionMode(QPainter.CompositionMode_Source)  # so that crossings are not darker
        painter.setPen(QPen(QColor(line_colour(theme, name)), PATH_WIDTH, Qt.SolidLine, Qt.SquareCap, Qt.BevelJoin))
        for line in _lines(path.points[first:], view):
            painter.drawPolyline(QPolygonF([QPointF(x, y) for x, y in line.tolist()]))
        painter.end()


class PlanPainter:
    """Paints planned paths, dashed: keeps the last picture of them, since dashes take longer than all else."""

    def __init__(self) -> None:
        """Start with no picture."""
        self._content: object = None
        self._planned: List[Tuple[str, Array]] = []  # kept, so that nothing else gets the identity of its arrays
        self._picture = QImage()

    def paint(self, painter: QPainter, snapshot: Snapshot, view: ViewTransform, theme: Theme) -> None:
        """Paint the planned paths of all robots."""
        planned = [(robot.name, robot.planned) for robot in snapshot.robots if robot.planned is not None]
        content = view, theme, [(name, id(points)) for name, points in planned]
        if content != self._content:
            self._content, self._planned, self._picture = content, planned, _dashed(planned, view, theme)
        if planned:
            painter.drawImage(0, 0, self._picture)


def _dashed(planned: Sequence[Tuple[str, Array]], view: ViewTransform, theme: Theme) -> QImage:
    """Paths of robots, by their names, on a transparent picture."""
    picture = _blank(view)
    painter = QPainter(picture)
    painter.setRenderHint(QPainter.Antialiasing)
    for name, points in planned:
        painter.setPen(QPen(QColor(line_colour(theme, name)), PLAN_WIDTH, Qt.DashLine))
        for line in _lines(points, view):
            painter.drawPolyline(QPolygonF([QPointF(x, y) for x, y in line.tolist()]))
    painter.end()
    return picture


def _blank(view: ViewTransform) -> QImage:
    """A transparent picture of a view."""
    picture = QImage(max(int(view.width), 1), max(int(view.height), 1), QImage.Format_ARGB32_Premultiplied)
    picture.fill(Qt.transparent)
    return picture


def _lines(points: Array, view: ViewTransform) -> Iterator[Array]:
    """Corners (n, 2) [pixels] of the lines between rows of NaN, without those that are close to the one before."""
    pixels = np.stack(view.to_pixel(points[:, 0], points[:, 1]), axis=1)
    for line in np.split(pixels, np.flatnonzero(np.isnan(points[:, 0]))):
        line = line[~np.isnan(line[:, 0])]
        if len(line) > 1:
            segment = np.cumsum(np.hypot(*np.diff(line, axis=0).T)) // MIN_SEGMENT
            keep = np.concatenate([[True], segment[1:] != segment[:-1], [True]])
            yield line[keep]
