"""What a robot may sense beside odometry and scan, in the messages of its driver: by the names of types, without them.

Sources: kobuki_msgs of Yujin Robot (BumperEvent, CliffEvent and WheelDropEvent tell of changes of one sensor each);
ca_msgs and create_msgs of create_robot (Bumper and Cliff tell of all sensors; its wheeldrop comes again and again while
a wheel hangs in the air; ChargingState is packet 21 of the iRobot Open Interface); sensor_msgs/BatteryState.
"""

import math
from typing import Any, Callable, Dict, List

LEFT, CENTRE, RIGHT = 0, 1, 2  # of kobuki_msgs
TRICKLE = 3  # state of create_msgs/ChargingState: the battery is full
PULSE = 0.5  # [s] for which a wheeldrop of a Create counts: it comes ten times a second


class State:
    """The newest of each; what the robot does not have is calm, and fully charged.

    Attributes:
        now: the time, which the owner sets [s].
        is_docked: whether the robot is on the contacts of its dock.
        infrared: beams of the dock that it receives: from all around, from the front left, from the front right.
    """

    def __init__(self) -> None:
        """Nothing has been told."""
        self.now = 0.0
        self.is_docked = False
        self.infrared = (0, 0, 0)
        self._charge = 1.0
        self._is_full = False  # by the charger
        self._pulse = -math.inf  # [s] when a Create told of a wheel that hangs in the air
        self._bumpers: Dict[int, bool] = {}  # by place
        self._cliffs: List[bool] = [False] * 4
        self._drops: Dict[int, bool] = {}  # by wheel

    @property
    def bumper(self) -> Any:
        """Whether it is pressed: left, right."""
        pressed = self._bumpers.get
        return pressed(LEFT, False) or pressed(CENTRE, False), pressed(RIGHT, False) or pressed(CENTRE, False)

    @property
    def cliffs(self) -> Any:
        """Which sensors look into the deep: left, front left, front right, right."""
        return tuple(self._cliffs)

    @property
    def has_fallen(self) -> bool:
        """Whether a wheel hangs in the air."""
        return any(self._drops.values()) or 0.0 <= self.now - self._pulse < PULSE

    @property
    def charge(self) -> float:
        """Of the battery [0..1]; an old one is full for its charger at less than its capacity."""
        return 1.0 if self._is_full else self._charge

    def press(self, message: Any) -> None:
        """Bumper of rumba_msg, create_msgs and ca_msgs."""
        self._bumpers = {LEFT: bool(message.is_left_pressed), RIGHT: bool(message.is_right_pressed)}

    def press_one(self, message: Any) -> None:
        """BumperEvent of kobuki_msgs."""
        self._bumpers[message.bumper] = bool(message.state)

    def see_cliffs(self, message: Any) -> None:
        """Cliff of create_msgs and ca_msgs."""
        self._cliffs = [bool(message.is_cliff_left), bool(message.is_cliff_front_left),
                        bool(message.is_cliff_front_right), bool(message.is_cliff_right)]

    def see_cliffs_and_drops(self, message: Any) -> None:
        """Cliff of rumba_msg."""
        self.see_cliffs(message)
        self._drops[LEFT] = bool(message.is_wheel_dropped)

    def see_one_cliff(self, message: Any) -> None:
        """CliffEvent of kobuki_msgs."""
        for place in {LEFT: (0,), CENTRE: (1, 2), RIGHT: (3,)}.get(message.sensor, ()):
            self._cliffs[place] = bool(message.state)

    def drop_one(self, message: Any) -> None:
        """WheelDropEvent of kobuki_msgs."""
        self._drops[message.wheel] = bool(message.state)

    def drop_now(self, message: Any) -> None:
        """Empty of std_msgs, again and again while a wheel hangs in the air."""
        self._pulse = self.now

    def dock(self, message: Any) -> None:
        """DockStatus of rumba_msg."""
        self.is_docked = bool(message.is_docked)
        self.infrared = message.infrared_omni, message.infrared_left, message.infrared_right

    def fill(self, message: Any) -> None:
        """ChargingState of create_msgs."""
        self._is_full = message.state == TRICKLE

    def charge_to(self, message: Any) -> None:
        """BatteryState of sensor_msgs; NaN tells nothing."""
        self._take_charge(message.percentage)

    def charge_to_ratio(self, message: Any) -> None:
        """Float32 of std_msgs, 0 to 1."""
        self._take_charge(message.data)

    def _take_charge(self, share: float) -> None:
        if math.isfinite(share):
            self._charge = min(max(share, 0.0), 1.0)


Reader = Callable[[State, Any], None]
READERS: Dict[str, Dict[str, Reader]] = {  # by topic below the robot's name, and by type
    'bumper': {'rumba_msg/Bumper': State.press, 'create_msgs/Bumper': State.press, 'ca_msgs/Bumper': State.press,
               'kobuki_msgs/BumperEvent': State.press_one},
    'cliff': {'rumba_msg/Cliff': State.see_cliffs_and_drops, 'create_msgs/Cliff': State.see_cliffs,
              'ca_msgs/Cliff': State.see_cliffs, 'kobuki_msgs/CliffEvent': State.see_one_cliff},
    'wheel_drop': {'kobuki_msgs/WheelDropEvent': State.drop_one, 'std_msgs/Empty': State.drop_now},
    'dock_status': {'rumba_msg/DockStatus': State.dock},
    'charging_state': {'create_msgs/ChargingState': State.fill},
    'battery_state': {'sensor_msgs/BatteryState': State.charge_to, 'std_msgs/Float32': State.charge_to_ratio}}
