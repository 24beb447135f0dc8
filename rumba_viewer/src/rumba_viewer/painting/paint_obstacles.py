"""Paints obstacles that the map does not show. The unit of the painter is the metre, y upward."""

import math
from typing import Sequence

from PyQt5.QtCore import QPointF, QRectF
from PyQt5.QtGui import QColor, QPainter, QPen

from rumba_viewer.scene.snapshot import Obstacle
from rumba_viewer.scene.theme import Theme

LOW = 0.45  # opacity of an obstacle that the laser does not see
EDGE = 1.0  # [pixels]


def paint_obstacles(painter: QPainter, obstacles: Sequence[Obstacle], theme: Theme) -> None:
    """Paint obstacles true to scale; those that are lower than the laser are lighter."""
    painter.save()
    pen = QPen(QColor(theme.body_edge), EDGE)
    pen.setCosmetic(True)
    painter.setPen(pen)
    painter.setBrush(QColor(theme.floor.obstacle))
    for obstacle in obstacles:
        painter.save()
        painter.setOpacity(LOW if obstacle.is_low else 1.0)
        painter.translate(QPointF(obstacle.pose.x, obstacle.pose.y))
        painter.rotate(math.degrees(obstacle.pose.theta))
        outline = QRectF(-0.5 * obstacle.length, -0.5 * obstacle.width, obstacle.length, obstacle.width)
        if obstacle.is_round:
            painter.drawEllipse(outline)
        else:
            painter.drawRect(outline)
        painter.restore()
    painter.restore()
