"""The floor in the window: paints snapshots, and reports what the mouse does on them."""

import math
from typing import Any, Optional, Tuple

from PyQt5.QtCore import QPoint, QRectF, QSize, Qt, pyqtSignal
from PyQt5.QtGui import QColor, QPainter, QPalette
from PyQt5.QtWidgets import QApplication, QWidget

from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_viewer.painting.paint_legend import paint_legend
from rumba_viewer.painting.paint_report import ReportCard
from rumba_viewer.painting.paint_scene import ScenePainter
from rumba_viewer.scene.snapshot import Box, Robot, Snapshot
from rumba_viewer.scene.theme import DARK, LIGHT, Theme
from rumba_viewer.scene.view_transform import ViewTransform

ZOOM = 1.2  # for one notch of the wheel
NOTCH = 120.0  # the angle delta of one notch in Qt
TURN = math.radians(15.0)  # of a robot that is being dragged, for one notch
GRIP = 8.0  # [pixels] from a robot's centre within which a click selects it, if its radius is smaller
KEY = 26.0  # [pixels] at the lower edge, with the margin of the map: for one row of the key, and the scale
NO_MAP = Box(0.0, 0.0, 10.0, 8.0)


def theme_of(palette: QPalette) -> Theme:
    """The colours that match a palette of the desktop."""
    return DARK if palette.color(QPalette.Window).lightness() < 128 else LIGHT


