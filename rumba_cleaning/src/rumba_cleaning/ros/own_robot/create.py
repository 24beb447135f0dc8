"""What only an iRobot Create or a Roomba has, by its driver create_driver: its dock, its modes, and its brushes."""

import threading
import time
from typing import Any, Optional

import roslib.message
import rospy
from std_msgs.msg import Empty, Header, UInt16
from std_srvs.srv import SetBool, SetBoolResponse

from rumba_cleaning.own_robot.gate import Velocity
from rumba_cleaning.own_robot.own_dock import DOCK, UNDOCK, OwnDock
from rumba_cleaning.ros.own_robot.publishing import publish
from rumba_msg.msg import DockStatus
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.common.geometry import Pose

PACKAGE = 'create_msgs'
MOTORS = 'main_brush_motor', 'side_brush_motor', 'vacuum_motor'  # topics
OFF, ON = 0.0, 1.0  # duty cycles
SAYS = {DOCK: 'it seeks its dock by itself', UNDOCK: 'it obeys velocities again'}


class Create:
    """Tells the driver to dock and to undock, and the cleaner whether the robot is docked; moves the brushes.

    Its methods are called while its lock is held.
    """

    def __init__(self, robot: str, driver: str, base: str, is_docked: bool, lock: threading.Lock) -> None:
        """Open all topics and the service.

        Args:
            robot: name of the robot, below which the topics for the cleaner are.
            driver: namespace of the topics of create_driver.
            base: frame of the robot.
            is_docked: whether the robot stands on its dock at first.
            lock: what the callbacks hold.

        Raises:
            ConfigError: the messages of the driver are not installed.
        """
        self._base, self._lock = base, lock
        self._dock = OwnDock(is_docked)
        self._are_down, self._run = False, False  # whether the brushes are wanted; whether they turn
        driver = driver.rstrip('/')
        self._tell = {name: rospy.Publisher(f'{driver}/{name}', Empty, queue_size=1) for name in (DOCK, UNDOCK)}
        self._setpoint = _class('MotorSetpoint')
        self._motors = [rospy.Publisher(f'{driver}/{name}', self._setpoint, queue_size=1) for name in MOTORS]
        self._status = rospy.Publisher(f'{robot}/dock_status', DockStatus, queue_size=10)
        rospy.Subscriber(f'{driver}/mode', _class('Mode'), self._take_mode, queue_size=1)
        rospy.Subscriber(f'{driver}/battery/charging_state', _class('ChargingState'), self._take_state, queue_size=1)
        rospy.Subscriber(f'{driver}/ir_omni', UInt16, self._take_character, queue_size=1)
        rospy.Service(f'{robot}/set_brushes_up', SetBool, self._move_brushes)

    def _take_mode(self, message: Any) -> None:
        with self._lock:
            was_passive = self._dock.is_passive
            self._dock.take_mode(message.mode, _now())
            if was_passive and not self._dock.is_passive:
                self._run = False  # a passive robot has stopped its brushes

    def _take_state(self, message: Any) -> None:
        with self._lock:
            self._dock.take_charging_state(message.state)

    def _take_character(self, message: UInt16) -> None:
        with self._lock:
            self._dock.take_infrared(message.data)

    def _move_brushes(self, request: SetBool) -> SetBoolResponse:
        with self._lock:
            self._are_down = not request.data
        return SetBoolResponse(True, 'up' if request.data else 'down')

    def take_odometry(self, pose: Pose, stamp: rospy.Time) -> None:
        """Tell the cleaner and the mapper whether the robot is docked."""
        dock = self._dock
        dock.take_odometry(pose, _now())
        publish(self._status, DockStatus(Header(stamp=stamp, frame_id=self._base), dock.infrared > 0, dock.is_docked,
                                         dock.infrared, 0, 0))

    def follow(self, velocity: Optional[Velocity]) -> None:
        """Have dock and brushes go with the velocity that the robot is commanded; None: nobody commands it."""
        told = self._dock.due(velocity, time.monotonic())
        if told:
            rospy.loginfo(SAYS[told])
            publish(self._tell[told], Empty())
        self._turn(self._are_down and velocity is not None and not velocity.seeks_dock)

    def _turn(self, run: bool) -> None:
        """Have the brushes turn, or stand."""
        if run is not self._run and not self._dock.is_passive:
            self._run = run
            for motor in self._motors:
                publish(motor, self._setpoint(ON if run else OFF))


def _now() -> float:
    return float(rospy.get_time())


def _class(name: str) -> Any:
    """A type of message of the driver.

    Raises:
        ConfigError: its package is not installed.
    """
    found = roslib.message.get_message_class(f'{PACKAGE}/{name}')
    if found is None:
        raise ConfigError(f'create is given, and the package {PACKAGE} is not installed: install create_robot, or '
                          'source the workspace that has it')
    return found
