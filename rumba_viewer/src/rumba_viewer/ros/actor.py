"""What keys and buttons have done: services, actions and commands, none of which the window waits for."""

import pathlib
import queue
import threading
from typing import Any, Callable, Dict, Optional

import rospy
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure
from geometry_msgs.msg import Pose2D
from std_srvs.srv import SetBool, Trigger

from rumba_msg.srv import Step, Teleport
from rumba_sim.model.geometry import Pose
from rumba_viewer.ros.robot_client import Hands

STEP_TICKS = 5  # of one step: at the usual rates, until the next ground_truth


class Actor:
    """Does in threads what is asked; one thing of a kind at a time.

    Attributes:
        notices: lines for a person about what came of it.
    """

    def __init__(self, robot: str, note_pause: Callable[[bool], None]) -> None:
        """Act upon a robot by its name, once `reach` was called; `note_pause` is told when a pause begins or ends."""
        self.notices: 'queue.SimpleQueue[str]' = queue.SimpleQueue()
        self._note_pause = note_pause
        self._robot = robot
        self._hands: Optional[Hands] = None
        self._lock = threading.Lock()  # of _hands, while they are made
        self._at: Dict[str, threading.Thread] = {}

    # --- the robot ----------------------------------------------------------------------------------------------------

    def attend(self, robot: str) -> None:
        """Act upon another robot."""
        if robot != self._robot:
            self._robot = robot
            threading.Thread(target=self.reach, daemon=True).start()

    def reach(self) -> None:
        """Open, at the present master, the topics by which the robot is moved; takes as long as that answers."""
        with self._lock:
            old, self._hands = self._hands, None
            if old is not None:
                old.close()
            self._hands = Hands(self._robot, self.notices.put)

    def drive(self, v: float, w: float) -> None:
        """Command a velocity [m/s], [rad/s], at once."""
        if self._hands is not None:
            self._hands.drive(v, w)

    def clean(self, strategy: str) -> None:
        """Have the cleaner clean by a strategy; empty: its own choice."""
        self._with_hands('clean', lambda hands: hands.clean(strategy))

    def dock(self) -> None:
        """Have the cleaner bring the robot home."""
        self._with_hands('dock', lambda hands: hands.dock())

    def undock(self) -> None:
        """Have the cleaner leave the dock."""
        self._with_hands('undock', lambda hands: hands.undock())

    def go_to(self, x: float, y: float) -> None:
        """Have the cleaner go to a place [m]."""
        self._with_hands('go to', lambda hands: hands.go_to(x, y))

    def cancel(self) -> None:
        """Cancel whatever the cleaner does."""
        self._with_hands('cancel', lambda hands: hands.cancel())

    def set_brushes_up(self, are_up: bool) -> None:
        """Lift or lower the brushes."""
        robot = self._robot
        self._do('brushes', lambda: str(rospy.ServiceProxy(f'{robot}/set_brushes_up', SetBool)(are_up).message))

    def teleport(self, robot: str, pose: Pose) -> None:
        """Put a robot elsewhere."""
        self._do('teleport', lambda: str(rospy.ServiceProxy(f'{robot}/teleport', Teleport)(Pose2D(*pose)).message))

    def _with_hands(self, what: str, act: Callable[[Hands], None]) -> None:
        hands = self._hands
        if hands is None:
            self.notices.put(f'{what}: the robot is not connected yet')
        else:
            act(hands)

    # --- the simulation -----------------------------------------------------------------------------------------------

    def pause(self) -> None:
        """Let time stand still."""
        self._do('pause', lambda: self._set_pause('pause', True))

    def resume(self) -> None:
        """Let time go on."""
        self._do('resume', lambda: self._set_pause('resume', False))

    def _set_pause(self, service: str, is_paused: bool) -> str:
        answer = rospy.ServiceProxy(f'simulator/{service}', Trigger)()
        self._note_pause(is_paused)
        return str(answer.message)

    def step(self) -> None:
        """Let a few ticks pass."""
        def do() -> str:
            answer = rospy.ServiceProxy('simulator/step', Step)(STEP_TICKS)
            if answer.success:
                self._note_pause(True)
            return str(answer.message)
        self._do('step', do)

    def reset(self) -> None:
        """Make the floor dirty, and put all robots back."""
        self._do('reset', lambda: str(rospy.ServiceProxy('simulator/reset', Trigger)().message))

    def set_speed(self, speed: float) -> None:
        """Let time pass so many times faster than in reality; 0: as fast as it can."""
        def do() -> str:
            service = rospy.ServiceProxy('simulator/tuning/set_parameters', Reconfigure)
            answer = service(Config(doubles=[DoubleParameter('speed', speed)])).config
            in_force = {parameter.name: parameter.value for parameter in answer.doubles}['speed']
            return '' if in_force == speed else f'stays {in_force:g}: the log of the simulator says why'
        self._do('speed', do)

    # --- files --------------------------------------------------------------------------------------------------------

    def write(self, record: Any, path: pathlib.Path) -> None:
        """Have a record written to a file."""
        def do() -> str:
            record.write(path)
            return str(path)
        self._do('saved', do)

    def _do(self, what: str, act: Callable[[], str]) -> None:
        """Do something in a thread, and say what came of it."""
        def run() -> None:
            try:
                answer = act()
            except (rospy.ServiceException, rospy.ROSException, OSError) as error:
                answer = str(error)
            if answer:
                self.notices.put(f'{what}: {answer}')
        before = self._at.get(what)
        if before is not None and before.is_alive():
            self.notices.put(f'{what}: there is no answer yet to the last one')
            return
        self._at[what] = threading.Thread(target=run, daemon=True)
        self._at[what].start()
