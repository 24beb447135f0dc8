"""Sends commands to one robot, and goals to the actions of its cleaner."""

import threading
from typing import Any, Callable, Dict

import actionlib
import rospy
from geometry_msgs.msg import Pose2D, Twist

from rumba_msg.msg import CleanAction, CleanGoal, DockAction, DockGoal, GoToAction, GoToGoal, UndockAction, UndockGoal
from rumba_sim.ros.common import teleop

ACTIONS = {'clean': CleanAction, 'dock': DockAction, 'undock': UndockAction, 'go_to': GoToAction}
ANY_HEADING = float('nan')


class RobotClient:
    """Publisher and action clients for one robot. The constructor blocks until the master answers."""

    def __init__(self, robot: str, tell: Callable[[str], None]) -> None:
        """Connect to a robot by its name; `tell` is called with a line about the result of a goal."""
        self._robot = robot
        self._tell = tell
        self._lock = threading.Lock()  # held while something is sent: another thread may close meanwhile
        self._is_open = True
        self._teleop = rospy.Publisher(f'{robot}/{teleop.TOPIC}', Twist, queue_size=10)
        self._clients = {name: actionlib.ActionClient(f'{robot}/{name}', kind) for name, kind in ACTIONS.items()}
        self._handles: Dict[str, Any] = {}  # actionlib drops a goal if nobody keeps its handle
        self._newest: Dict[str, object] = {}  # identifies the last goal of each action

    def close(self) -> None:
        """Disconnect; what is sent later is dropped."""
        with self._lock:
            self._is_open = False
        self._teleop.unregister()
        for client in self._clients.values():
            client.stop()

    def drive(self, v: float, w: float) -> None:
        """Command a velocity [m/s], [rad/s] as a person; the cleaner yields meanwhile."""
        twist = Twist()
        twist.linear.x, twist.angular.z = v, w
        with self._lock:
            if self._is_open:
                self._teleop.publish(twist)

    def clean(self, strategy: str) -> None:
        """Clean by a strategy; empty: the default of the cleaner."""
        self._send('clean', CleanGoal(strategy=strategy))

    def resume_cleaning(self) -> None:
        """Continue the cleaning that was interrupted."""
        self._send('clean', CleanGoal(resume=True))

    def dock(self) -> None:
        """Return to the dock."""
        self._send('dock', DockGoal())

    def undock(self) -> None:
        """Leave the dock."""
        self._send('undock', UndockGoal())

    def go_to(self, x: float, y: float) -> None:
        """Go to a point [m]."""
        self._send('go_to', GoToGoal(target=Pose2D(x, y, ANY_HEADING)))

    def cancel(self) -> None:
        """Cancel all goals, whoever sent them."""
        with self._lock:
            for client in self._clients.values() if self._is_open else ():
                client.cancel_all_goals()

    def _send(self, name: str, goal: Any) -> None:
        mark = self._newest[name] = object()
        with self._lock:
            if self._is_open:
                self._handles[name] = self._clients[name].send_goal(
                    goal, lambda handle: self._on_change(name, mark, handle))

    def _on_change(self, name: str, mark: object, handle: Any) -> None:
        """Tell the result, unless a newer goal of the same action took the place of this one."""
        if handle.get_comm_state() == actionlib.CommState.DONE and self._newest[name] is mark:
            result = handle.get_result()
            message = result.outcome.message if result is not None else 'the cleaner is gone'
            self._tell(f'{self._robot}: {name.replace("_", " ")}: {message}')
