"""Paints the report of a mission that has ended, over the floor."""

from typing import Sequence

from PyQt5.QtCore import QRectF, Qt
from PyQt5.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen

from rumba_viewer.scene.theme import Theme

MOST = 520.0  # [pixels] width of the text
EDGE = 14.0  # [pixels] around it
HIDE = 'Click here, or Esc: hide this.'


WRAPPED = Qt.AlignLeft | Qt.AlignTop | Qt.TextWordWrap


class ReportCard:
    """A card at the upper edge of a picture.

    Attributes:
        area: where it is [pixels].
    """

    def __init__(self, font: QFont, lines: Sequence[str], hint: str, width: float) -> None:
        """Lay out lines with a hint at their end, for a picture of a width [pixels]."""
        bold = QFont(font)
        bold.setBold(True)
        inside = QRectF(0.0, 0.0, min(width - 24.0 - 2.0 * EDGE, MOST), 1000.0)
        self._parts = [(bold, 'text', lines[0]), (font, 'text', '\n'.join(lines[1:])),
                       (font, 'faint_text', f'{hint}\n{HIDE}')]
        self._heights = [QFontMetricsF(font).boundingRect(inside, WRAPPED, text).height() + 5.0
                         for font, _, text in self._parts]
        self.area = QRectF(0.5 * (width - inside.width()) - EDGE, 12.0, inside.width() + 2.0 * EDGE,
                           sum(self._heights) + 2.0 * EDGE)

    def paint(self, painter: QPainter, theme: Theme) -> None:
        """Paint it."""
        painter.save()
        painter.setPen(QPen(QColor(theme.line), 1.0))
        painter.setBrush(QColor(theme.card))
        painter.drawRoundedRect(self.area, 8.0, 8.0)
        row = self.area.adjusted(EDGE, EDGE, -EDGE, -EDGE)
        for (font, colour, text), height in zip(self._parts, self._heights):
            painter.setFont(font)
            painter.setPen(QColor(getattr(theme, colour)))
            painter.drawText(row, WRAPPED, text)
            row.setTop(row.top() + height)
        painter.restore()
