"""Paints what the colours of the floor mean, at the lower edge."""

from PyQt5.QtCore import QRectF, Qt
from PyQt5.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen

from rumba_viewer.scene.theme import Theme

STATES = (('swept', 'swept'), ('to_sweep', 'still to sweep'), ('out_of_reach', 'out of reach'), ('wall', 'wall'))
PATCH, GAP, EDGE = 11.0, 12.0, 8.0  # [pixels] side of a patch; between two entries; around them


def paint_key(painter: QPainter, left: float, width: float, height: float, theme: Theme) -> None:
    """Paint a row of patches with words from a left edge on, if the picture is wide enough for it [pixels]."""
    painter.save()
    font = QFont(painter.font())
    font.setPointSizeF(0.9 * font.pointSizeF())
    painter.setFont(font)
    metrics = QFontMetricsF(font)
    widths = [PATCH + 5.0 + metrics.horizontalAdvance(words) for _, words in STATES]
    wide, high = sum(widths) + GAP * (len(STATES) - 1) + 2.0 * EDGE, metrics.height() + 8.0
    if left + wide <= width - 8.0:
        box = QRectF(left, height - high - 8.0, wide, high)
        card = QColor(theme.card)
        card.setAlpha(225)
        painter.setPen(Qt.NoPen)
        painter.setBrush(card)
        painter.drawRoundedRect(box, 4.0, 4.0)
        x = box.left() + EDGE
        for (name, words), entry in zip(STATES, widths):
            painter.setPen(QPen(QColor(theme.faint_text), 1.0))
            painter.setBrush(QColor(getattr(theme, name)))
            painter.drawRect(QRectF(x, box.center().y() - 0.5 * PATCH, PATCH, PATCH))
            painter.setPen(QColor(theme.text))
            painter.drawText(QRectF(x + PATCH + 5.0, box.top(), entry, high), Qt.AlignLeft | Qt.AlignVCenter, words)
            x += entry + GAP
    painter.restore()
