"""Paints what the colours of the floor mean, at the lower edge."""

from PyQt5.QtCore import QRectF, Qt
from PyQt5.QtGui import QBrush, QColor, QFont, QFontMetricsF, QPainter, QPen

from rumba_viewer.scene.snapshot import MapFeatures
from rumba_viewer.scene.theme import Theme

STATES = (('swept',), 'swept'), (('to_sweep',), 'still to sweep'), (('out_of_reach', 'stripe'), 'out of reach'), (
    ('wall',), 'wall')  # a colour, a second one over it, and what they mean
UNMAPPED = ('wall', 'veil'), 'not on its map'
FEATURES = (('swept', 'carpet'), 'carpet'), (('cliff', 'drop'), 'cliff'), (('dock',), 'dock')
PATTERNS = {'stripe': Qt.BDiagPattern, 'drop': Qt.BDiagPattern, 'carpet': Qt.Dense6Pattern}
PATCH, GAP, EDGE = 11.0, 12.0, 8.0  # [pixels] side of a patch; between two entries; around them


def paint_key(painter: QPainter, left: float, width: float, height: float, theme: Theme,
              has_own_map: bool = False, features: MapFeatures = MapFeatures()) -> None:
    """Paint a row of patches with words, if the picture is wide enough for it; else without features.

    Args:
        painter: what to paint with.
        left: edge of the row [pixels].
        width, height: of the picture [pixels].
        theme: colours.
        has_own_map: whether the floor shows what a robot's own map does not.
        features: of the map, which are named too.
    """
    states = [*STATES, UNMAPPED] if has_own_map else [*STATES]
    painter.save()
    font = QFont(painter.font())
    font.setPointSizeF(0.9 * font.pointSizeF())
    painter.setFont(font)
    metrics = QFontMetricsF(font)
    more = [*states, *(entry for entry, is_there in zip(FEATURES, (
        features.carpet is not None, features.cliff is not None, features.docks)) if is_there)]
    high = metrics.height() + 8.0
    for shown in (more, states):
        widths = [PATCH + 5.0 + metrics.horizontalAdvance(words) for _, words in shown]
        wide = sum(widths) + GAP * (len(shown) - 1) + 2.0 * EDGE
        if left + wide <= width - 8.0:
            break
    if left + wide <= width - 8.0:
        box = QRectF(left, height - high - 8.0, wide, high)
        card = QColor(theme.card)
        card.setAlpha(225)
        painter.setPen(Qt.NoPen)
        painter.setBrush(card)
        painter.drawRoundedRect(box, 4.0, 4.0)
        x = box.left() + EDGE
        for (colours, words), entry in zip(shown, widths):
            painter.setPen(QPen(QColor(theme.faint_text), 1.0))
            for colour in colours:
                shade = QColor(theme.veil if colour == 'veil' else getattr(theme.floor, colour))
                painter.setBrush(QBrush(shade, PATTERNS.get(colour, Qt.SolidPattern)))
                painter.drawRect(QRectF(x, box.center().y() - 0.5 * PATCH, PATCH, PATCH))
            painter.setPen(QColor(theme.text))
            painter.drawText(QRectF(x + PATCH + 5.0, box.top(), entry, high), Qt.AlignLeft | Qt.AlignVCenter, words)
            x += entry + GAP
    painter.restore()
