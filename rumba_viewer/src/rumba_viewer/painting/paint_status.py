"""Paints the card of the selected robot: mission, battery, coverage, pose, time."""

import math
import re
from typing import Callable, List, Optional, Tuple

from PyQt5.QtCore import QPointF, QRectF, Qt
from PyQt5.QtGui import QColor, QFont, QFontMetricsF, QPainter

from rumba_sim.model.common.geometry import Pose
from rumba_viewer.scene.snapshot import YIELDING, Battery, Cleaning, Robot, Simulation, Snapshot
from rumba_viewer.scene.theme import Theme, robot_colour
from rumba_viewer.scene.wording import taken

BAR = 14.0  # [pixels] height of a bar
FALLEN = 'fallen'
EDGE, TOP = 12.0, 8.0  # [pixels] from the edges of the card to its text
PILL_GAP = 8.0  # [pixels] from the name to the pill
LINES = 12  # of small text
TWO_LINES = 1.8  # times the width of one, since lines end between words
LOW, CRITICAL = 0.25, 0.10  # charge, below which the bar is yellow, red
STATES = {'cleaning': 'good', 'charging': 'good', 'charged': 'good', YIELDING: 'warning', 'stranded': 'bad',
          FALLEN: 'bad'}
FIGURES = re.compile(r'[\d.]+ V, [\d.]+ A, ')
OWN_ACCOUNT = re.compile(r'^[\d.]+ % swept(; |$)')  # what the world measures stands below it: one figure is enough
FAR = 100.0  # [m] from which on a distance has no digits behind the point
UNKNOWN, MINUS = '-', '\u2212'
SLOW = 0.1  # [times real time] a lower speed is too few ticks to be measured in a second


def status_height(font: QFont) -> int:
    """Height of the card in a font [pixels]."""
    small, bold = (QFontMetricsF(one).height() for one in _fonts(font)[1:])
    return math.ceil(2.0 * TOP + (bold + 5.0) + LINES * (small + 1.0) + 2.0 * (bold + BAR + 7.0) + 3.0)


def _fonts(font: QFont) -> Tuple[QFont, QFont, QFont]:
    """The font, a smaller and a bold one."""
    small, bold = QFont(font), QFont(font)
    small.setPointSizeF(0.9 * font.pointSizeF())
    bold.setBold(True)
    return font, small, bold


def paint_status(painter: QPainter, area: QRectF, snapshot: Snapshot, theme: Theme) -> None:
    """Paint the card into an area that has the height of `status_height`."""
    painter.setRenderHint(QPainter.Antialiasing)
    painter.setPen(QColor(theme.line))
    painter.setBrush(QColor(theme.card))
    painter.drawRoundedRect(area.adjusted(0.5, 0.5, -0.5, -0.5), 6.0, 6.0)
    _Card(painter, area.adjusted(EDGE, TOP, -EDGE, -TOP), theme).paint(snapshot)


