"""Paints the report of a mission that has ended, over the floor."""

from typing import Sequence

from PyQt5.QtCore import QRectF, Qt
from PyQt5.QtGui import QColor, QFont, QPainter, QPen

from rumba_viewer.scene.theme import Theme

MOST = 520.0  # [pixels] width of the text
EDGE = 14.0  # [pixels] around it
HIDE = 'Click here, or Esc: hide this.'


def paint_report(painter: QPainter, lines: Sequence[str], hint: str, width: float, theme: Theme) -> QRectF:
    """Paint a card at the upper edge of a picture of a width, with a hint at its end; returns where it is [pixels]."""
    painter.save()
    plain, bold = QFont(painter.font()), QFont(painter.font())
    bold.setBold(True)
    inside = QRectF(0.0, 0.0, min(width - 24.0 - 2.0 * EDGE, MOST), 1000.0)
    wrapped = Qt.AlignLeft | Qt.AlignTop | Qt.TextWordWrap
    parts = [(bold, theme.text, lines[0]), (plain, theme.text, '\n'.join(lines[1:])),
             (plain, theme.faint_text, f'{hint}\n{HIDE}')]
    heights = []
    for font, _, text in parts:
        painter.setFont(font)
        heights.append(painter.boundingRect(inside, wrapped, text).height() + 5.0)
    card = QRectF(0.5 * (width - inside.width()) - EDGE, 12.0, inside.width() + 2.0 * EDGE, sum(heights) + 2.0 * EDGE)
    painter.setPen(QPen(QColor(theme.line), 1.0))
    painter.setBrush(QColor(theme.card))
    painter.drawRoundedRect(card, 8.0, 8.0)
    row = card.adjusted(EDGE, EDGE, -EDGE, -EDGE)
    for (font, colour, text), height in zip(parts, heights):
        painter.setFont(font)
        painter.setPen(QColor(colour))
        painter.drawText(row, wrapped, text)
        row.setTop(row.top() + height)
    painter.restore()
    return card
