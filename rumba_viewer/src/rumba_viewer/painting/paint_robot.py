"""Paints robots true to scale, their laser beams, and the dock. The unit of the painter is the metre, y upward."""

import math
from typing import Sequence

from PyQt5.QtCore import QPointF, QRectF, Qt
from PyQt5.QtGui import QBrush, QColor, QPainter, QPen, QPolygonF

from rumba_sim.model.common.geometry import Pose
from rumba_viewer.scene.snapshot import Dock, Robot
from rumba_viewer.scene.theme import Theme, robot_colour
from rumba_viewer.scene.view_transform import ViewTransform

SMALL = 9.0  # [pixels] radius of the ring around a robot that is smaller in the picture
BUMPER = 65.0  # [degrees] to each side of the front that the bumper covers
LEFT, RIGHT = (0.0, BUMPER), (-BUMPER, 0.0)
DOCK_DEPTH, DOCK_WIDTH = 0.07, 0.28  # [m]
GHOST = 0.45  # opacity of a robot that is being dragged


def in_metres(painter: QPainter, view: ViewTransform) -> None:
    """Make a painter use the coordinates of the map."""
    painter.translate(0.5 * view.width, 0.5 * view.height)
    painter.scale(view.scale, -view.scale)
    painter.translate(-view.x, -view.y)


def paint_dock_field(painter: QPainter, dock: Dock, theme: Theme) -> None:
    """Paint the area in which the beams of a dock are received."""
    painter.setPen(Qt.NoPen)
    for corners, colour in ((dock.field, theme.field), (dock.halo, theme.halo)):
        painter.setBrush(QColor(colour))
        painter.drawPolygon(_polygon(corners))


def paint_dock(painter: QPainter, dock: Dock, radius: float, theme: Theme) -> None:
    """Paint the dock itself, in front of a docked robot of a radius [m]."""
    painter.save()
    _into(painter, dock.pose)
    painter.setPen(_pen(theme.body_edge, 1.0))
    painter.setBrush(QColor(theme.floor.dock))
    painter.drawRoundedRect(QRectF(radius - 0.6 * DOCK_DEPTH, -0.5 * DOCK_WIDTH, DOCK_DEPTH, DOCK_WIDTH), 0.02, 0.02)
    painter.restore()


def paint_beams(painter: QPainter, robot: Robot, theme: Theme) -> None:
    """Paint what the laser of a robot measures."""
    if robot.beams is None or len(robot.beams) == 0:
        return
    painter.setPen(_pen(theme.laser_edge, 1.0))
    painter.setBrush(QColor(theme.laser))
    painter.drawPolygon(_polygon(robot.beams))


def paint_robot(painter: QPainter, robot: Robot, view: ViewTransform, theme: Theme, is_selected: bool) -> None:
    """Paint a robot: body, bumper, brush, heading; a red cross over one that has fallen."""
    colour = QColor(robot_colour(robot.name))
    painter.save()
    _into(painter, robot.pose)
    radius = robot.size.radius
    _ring(painter, radius, view, colour, is_selected)
    painter.setPen(_pen(theme.body_edge, 1.0))
    painter.setBrush(QColor(theme.body))
    painter.drawEllipse(QPointF(0.0, 0.0), radius, radius)
    for span, is_pressed in ((LEFT, robot.bumper[0]), (RIGHT, robot.bumper[1])):
        _bumper(painter, radius, span, QColor(theme.bad) if is_pressed else colour, is_pressed)
    _brush(painter, robot, theme)
    painter.setPen(Qt.NoPen)
    painter.setBrush(colour)
    painter.drawPolygon(_polygon(((0.7 * radius, 0.0), (0.2 * radius, 0.4 * radius), (0.2 * radius, -0.4 * radius))))
    if robot.has_fallen:
        _cross(painter, radius, theme)
    painter.restore()


def paint_ghost(painter: QPainter, robot: Robot, pose: Pose, theme: Theme) -> None:
    """Paint the pose to which a robot is being dragged."""
    painter.save()
    _into(painter, pose)
    painter.setOpacity(GHOST)
    painter.setPen(Qt.NoPen)
    painter.setBrush(QColor(robot_colour(robot.name)))
    radius = robot.size.radius
    painter.drawEllipse(QPointF(0.0, 0.0), radius, radius)
    painter.setOpacity(1.0)
    painter.setPen(_pen(theme.body, 2.0))
    painter.drawLine(QPointF(0.0, 0.0), QPointF(radius, 0.0))
    painter.restore()


def _ring(painter: QPainter, radius: float, view: ViewTransform, colour: QColor, is_selected: bool) -> None:
    """A ring around the selected robot, and around one that is too small to be seen."""
    if is_selected or radius * view.scale < SMALL:
        painter.setPen(_pen(colour, 2.0))
        painter.setBrush(Qt.NoBrush)
        wide = max(1.22 * radius, SMALL / view.scale)
        painter.drawEllipse(QPointF(0.0, 0.0), wide, wide)


def _bumper(painter: QPainter, radius: float, span: Sequence[float], colour: QColor, is_pressed: bool) -> None:
    """Half of the bumper; Qt measures angles clockwise if y points upward."""
    painter.setPen(QPen(colour, (0.3 if is_pressed else 0.16) * radius, Qt.SolidLine, Qt.FlatCap))
    painter.setBrush(Qt.NoBrush)
    inner = 0.9 * radius
    painter.drawArc(QRectF(-inner, -inner, 2.0 * inner, 2.0 * inner), round(-16 * span[1]),
                    round(16 * (span[1] - span[0])))


def _brush(painter: QPainter, robot: Robot, theme: Theme) -> None:
    """A bar as wide as the brush: filled while it cleans, a frame while it is lifted, none if unknown."""
    if robot.brushes_up is None:
        return
    wide, thick = robot.size.brush, 0.2 * robot.size.radius
    bar = QRectF(-0.5 * thick - 0.1 * robot.size.radius, -0.5 * wide, thick, wide)
    colour = QColor(theme.body_edge if robot.brushes_up else theme.lit)
    painter.setPen(_pen(colour, 1.0))
    painter.setBrush(QBrush(Qt.NoBrush) if robot.brushes_up else QBrush(colour))
    painter.drawRect(bar)


def _cross(painter: QPainter, radius: float, theme: Theme) -> None:
    """A red cross and ring over a robot that has fallen over a cliff."""
    painter.setPen(QPen(QColor(theme.bad), 0.22 * radius, Qt.SolidLine, Qt.RoundCap))
    painter.setBrush(Qt.NoBrush)
    painter.drawEllipse(QPointF(0.0, 0.0), radius, radius)
    reach = 0.6 * radius
    for side in (-1.0, 1.0):
        painter.drawLine(QPointF(-reach, -side * reach), QPointF(reach, side * reach))


def _into(painter: QPainter, pose: Pose) -> None:
    """Make a painter use the coordinates of a pose, x forward."""
    painter.translate(pose.x, pose.y)
    painter.rotate(math.degrees(pose.theta))


def _pen(colour: object, width: float) -> QPen:
    """A line of a width in pixels, whatever the unit of the painter is."""
    pen = QPen(QColor(colour), width)
    pen.setCosmetic(True)
    return pen


def _polygon(corners: Sequence[Sequence[float]]) -> QPolygonF:
    return QPolygonF([QPointF(float(x), float(y)) for x, y in corners])