class _Card:
    """Writes from top to bottom."""

    def __init__(self, painter: QPainter, area: QRectF, theme: Theme) -> None:
        self._painter, self._area, self._theme = painter, area, theme
        _, self._small, self._bold = _fonts(painter.font())
        self._y = area.top()

    def paint(self, snapshot: Snapshot) -> None:
        robot = snapshot.robot
        self._title(snapshot.selected, robot)
        self._small_lines(_mission_text(robot))
        battery, cleaning = (robot.battery, robot.cleaning) if robot is not None else (None, None)
        # Charge is rounded up, as in battery_status: 0 % is empty. Coverage is rounded down: 100 % is everything.
        self._bar('Battery', battery and battery.share, math.ceil, _battery_colour(battery, self._theme))
        self._small_line(_battery_text(battery))
        self._bar('Swept', cleaning and cleaning.coverage, math.floor, self._theme.main)
        self._small_line(_cleaning_text(cleaning))
        self._y += 3.0
        for name, value in _rows(robot, snapshot.simulation):
            self._row(name, value)
        self._small_lines(_trouble_text(robot), self._theme.bad)

    def _title(self, name: str, robot: Optional[Robot]) -> None:
        """The name on the left, the state in a pill on the right."""
        height = QFontMetricsF(self._bold).height() + 4.0
        row = QRectF(self._area.left(), self._y, self._area.width(), height)
        self._painter.setPen(Qt.NoPen)
        self._painter.setBrush(QColor(robot_colour(name)))
        self._painter.drawEllipse(QPointF(row.left() + 6.0, row.center().y()), 5.0, 5.0)
        used = self._pill(row, _state_text(robot))
        self._text(row.adjusted(18.0, 0.0, -used, 0.0), name, self._bold, self._theme.text)
        self._y += height + 1.0

    def _pill(self, row: QRectF, state: str) -> float:
        """Returns the width that it takes from the row [pixels]."""
        if not state:
            return 0.0
        wide = QFontMetricsF(self._small).horizontalAdvance(state) + 16.0
        pill = QRectF(row.right() - wide, row.top() + 1.0, wide, row.height() - 2.0)
        colour = QColor(getattr(self._theme, STATES.get(state, 'faint_text')))
        self._painter.setBrush(colour)
        self._painter.drawRoundedRect(pill, 0.5 * pill.height(), 0.5 * pill.height())
        self._text(pill, state, self._small, self._theme.card, Qt.AlignCenter)
        return wide + PILL_GAP

    def _bar(self, name: str, share: Optional[float], rounded: Callable[[float], int], colour: str) -> None:
        """A name, a share 0..1 as a percentage, and a bar below them."""
        height = QFontMetricsF(self._bold).height()
        row = QRectF(self._area.left(), self._y + 3.0, self._area.width(), height)
        self._text(row, name, self._bold, self._theme.text)
        self._text(row, _percent(share, rounded), self._bold, self._theme.text, Qt.AlignRight)
        bar = QRectF(row.left(), row.bottom() + 2.0, row.width(), BAR)
        self._painter.setPen(Qt.NoPen)
        self._painter.setBrush(QColor(self._theme.trough))
        self._painter.drawRoundedRect(bar, 4.0, 4.0)
        if share is not None and share > 0.0:
            self._painter.setBrush(QColor(colour))
            self._painter.save()
            self._painter.setClipRect(QRectF(bar.left(), bar.top(), bar.width() * min(share, 1.0), BAR))
            self._painter.drawRoundedRect(bar, 4.0, 4.0)
            self._painter.restore()
        self._y = bar.bottom() + 2.0

    def _row(self, name: str, value: str) -> None:
        height = QFontMetricsF(self._small).height() + 1.0
        row = QRectF(self._area.left(), self._y, self._area.width(), height)
        self._text(row, name, self._small, self._theme.faint_text)
        self._text(row, value, self._small, self._theme.text, Qt.AlignRight)
        self._y += height

    def _small_line(self, text: str) -> None:
        height = QFontMetricsF(self._small).height() + 1.0
        row = QRectF(self._area.left(), self._y, self._area.width(), height)
        self._text(row, text, self._small, self._theme.faint_text)
        self._y += height

    def _small_lines(self, text: str, colour: str = '') -> None:
        """Two lines; what does not fit into them is cut off."""
        metrics = QFontMetricsF(self._small)
        height = metrics.height() + 1.0
        area = QRectF(self._area.left(), self._y, self._area.width(), 2.0 * height)
        fitting = metrics.elidedText(text, Qt.ElideRight, TWO_LINES * area.width())
        self._painter.setFont(self._small)
        self._painter.setPen(QColor(colour or self._theme.faint_text))
        self._painter.drawText(area, Qt.AlignLeft | Qt.AlignTop | Qt.TextWordWrap, fitting)
        self._y += 2.0 * height

    def _text(self, area: QRectF, text: str, font: QFont, colour: str, align: int = Qt.AlignLeft) -> None:
        """One line, cut off with an ellipsis if it is too long."""
        self._painter.setFont(font)
        self._painter.setPen(QColor(colour))
        fitting = QFontMetricsF(font).elidedText(text, Qt.ElideRight, area.width())
        self._painter.drawText(area, align | Qt.AlignVCenter, fitting)


def _percent(share: Optional[float], rounded: Callable[[float], int]) -> str:
    return UNKNOWN if share is None or math.isnan(share) else f'{rounded(round(100.0 * share, 6))} %'