class FloorView(QWidget):
    """Shows the map and everything on it.

    Signals:
        clicked: a point of the floor [m].
        double_clicked: a point of the floor [m].
        robot_clicked: name of a robot.
        robot_put: name of a robot, and the pose to which it was dragged.

    Attributes:
        scene: paints the floor.
        notice: a line over the floor; empty: none.
        hint: a line at the end of the card of a mission that has ended.
        shows_legend: whether the list of keys is shown.
    """

    clicked = pyqtSignal(float, float)
    double_clicked = pyqtSignal(float, float)
    robot_clicked = pyqtSignal(str)
    robot_put = pyqtSignal(str, object)

    def __init__(self, snapshot: Snapshot) -> None:
        """Show a snapshot."""
        super().__init__()
        self.scene = ScenePainter()
        self.notice = self.hint = ''
        self.shows_legend = False
        self._snapshot = snapshot
        self._transform: Optional[ViewTransform] = None
        self._is_fitted = True
        self._pressed: Optional[Tuple[QPoint, Optional[Robot]]] = None  # the left button, and on which robot
        self._ghost: Optional[Tuple[str, Pose]] = None
        self._pan_from: Optional[QPoint] = None
        self._card = QRectF()  # where the report of a mission is painted
        self._dismissed: Tuple[str, ...] = ()
        self.setMinimumSize(240, 200)
        self.setMouseTracking(True)
        self.setAttribute(Qt.WA_OpaquePaintEvent)

    def sizeHint(self) -> QSize:  # noqa: N802 (Qt's name)
        """The preferred size."""
        return QSize(860, 660)

    @property
    def view(self) -> ViewTransform:
        """The part of the map that is shown."""
        if self._transform is None:
            plan = self._snapshot.plan
            self._transform = ViewTransform.fitted(plan.box if plan else NO_MAP, self.width(), self.height(),
                                                   self._card.bottom(), KEY)
        return self._transform

    def show_snapshot(self, snapshot: Snapshot) -> None:
        """Show a new snapshot; a map of another size or position is shown whole."""
        before, self._snapshot = self._snapshot, snapshot
        box, old = (one.plan.box if one.plan else NO_MAP for one in (snapshot, before))
        if box != old:
            self.fit()
        self.update()

    def fit(self) -> None:
        """Show the whole map."""
        self._transform, self._is_fitted = None, True
        self.update()

    def switch_path(self) -> None:
        """Show or hide the paths driven."""
        self.scene.shows_path = not self.scene.shows_path

    def switch_field(self) -> None:
        """Show or hide where the dock is received."""
        self.scene.shows_field = not self.scene.shows_field

    def switch_legend(self) -> None:
        """Show or hide the list of keys."""
        self.shows_legend = not self.shows_legend

    def show_notice(self, notice: str) -> None:
        """Show a line over the floor; empty: none."""
        self.notice = notice
        self.update()

    # --- events of Qt -------------------------------------------------------------------------------------------------

    def paintEvent(self, _: Any) -> None:  # noqa: N802
        """Paint everything."""
        theme = theme_of(self.palette())
        painter = QPainter(self)
        painter.setFont(self.font())
        card = ReportCard(self.font(), self._report, self.hint, self.width()) if self._report else None
        area = card.area if card is not None else QRectF()
        if area != self._card:  # the map moves out of its way
            self._card, self._transform = area, None if self._is_fitted else self._transform
        self.scene.paint(painter, self._snapshot, self.view, theme, self._ghost)
        if card is not None:
            card.paint(painter, theme)
        if self.notice:
            _paint_notice(painter, self.notice, self.width(), self.height(), theme)
        if self.shows_legend:
            paint_legend(painter, self.width(), self.height(), theme)

    def resizeEvent(self, _: Any) -> None:  # noqa: N802
        """Keep the whole map in view, or its centre."""
        self._transform = None if self._is_fitted else self.view.resized(self.width(), self.height())

    def wheelEvent(self, event: Any) -> None:  # noqa: N802
        """Zoom, or turn the robot that is being dragged."""
        notches = event.angleDelta().y() / NOTCH
        if self._ghost is not None:
            name, pose = self._ghost
            self._ghost = name, pose._replace(theta=wrap_angle(pose.theta + notches * TURN))
        else:
            self._transform = self.view.zoomed(ZOOM ** notches, event.pos().x(), event.pos().y())
            self._is_fitted = False
        self.update()

    def mousePressEvent(self, event: Any) -> None:  # noqa: N802
        """A click or a drag may begin."""
        if event.button() == Qt.LeftButton and self._report and self._card.contains(event.pos()):
            self.dismiss()
        elif event.button() == Qt.LeftButton:
            self._pressed = event.pos(), self._robot_at(event.pos())
        elif event.button() in (Qt.MiddleButton, Qt.RightButton):
            self._pan_from = event.pos()
            self.setCursor(Qt.ClosedHandCursor)

    def mouseDoubleClickEvent(self, event: Any) -> None:  # noqa: N802
        """The second press of a double click; on a robot it counts as any other press."""
        pos = event.pos()
        if event.button() == Qt.LeftButton and self._robot_at(pos) is None and self._snapshot.plan is not None:
            self.double_clicked.emit(*self.view.to_map(pos.x(), pos.y()))
        else:
            self.mousePressEvent(event)

    def mouseMoveEvent(self, event: Any) -> None:  # noqa: N802
        """Drag the map or a robot."""
        if self._pan_from is not None:
            moved = event.pos() - self._pan_from
            self._pan_from, self._is_fitted = event.pos(), False
            self._transform = self.view.panned(moved.x(), moved.y())
            self.update()
        elif self._pressed is not None:
            self._drag(event.pos(), *self._pressed)
        else:
            self.setCursor(Qt.OpenHandCursor if self._robot_at(event.pos()) else Qt.ArrowCursor)

    def mouseReleaseEvent(self, event: Any) -> None:  # noqa: N802
        """A click or a drag ends."""
        if event.button() != Qt.LeftButton:
            self._pan_from = None
            self.unsetCursor()
            return
        pressed, self._pressed = self._pressed, None
        ghost, self._ghost = self._ghost, None
        if ghost is not None:
            self.robot_put.emit(*ghost)
        elif pressed is not None and pressed[1] is not None:
            self.robot_clicked.emit(pressed[1].name)
        elif pressed is not None and self.rect().contains(event.pos()) and self._snapshot.plan is not None:
            self.clicked.emit(*self.view.to_map(event.pos().x(), event.pos().y()))
        self.update()

    @property
    def _report(self) -> Tuple[str, ...]:
        """The report of the last mission of the selected robot, until it is dismissed."""
        robot = self._snapshot.robot
        report = robot.report if robot is not None else ()
        return report if report != self._dismissed else ()

    def dismiss(self) -> bool:
        """Hide the report of the last mission; returns whether it was shown."""
        report = self._report
        if report:
            self._dismissed = report
            self.update()
        return bool(report)

    def let_go(self) -> bool:
        """Stop dragging; returns whether a robot was being dragged."""
        was, self._ghost, self._pressed = self._ghost is not None, None, None
        self.update()
        return was

    def _drag(self, pos: QPoint, start: QPoint, robot: Optional[Robot]) -> None:
        if robot is None or (
                self._ghost is None and (pos - start).manhattanLength() < QApplication.startDragDistance()):
            return
        theta = self._ghost[1].theta if self._ghost is not None else robot.pose.theta
        self._ghost = robot.name, Pose(*self.view.to_map(pos.x(), pos.y()), theta)
        self.update()

    def _robot_at(self, pos: QPoint) -> Optional[Robot]:
        """The robot at a pixel."""
        for robot in reversed(self._snapshot.robots):
            x, y = self.view.to_pixel(robot.pose.x, robot.pose.y)
            if math.hypot(pos.x() - x, pos.y() - y) <= max(robot.size.radius * self.view.scale, GRIP):
                return robot
        return None


def _paint_notice(painter: QPainter, notice: str, width: float, height: float, theme: Theme) -> None:
    """One or a few lines at the lower edge."""
    area = QRectF(0.0, 0.0, min(width - 24.0, 560.0), height)
    text = painter.boundingRect(area.adjusted(12.0, 6.0, -12.0, -6.0), Qt.AlignCenter | Qt.TextWordWrap, notice)
    box = QRectF(0.0, 0.0, text.width() + 24.0, text.height() + 12.0)
    box.moveCenter(QRectF(0.0, height - box.height() - 12.0, width, box.height()).center())
    painter.setPen(Qt.NoPen)
    painter.setBrush(QColor(theme.text))
    painter.drawRoundedRect(box, 6.0, 6.0)
    painter.setPen(QColor(theme.card))
    painter.drawText(box.adjusted(12.0, 6.0, -12.0, -6.0), Qt.AlignCenter | Qt.TextWordWrap, notice)
