"""Paints what the colours of the floor mean, at the lower edge."""

from typing import List, Sequence

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
    """Paint rows of patches with words, if the picture is wide enough for it.

    Args:
        painter: what to paint with.
        left: edge of the rows [pixels].
        width, height: of the picture [pixels].
        theme: colours.
        has_own_map: whether the floor shows what a robot's own map does not.
        features: of the map, which are named too.
    """
    there = features.carpet is not None, features.cliff is not None, bool(features.docks)
    entries = [*STATES, *([UNMAPPED] if has_own_map else []),
               *(entry for entry, is_there in zip(FEATURES, there) if is_there)]
    painter.save()
    font = QFont(painter.font())
    font.setPointSizeF(0.9 * font.pointSizeF())
    painter.setFont(font)
    metrics = QFontMetricsF(font)
    widths = [PATCH + 5.0 + metrics.horizontalAdvance(words) for _, words in entries]
    rows = _rows(widths, width - left - 8.0 - 2.0 * EDGE)
    if len(rows) == 1 or len(rows) == 2 and len(rows[0]) >= len(STATES):
        high = metrics.height() + 4.0
        wide = max(sum(widths[index] + GAP for index in row) for row in rows) - GAP + 2.0 * EDGE
        box = QRectF(left, height - high * len(rows) - 12.0, wide, high * len(rows) + 4.0)
        card = QColor(theme.card)
        card.setAlpha(225)
        painter.setPen(Qt.NoPen)
        painter.setBrush(card)
        painter.drawRoundedRect(box, 4.0, 4.0)
        for number, row in enumerate(rows):
            x = box.left() + EDGE
            for index in row:
                _paint_entry(painter, QRectF(x, box.top() + 2.0 + number * high, widths[index], high), theme,
                             *entries[index])
                x += widths[index] + GAP
    painter.restore()


def _rows(widths: Sequence[float], width: float) -> List[List[int]]:
    """The numbers of the entries in each row, in order; a row is no wider than a width [pixels], if it has several."""
    rows: List[List[int]] = [[]]
    for index in range(len(widths)):
        row = [*rows[-1], index]
        if len(row) > 1 and sum(widths[each] + GAP for each in row) - GAP > width:
            rows.append([index])
        else:
            rows[-1] = row
    return rows


def _paint_entry(painter: QPainter, area: QRectF, theme: Theme, colours: Sequence[str], words: str) -> None:
    painter.setPen(QPen(QColor(theme.faint_text), 1.0))
    for colour in colours:
        shade = QColor(theme.veil if colour == 'veil' else getattr(theme.floor, colour))
        painter.setBrush(QBrush(shade, PATTERNS.get(colour, Qt.SolidPattern)))
        painter.drawRect(QRectF(area.left(), area.center().y() - 0.5 * PATCH, PATCH, PATCH))
    painter.setPen(QColor(theme.text))
    painter.drawText(area.adjusted(PATCH + 5.0, 0.0, 2.0, 0.0), Qt.AlignLeft | Qt.AlignVCenter, words)