def _state_text(robot: Optional[Robot]) -> str:
    if robot is None:
        return 'absent'
    if robot.has_fallen:
        return FALLEN
    is_idle = robot.mission is None or robot.mission.state == 'idle'
    if is_idle and robot.battery is not None and robot.battery.state in ('charging', 'full'):
        return 'charging' if robot.battery.state == 'charging' else 'charged'
    return robot.mission.state if robot.mission is not None else ''


def _mission_text(robot: Optional[Robot]) -> str:
    if robot is None:
        return ''
    if robot.has_fallen:
        return 'over a cliff: drag the robot elsewhere'
    if robot.mission is None:
        return 'no cleaner'
    return 'yielding to a person' if robot.mission.state == YIELDING else OWN_ACCOUNT.sub('', robot.mission.message)


def _mission_time(robot: Optional[Robot]) -> str:
    time = taken(robot.elapsed, robot.left) if robot is not None else ''
    return time.replace('about ', '~') or UNKNOWN


def _trouble_text(robot: Optional[Robot]) -> str:
    """What battery_status says, unless that is the voltage and current that stand below the battery already."""
    return '' if robot is None or FIGURES.match(robot.message) else robot.message


def _battery_colour(battery: Optional[Battery], theme: Theme) -> str:
    if battery is None or battery.state != 'on battery' or battery.share > LOW:
        return theme.good
    return theme.warning if battery.share > CRITICAL else theme.bad


def _battery_text(battery: Optional[Battery]) -> str:
    if battery is None:
        return ''
    current = '' if math.isnan(battery.current) else f'  {battery.current:+.2f} A'.replace('-', MINUS)
    return f'{_known(battery.voltage)} V{current}  {battery.state}'


def _cleaning_text(cleaning: Optional[Cleaning]) -> str:
    if cleaning is None:
        return ''
    dirt = '' if math.isnan(cleaning.dirt) else f', dirt left {100.0 * cleaning.dirt:.0f} %'
    return f'{_known(cleaning.cleaned_area)} of {_known(cleaning.reachable_area)} m\u00b2{dirt}'


def _known(value: float) -> str:
    return UNKNOWN if math.isnan(value) else f'{value:.1f}'


def _rows(robot: Optional[Robot], simulation: Simulation) -> List[Tuple[str, str]]:
    return [('Strategy', robot.mission.strategy or UNKNOWN if robot and robot.mission else UNKNOWN),
            ('Mission', _mission_time(robot)),
            ('Position', _pose_text(robot.pose) if robot else UNKNOWN),
            ('Distance', _driven_text(robot) if robot else UNKNOWN),
            ('Sim time', _time_text(simulation)), ('Speed', _speed_text(simulation))]


def _pose_text(pose: Pose) -> str:
    return f'{pose.x:.2f}, {pose.y:.2f} m, {math.degrees(pose.theta):.0f}\u00b0'.replace('-', MINUS)


def _driven_text(robot: Robot) -> str:
    driven = robot.cleaning.distance if robot.cleaning is not None else math.nan
    distance = f'{driven:.0f} m' if driven >= FAR else f'{_known(driven)} m'
    brushes = {None: UNKNOWN, True: 'up', False: 'down'}[robot.brushes_up]
    return f'{distance}, brushes {brushes}'


def _time_text(simulation: Simulation) -> str:
    if simulation.time is None:
        return UNKNOWN
    if not simulation.is_simulated:
        return 'wall clock'
    minutes, seconds = divmod(int(simulation.time), 60)
    hours, minutes = divmod(minutes, 60)
    return f'{hours}:{minutes:02}:{seconds:02}'


def _speed_text(simulation: Simulation) -> str:
    if simulation.is_paused:
        return 'paused'
    if simulation.speed is None:
        return UNKNOWN
    wanted = ''
    if simulation.wanted is not None:
        wanted = f' of {simulation.wanted:g}' if simulation.wanted else ' (maximum)'
    if simulation.wanted and simulation.wanted < SLOW:
        return f'{simulation.wanted:g} \u00d7 real time'
    digits = 0 if simulation.speed >= 100.0 else 1
    return f'{simulation.speed:.{digits}f}{wanted} \u00d7 real time'
