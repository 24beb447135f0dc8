"""Paints a snapshot: the floor and everything on it, in the window or as a picture."""

import math
from typing import Optional, Tuple

from PyQt5.QtCore import QPointF, QRectF, Qt
from PyQt5.QtGui import QColor, QFont, QImage, QPainter, QPen

from rumba_sim.model.common.geometry import Pose
from rumba_viewer.painting import paint_robot
from rumba_viewer.painting.paint_belief import paint_believed, paint_particles
from rumba_viewer.painting.paint_floor import FloorPainter, PathPainter, PlanPainter
from rumba_viewer.painting.paint_key import paint_key
from rumba_viewer.painting.paint_obstacles import paint_obstacles
from rumba_viewer.scene.snapshot import Snapshot
from rumba_viewer.scene.theme import Theme, robot_colour
from rumba_viewer.scene.view_transform import ViewTransform

SCALE_BAR = 130.0  # [pixels] at most
LABEL_GAP = 4.0  # [pixels] from a robot to its name
TARGET = 9.0  # [pixels] radius of the mark of a target


class ScenePainter:
    """Paints one snapshot after another; what did not change is not painted again.

    Attributes:
        shows_path: whether to paint the paths of robots, driven and planned.
        shows_field: whether to paint the area in which the dock is received.
    """

    def __init__(self) -> None:
        """Start with nothing painted."""
        self.shows_path = self.shows_field = True
        self._floor, self._plans, self._paths = FloorPainter(), PlanPainter(), PathPainter()

    def paint(self, painter: QPainter, snapshot: Snapshot, view: ViewTransform, theme: Theme,
              ghost: Optional[Tuple[str, Pose]] = None) -> None:
        """Paint a snapshot.

        Args:
            painter: what to paint with; its unit is the pixel.
            snapshot: what to paint.
            view: the part of the map to show, and its scale.
            theme: colours.
            ghost: name of a robot that is being dragged, and the pose to which it is dragged.
        """
        painter.setRenderHint(QPainter.Antialiasing)
        painter.fillRect(QRectF(0.0, 0.0, view.width, view.height), QColor(theme.background))
        if snapshot.plan is not None:
            self._floor.paint(painter, snapshot, view, theme)
            self._paint_things(painter, snapshot, view, theme, ghost)
            _paint_names(painter, snapshot, view, theme)
            _paint_target(painter, snapshot, view, theme)
            right = _paint_scale_bar(painter, view, theme)
            if snapshot.coverage is not None:
                paint_key(painter, right + 8.0, view.width, view.height, theme, snapshot.known is not None,
                          snapshot.features)
        if snapshot.missing:
            _paint_missing(painter, snapshot, view, theme)

    def _paint_things(self, painter: QPainter, snapshot: Snapshot, view: ViewTransform, theme: Theme,
                      ghost: Optional[Tuple[str, Pose]]) -> None:
        if self.shows_field:
            painter.save()
            paint_robot.in_metres(painter, view)
            for dock in snapshot.features.docks:
                paint_robot.paint_dock_field(painter, dock, theme)
            painter.restore()
        if self.shows_path:
            self._plans.paint(painter, snapshot, view, theme)
            self._paths.paint(painter, snapshot, view, theme)
        painter.save()
        paint_robot.in_metres(painter, view)
        paint_obstacles(painter, snapshot.obstacles, theme)
        for robot in snapshot.robots:
            paint_robot.paint_beams(painter, robot, theme)
            paint_particles(painter, robot, theme)
        for dock in snapshot.features.docks:
            paint_robot.paint_dock(painter, dock, _size(snapshot), theme)
        for robot in snapshot.robots:
            is_selected = robot.name == snapshot.selected and len(snapshot.robots) > 1
            paint_robot.paint_robot(painter, robot, view, theme, is_selected)
            paint_believed(painter, robot, theme)
            if ghost is not None and ghost[0] == robot.name:
                paint_robot.paint_ghost(painter, robot, ghost[1], theme)
        painter.restore()


def picture(snapshot: Snapshot, view: ViewTransform, theme: Theme) -> QImage:
    """A snapshot as a picture of the view's size."""
    image = QImage(int(view.width), int(view.height), QImage.Format_RGB32)
    painter = QPainter(image)
    ScenePainter().paint(painter, snapshot, view, theme)
    painter.end()
    return image


def _size(snapshot: Snapshot) -> float:
    """Radius of the robots [m]."""
    return snapshot.robots[0].size.radius if snapshot.robots else 0.0


def _paint_names(painter: QPainter, snapshot: Snapshot, view: ViewTransform, theme: Theme) -> None:
    """The names of the robots, if there are several."""
    if len(snapshot.robots) < 2:
        return
    painter.save()
    font = QFont(painter.font())
    font.setBold(True)
    painter.setFont(font)
    for robot in snapshot.robots:
        x, y = view.to_pixel(robot.pose.x, robot.pose.y)
        below = y + max(1.3 * robot.size.radius * view.scale, paint_robot.SMALL) + LABEL_GAP
        area = painter.boundingRect(QRectF(x - 100.0, below, 200.0, 40.0), Qt.AlignHCenter | Qt.AlignTop, robot.name)
        painter.setPen(Qt.NoPen)
        painter.setBrush(_transparent(theme.card, 200))
        painter.drawRoundedRect(area.adjusted(-4.0, 0.0, 4.0, 0.0), 3.0, 3.0)
        painter.setPen(QColor(robot_colour(robot.name)))
        painter.drawText(area, Qt.AlignCenter, robot.name)
    painter.restore()


