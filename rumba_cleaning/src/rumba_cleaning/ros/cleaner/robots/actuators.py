"""What the cleaner moves of one robot: its wheels through topics, and its brushes through a service."""

import queue
import threading
from typing import Optional

import rosgraph
import rospy
from geometry_msgs.msg import Twist
from std_msgs.msg import Empty
from std_srvs.srv import SetBool

from rumba_cleaning.behaviour import STOP, Command
from rumba_cleaning.ros.cleaner.robots import conversions
from rumba_sim.ros.participants.lockstep import Resent

COMPLAINT_PERIOD = 10.0  # [s]


class Wheels:
    """Publishes commands of velocity; for a robot that docks by itself, also that it is to do so."""

    def __init__(self, robot: str, docks: bool = False) -> None:
        """Drive a robot, by its name; `docks`: it docks by itself."""
        self._last = Resent()
        self._seek_dock = rospy.Publisher(f'{robot}/seek_dock', Empty, queue_size=1) if docks else None
        self._publisher = rospy.Publisher(f'{robot}/cmd_vel', Twist, self._last, queue_size=1)
        self._lock = threading.Lock()
        self._is_closed = False

    def drive(self, command: Command) -> None:
        """Command a velocity, or in its place to seek the dock."""
        with self._lock:
            if self._is_closed:
                return
            if command.seeks_dock and self._seek_dock is not None:
                self._seek_dock.publish()
            else:
                self._last.message = conversions.velocity(command)
                self._publisher.publish(self._last.message)

    def forget(self) -> None:
        """Begin a new reading: send what was commanded before to no new subscriber."""
        self._last.message = None

    def commanded(self) -> str:
        """The name of the topic if a velocity was commanded since `forget`, else an empty text."""
        return str(self._publisher.resolved_name) if self._last.message is not None else ''

    def stop(self) -> None:
        """Command to stand still."""
        self.drive(STOP)

    def close(self) -> None:
        """Command to stand still, and nothing from now on; may be called from any thread."""
        with self._lock:
            self._is_closed = True
            self._publisher.publish(conversions.velocity(STOP))


class Brushes:
    """Lifts and lowers the brushes in a thread of its own, because a call of the service may take long."""

    def __init__(self, robot: str, are_optional: bool = False) -> None:
        """Use the service of a robot, by its name; if `are_optional` is true, only while a node serves it."""
        self._are_optional = are_optional
        self._service = rospy.ServiceProxy(f'{robot}/set_brushes_up', SetBool)
        self._wanted: Optional[bool] = None  # what the robot was asked for last; None: where they are is unknown
        self._wishes: 'queue.Queue[bool]' = queue.Queue()
        threading.Thread(target=self._serve, daemon=True).start()

    def want(self, are_up: bool) -> None:
        """Have the brushes up or down; asks the robot only if that is new."""
        if are_up is not self._wanted:
            self._wanted = are_up
            self._wishes.put(are_up)

    def settle(self) -> None:
        """Return when the robot has answered every wish, or does not answer."""
        self._wishes.join()

    def forget(self) -> None:
        """Somebody else may have moved them: ask the robot at the next call of `want` in any case."""
        self._wanted = None

    @property
    def _is_served(self) -> bool:
        try:
            rosgraph.Master(rospy.get_name()).lookupService(self._service.resolved_name)
        except rosgraph.MasterError:
            return False
        return True

    def _serve(self) -> None:
        while not rospy.is_shutdown():
            are_up = self._wishes.get()
            try:
                if not self._are_optional or self._is_served:
                    self._service(are_up)
            except Exception as error:  # whatever it is, the next wish must be served
                self.forget()
                if not rospy.core.is_shutdown_requested():  # else the robot may end too
                    rospy.logwarn_throttle(COMPLAINT_PERIOD, f'brushes not moved: {type(error).__name__}: {error}')
            finally:
                self._wishes.task_done()
