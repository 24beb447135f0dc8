"""Paints where a robot believes to be, beside where it is. The unit of the painter is the metre, y upward."""

import math

from PyQt5.QtCore import QPointF, Qt
from PyQt5.QtGui import QColor, QPainter, QPen, QPolygonF

from rumba_viewer.scene.snapshot import Robot
from rumba_viewer.scene.theme import Theme, robot_colour

DOT = 3.0  # [pixels] a particle
ALPHA = 130  # of a particle, 0 to 255
RING = 1.12  # radii of a robot: the ring stays visible around a robot that believes the truth


def paint_particles(painter: QPainter, robot: Robot, theme: Theme) -> None:
    """Paint a dot for each place where a robot may be."""
    if robot.particles is None or len(robot.particles) == 0:
        return
    colour = QColor(robot_colour(robot.name))
    colour.setAlpha(ALPHA)
    pen = QPen(colour, DOT, Qt.SolidLine, Qt.RoundCap)
    pen.setCosmetic(True)
    painter.setPen(pen)
    painter.drawPoints(QPolygonF([QPointF(float(x), float(y)) for x, y in robot.particles]))


def paint_believed(painter: QPainter, robot: Robot, theme: Theme) -> None:
    """Paint a dashed ring with a heading where a robot believes to be."""
    if robot.believed is None:
        return
    painter.save()
    painter.translate(robot.believed.x, robot.believed.y)
    painter.rotate(math.degrees(robot.believed.theta))
    pen = QPen(QColor(robot_colour(robot.name)), 2.0, Qt.DashLine)
    pen.setCosmetic(True)
    painter.setPen(pen)
    painter.setBrush(Qt.NoBrush)
    radius = RING * robot.size.radius
    painter.drawEllipse(QPointF(0.0, 0.0), radius, radius)
    painter.drawLine(QPointF(radius, 0.0), QPointF(1.5 * radius, 0.0))
    painter.restore()
