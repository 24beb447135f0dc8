"""Icons of buttons, drawn in the colour of their text."""

from typing import Callable, Dict

from PyQt5.QtCore import QPointF, QRectF, Qt
from PyQt5.QtGui import QColor, QIcon, QPainter, QPixmap, QPolygonF

SIDE = 32  # [pixels] of the picture of an icon; buttons show it smaller
RED = '#d13b32'


def _play(painter: QPainter) -> None:
    painter.drawPolygon(QPolygonF([QPointF(8.0, 5.0), QPointF(27.0, 16.0), QPointF(8.0, 27.0)]))


def _pause(painter: QPainter) -> None:
    painter.drawRect(QRectF(7.0, 5.0, 6.5, 22.0))
    painter.drawRect(QRectF(18.5, 5.0, 6.5, 22.0))


def _step(painter: QPainter) -> None:
    painter.drawPolygon(QPolygonF([QPointF(5.0, 5.0), QPointF(21.0, 16.0), QPointF(5.0, 27.0)]))
    painter.drawRect(QRectF(22.0, 5.0, 5.0, 22.0))


def _stop(painter: QPainter) -> None:
    painter.drawRect(QRectF(6.0, 6.0, 20.0, 20.0))


def _record(painter: QPainter) -> None:
    painter.setBrush(QColor(RED))
    painter.drawEllipse(QRectF(5.0, 5.0, 22.0, 22.0))


DRAWN: Dict[str, Callable[[QPainter], None]] = {
    'play': _play, 'pause': _pause, 'step': _step, 'stop': _stop, 'record': _record}


def icon(name: str, colour: QColor) -> QIcon:
    """An icon by its name, in a colour."""
    picture = QPixmap(SIDE, SIDE)
    picture.fill(Qt.transparent)
    painter = QPainter(picture)
    painter.setRenderHint(QPainter.Antialiasing)
    painter.setPen(Qt.NoPen)
    painter.setBrush(colour)
    DRAWN[name](painter)
    painter.end()
    return QIcon(picture)
