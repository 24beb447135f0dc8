"""Does what keys and buttons ask for: commands, goals and services; the window waits for none of them."""

import functools
import pathlib
import queue
import threading
from typing import Any, Callable, Dict, Optional, Sequence

import rospy
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure
from geometry_msgs.msg import Pose2D
from std_srvs.srv import SetBool, Trigger

from rumba_msg.srv import Step, Teleport
from rumba_sim.model.common.geometry import Pose
from rumba_viewer.ros.mission_record import MissionRecord, RecordError
from rumba_viewer.ros.robot_client import RobotClient

STEP_TICKS = 5  # of one step: at the usual rates, until the next ground_truth


class Actor:
    """Calls services in threads; one call of a kind at a time.

    Attributes:
        notices: lines about the results, for a person.
        report: where the report of the last recorded mission is, or why there is none; empty before there was one.
    """

    def __init__(self, robot: str) -> None:
        """Act on a robot by its name, once `connect` was called."""
        self.notices: 'queue.SimpleQueue[str]' = queue.SimpleQueue()
        self.report = ''
        self._record: Optional[MissionRecord] = None
        self._robot = robot
        self._client: Optional[RobotClient] = None
        self._lock = threading.Lock()  # held while another client is made
        self._calls: Dict[str, threading.Thread] = {}

    # --- the robot ----------------------------------------------------------------------------------------------------

    def select(self, robot: str) -> None:
        """Act on another robot."""
        if robot != self._robot:
            self._robot = robot
            threading.Thread(target=self._reconnect, daemon=True).start()

    def connect(self) -> None:
        """Open the topics of the robot at the present master; blocks until that answers."""
        with self._lock:
            old, self._client = self._client, None
            if old is not None:
                old.close()
            self._client = RobotClient(self._robot, self.notices.put)

    def _reconnect(self) -> None:
        try:
            self.connect()
        except Exception as error:  # the master has ended: the next one brings another connection
            self.notices.put(f'{self._robot}: not connected: {type(error).__name__}: {error}')

    def drive(self, v: float, w: float) -> None:
        """Command a velocity [m/s], [rad/s], at once."""
        client = self._client
        if client is not None:
            client.drive(v, w)

    def clean(self, strategy: str) -> None:
        """Make the cleaner clean by a strategy; empty: its default."""
        self._with_client('clean', lambda client: client.clean(strategy))

    def resume_cleaning(self) -> None:
        """Make the cleaner continue the cleaning that was interrupted."""
        self._with_client('resume cleaning', RobotClient.resume_cleaning)

    def dock(self) -> None:
        """Make the cleaner bring the robot to its dock."""
        self._with_client('dock', RobotClient.dock)

    def undock(self) -> None:
        """Make the cleaner leave the dock."""
        self._with_client('undock', RobotClient.undock)

    def go_to(self, x: float, y: float) -> None:
        """Make the cleaner go to a point [m]."""
        self._with_client('go to', lambda client: client.go_to(x, y))

    def cancel(self) -> None:
        """Cancel whatever the cleaner does."""
        self._with_client('cancel', RobotClient.cancel)

    def set_brushes_up(self, are_up: bool) -> None:
        """Lift or lower the brushes."""
        robot = self._robot
        self._call('brushes', lambda: str(rospy.ServiceProxy(f'{robot}/set_brushes_up', SetBool)(are_up).message))

    def teleport(self, robot: str, pose: Pose) -> None:
        """Put a robot elsewhere."""
        self._call('teleport', lambda: str(rospy.ServiceProxy(f'{robot}/teleport', Teleport)(Pose2D(*pose)).message))

    def _with_client(self, what: str, act: Callable[[RobotClient], None]) -> None:
        client = self._client
        if client is None:
            self.notices.put(f'{what}: the robot is not connected yet')
        else:
            act(client)

    # --- the simulator, by the full name of its node ------------------------------------------------------------------

    def pause(self, simulator: str) -> None:
        """Stop time."""
        self._trigger('pause', f'{simulator}/pause')

    def unpause(self, simulator: str) -> None:
        """Make time go on."""
        self._trigger('unpause', f'{simulator}/resume')

    def reset(self, simulator: str) -> None:
        """Make the floor dirty, and put all robots back."""
        self._trigger('reset', f'{simulator}/reset')

    def step(self, simulator: str) -> None:
        """Make the paused time advance by a few ticks."""
        self._call('step', lambda: str(rospy.ServiceProxy(f'{simulator}/step', Step)(STEP_TICKS).message))

    def set_speed(self, simulator: str, speed: float) -> None:
        """Make time pass so many times faster than real time; 0: as fast as possible."""
        def call() -> str:
            service = rospy.ServiceProxy(f'{simulator}/tuning/set_parameters', Reconfigure)
            answer = service(Config(doubles=[DoubleParameter('speed', speed)])).config
            in_force = {parameter.name: parameter.value for parameter in answer.doubles}['speed']
            return '' if in_force == speed else f'stays {in_force:g}: the log of {simulator} says why'
        self._call('speed', call)

    def _trigger(self, what: str, service: str) -> None:
        self._call(what, lambda: str(rospy.ServiceProxy(service, Trigger)().message))

    # --- files --------------------------------------------------------------------------------------------------------

    def write(self, record: Any, path: pathlib.Path) -> None:
        """Write a record to a file."""
        def call() -> str:
            record.write(path)
            return str(path)
        self._call('saved', call)

    def record_mission(self, robots: Sequence[str], is_asked: bool) -> bool:
        """Begin to record robots instead of what was recorded before; returns whether that is possible.

        Only the main thread may call it. Why it is not possible is told if a person asked for it.
        """
        self.report = ''
        old, self._record = self._record, None
        if old is not None:
            threading.Thread(target=old.discard, daemon=True).start()
        try:
            self._record = MissionRecord(robots)
        except RecordError as error:
            if is_asked:
                self.notices.put(f'report: {error}')
        return self._record is not None

    def keep_recording(self, bag: pathlib.Path) -> bool:
        """Have the recording stay as a file; returns whether that is possible, and tells why it is not."""
        try:
            if self._record is not None:
                self._record.keep_as(bag)
        except RecordError as error:
            self.notices.put(f'report: {error}')
            return False
        return self._record is not None

    def end_recording(self) -> None:
        """End the recording."""
        if self._record is not None:
            threading.Thread(target=self._record.close, daemon=True).start()

    def make_report(self, robot: str) -> None:
        """Make a report about a robot of what was recorded."""
        record, self._record = self._record, None
        if record is not None:
            self.report = 'The report is being made.'
            self._call('report', functools.partial(self._make_report, record, robot))

    def _make_report(self, record: MissionRecord, robot: str) -> str:
        try:
            self.report = f'The report is {record.report(robot)}'
        except RecordError as error:
            self.report = f'No report: {error}'
        return self.report

    def close(self) -> None:
        """End a recording that is under way; its bag stays if a person asked for a report."""
        if self._record is not None:
            self._record.discard()

    def _call(self, what: str, act: Callable[[], str]) -> None:
        """Call something in a thread, and tell its answer or what went wrong."""
        def run() -> None:
            try:
                answer = act()
            except (rospy.ServiceException, rospy.ROSException, OSError) as error:
                answer = str(error)
            except Exception as error:  # whatever a server answered: a person must hear of it
                answer = f'{type(error).__name__}: {error}'
            if answer:
                self.notices.put(f'{what}: {answer}')
        before = self._calls.get(what)
        if before is not None and before.is_alive():
            self.notices.put(f'{what}: the last call has not been answered yet')
            return
        self._calls[what] = threading.Thread(target=run, daemon=True)
        self._calls[what].start()