def _paint_target(painter: QPainter, snapshot: Snapshot, view: ViewTransform, theme: Theme) -> None:
    """Cross hairs where robots go, in their colours, with a ring around the one that is chosen and not sent yet."""
    for robot in snapshot.robots:
        if robot.going_to is not None:
            here = QPointF(*view.to_pixel(robot.pose.x, robot.pose.y))
            there = QPointF(*view.to_pixel(*robot.going_to))
            painter.setPen(QPen(QColor(robot_colour(robot.name)), 1.5, Qt.DashLine))
            painter.drawLine(here, there)
            _paint_mark(painter, there, theme, robot_colour(robot.name), has_ring=False)
    if snapshot.target is not None:
        _paint_mark(painter, QPointF(*view.to_pixel(*snapshot.target)), theme,
                    robot_colour(snapshot.selected), has_ring=True)


def _paint_mark(painter: QPainter, at: QPointF, theme: Theme, colour: str, has_ring: bool) -> None:
    painter.save()
    painter.setBrush(Qt.NoBrush)
    for stroke, width in ((theme.card, 6.0), (colour, 2.5)):
        painter.setPen(QPen(QColor(stroke), width, Qt.SolidLine, Qt.RoundCap))
        if has_ring:
            painter.drawEllipse(at, TARGET, TARGET)
        for x, y in ((TARGET, 0.0), (-TARGET, 0.0), (0.0, TARGET), (0.0, -TARGET)):
            painter.drawLine(QPointF(at.x() + 0.4 * x, at.y() + 0.4 * y), QPointF(at.x() + 1.7 * x, at.y() + 1.7 * y))
    painter.restore()


def _paint_scale_bar(painter: QPainter, view: ViewTransform, theme: Theme) -> float:
    """A bar whose length is a round number of metres, in the lower left corner; returns its right edge [pixels]."""
    most = SCALE_BAR / view.scale
    power = 10.0 ** math.floor(math.log10(most))
    length = next(step * power for step in (5.0, 2.0, 1.0) if step * power <= most)
    text = f'{length:g} m' if length >= 1.0 else f'{100.0 * length:g} cm'
    metrics = painter.fontMetrics()
    wide, high = max(length * view.scale, metrics.horizontalAdvance(text)) + 16.0, metrics.height() + 14.0
    box = QRectF(8.0, view.height - high - 8.0, wide, high)
    painter.setPen(Qt.NoPen)
    painter.setBrush(_transparent(theme.card, 200))
    painter.drawRoundedRect(box, 4.0, 4.0)
    painter.setPen(QPen(QColor(theme.text), 2.0))
    left, bottom = box.left() + 8.0, box.bottom() - 6.0
    painter.drawLine(QPointF(left, bottom), QPointF(left + length * view.scale, bottom))
    painter.drawText(box.adjusted(8.0, 2.0, -8.0, -8.0), Qt.AlignLeft | Qt.AlignTop, text)
    return box.right()


def _paint_missing(painter: QPainter, snapshot: Snapshot, view: ViewTransform, theme: Theme) -> None:
    """What the window waits for; the first line is the title."""
    title, _, rest = snapshot.missing.partition('\n')
    large, plain = QFont(painter.font()), QFont(painter.font())
    large.setPointSizeF(1.3 * plain.pointSizeF())
    large.setBold(True)
    area = QRectF(0.0, 0.0, min(view.width - 32.0, 460.0), view.height)
    wrapped = Qt.AlignHCenter | Qt.AlignTop | Qt.TextWordWrap
    painter.setFont(large)
    head = painter.boundingRect(area.adjusted(16.0, 0.0, -16.0, 0.0), wrapped, title)
    painter.setFont(plain)
    body = painter.boundingRect(area.adjusted(16.0, 0.0, -16.0, 0.0), wrapped, rest)
    area.setHeight(head.height() + body.height() + 42.0)
    area.moveCenter(QPointF(0.5 * view.width, 0.5 * view.height))
    painter.setPen(QPen(QColor(theme.line), 1.0))
    painter.setBrush(_transparent(theme.card, 240))
    painter.drawRoundedRect(area, 8.0, 8.0)
    inside = area.adjusted(16.0, 16.0, -16.0, -16.0)
    painter.setPen(QColor(theme.text))
    painter.setFont(large)
    painter.drawText(inside, wrapped, title)
    painter.setFont(plain)
    painter.setPen(QColor(theme.faint_text))
    painter.drawText(inside.adjusted(0.0, head.height() + 10.0, 0.0, 0.0), wrapped, rest)


def _transparent(colour: str, alpha: int) -> QColor:
    """A transparent colour; alpha is 0 to 255."""
    mixed = QColor(colour)
    mixed.setAlpha(alpha)
    return mixed
