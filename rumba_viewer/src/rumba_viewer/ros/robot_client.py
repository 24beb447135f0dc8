"""What the window moves of one robot: its wheels, and the actions of its cleaner."""

from typing import Any, Callable, Dict

import actionlib
import rospy
from geometry_msgs.msg import Pose2D, Twist

from rumba_msg.msg import CleanAction, CleanGoal, DockAction, DockGoal, GoToAction, GoToGoal, UndockAction, UndockGoal

ACTIONS = {'clean': CleanAction, 'dock': DockAction, 'undock': UndockAction, 'go_to': GoToAction}
ANY_HEADING = float('nan')


class Hands:
    """Publishers and clients for one robot. Making one takes as long as the master needs to answer."""

    def __init__(self, robot: str, tell: Callable[[str], None]) -> None:
        """Reach for a robot by its name; `tell` is given a line about what came of a goal."""
        self._robot = robot
        self._tell = tell
        self._wheels = rospy.Publisher(f'{robot}/cmd_vel', Twist, queue_size=10)
        self._clients = {name: actionlib.ActionClient(f'{robot}/{name}', kind) for name, kind in ACTIONS.items()}
        self._goals: Dict[str, Any] = {}  # actionlib forgets a goal that nobody holds

    def close(self) -> None:
        """Let go."""
        self._wheels.unregister()
        for client in self._clients.values():
            client.stop()

    def drive(self, v: float, w: float) -> None:
        """Command a velocity [m/s], [rad/s]."""
        twist = Twist()
        twist.linear.x, twist.angular.z = v, w
        self._wheels.publish(twist)

    def clean(self, strategy: str) -> None:
        """Clean by a strategy; empty: the cleaner's own choice."""
        self._send('clean', CleanGoal(strategy=strategy))

    def dock(self) -> None:
        """Go home."""
        self._send('dock', DockGoal())

    def undock(self) -> None:
        """Leave the dock."""
        self._send('undock', UndockGoal())

    def go_to(self, x: float, y: float) -> None:
        """Go to a place [m]."""
        self._send('go_to', GoToGoal(target=Pose2D(x, y, ANY_HEADING)))

    def cancel(self) -> None:
        """Cancel whatever goal there is, whoever sent it."""
        for client in self._clients.values():
            client.cancel_all_goals()

    def _send(self, name: str, goal: Any) -> None:
        self._goals[name] = self._clients[name].send_goal(goal, lambda handle: self._on_change(name, handle))

    def _on_change(self, name: str, handle: Any) -> None:
        if handle.get_comm_state() == actionlib.CommState.DONE and self._goals.get(name) == handle:
            result = handle.get_result()
            self._tell(f'{self._robot}: {name.replace("_", " ")}: {result.message if result else "lost"}')
