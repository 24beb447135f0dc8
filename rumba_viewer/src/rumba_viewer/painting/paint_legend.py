"""Paints the list of what keys and mouse do, over the floor."""

from PyQt5.QtCore import QPointF, QRectF, Qt
from PyQt5.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen

from rumba_viewer.scene.acts import legend
from rumba_viewer.scene.theme import Theme

GAP, EDGE = 16.0, 18.0  # [pixels] between the columns; around the rows


def paint_legend(painter: QPainter, width: float, height: float, theme: Theme) -> None:
    """Paint all rows into the middle of a picture, smaller if they would not fit."""
    rows = legend()
    bold = QFont(painter.font())
    bold.setBold(True)
    heads, texts = QFontMetricsF(bold), QFontMetricsF(painter.font())
    left = max(heads.horizontalAdvance(keys) for keys, _ in rows)
    right = max(texts.horizontalAdvance(text) for _, text in rows)
    line = texts.height() + 3.0
    box = QRectF(0.0, 0.0, left + GAP + right + 2.0 * EDGE, len(rows) * line + 2.0 * EDGE)
    scale = min(1.0, (width - 8.0) / box.width(), (height - 8.0) / box.height())
    painter.save()
    painter.translate(0.5 * (width - scale * box.width()), 0.5 * (height - scale * box.height()))
    painter.scale(scale, scale)
    card = QColor(theme.card)
    card.setAlpha(240)
    painter.setPen(QPen(QColor(theme.line), 1.0))
    painter.setBrush(card)
    painter.drawRoundedRect(box, 8.0, 8.0)
    plain = QFont(painter.font())
    for index, (keys, text) in enumerate(rows):
        y = EDGE + index * line
        painter.setFont(bold)
        painter.setPen(QColor(theme.text))
        painter.drawText(QRectF(EDGE, y, left, line), Qt.AlignRight | Qt.AlignVCenter, keys)
        painter.setFont(plain)
        painter.setPen(QColor(theme.faint_text))
        painter.drawText(QRectF(EDGE + left + GAP, y, right + 2.0, line), Qt.AlignLeft | Qt.AlignVCenter, text)
    painter.setPen(QPen(QColor(theme.line), 1.0))
    middle = EDGE + left + 0.5 * GAP
    painter.drawLine(QPointF(middle, EDGE), QPointF(middle, box.height() - EDGE))
    painter.restore()
