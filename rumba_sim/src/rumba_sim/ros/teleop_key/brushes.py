"""The brushes of the robot that is driven."""

import queue
import threading
from typing import Optional

import rospy
from std_srvs.srv import SetBool

from rumba_msg.msg import BatteryStatus


class Brushes:
    """Lifts and lowers the brushes by their service.

    Attributes:
        up: whether they are up, as the robot last said; None before its first message.
        trouble: what went wrong, one line each, for a person.
    """

    def __init__(self) -> None:
        """Begin to listen to the robot."""
        self.up: Optional[bool] = None
        self.trouble: 'queue.SimpleQueue[str]' = queue.SimpleQueue()
        self._service = rospy.ServiceProxy('rumba/set_brushes_up', SetBool)
        self._call: Optional[threading.Thread] = None
        rospy.Subscriber('rumba/battery_status', BatteryStatus, self._listen)

    def toggle(self) -> None:
        """Ask for the opposite of the present state; returns at once, since driving must not wait for an answer."""
        if self._call and self._call.is_alive():
            self.trouble.put(f'{self._service.resolved_name} has not answered yet')
            return
        self._call = threading.Thread(target=self._set, args=(not self.up,), daemon=True)
        self._call.start()

    def _set(self, up: bool) -> None:
        try:
            answer = self._service(up)
        except (rospy.ServiceException, rospy.ROSException) as error:
            self.trouble.put(f'brushes: {error}')
            return
        if answer.success:
            self.up = up
        else:
            self.trouble.put(f'brushes: {answer.message}')

    def _listen(self, status: BatteryStatus) -> None:
        self.up = status.brushes_up
