"""What a robot may sense beside odometry and scan, in the messages of its driver: by the names of types, without them.

Sources: kobuki_msgs of Yujin Robot (BumperEvent, CliffEvent and WheelDropEvent tell of changes of one sensor each);
ca_msgs and create_msgs of create_robot (Bumper and Cliff tell of all sensors); sensor_msgs/BatteryState.
"""

import math
from typing import Any, Callable, Dict, List

LEFT, CENTRE, RIGHT = 0, 1, 2  # of kobuki_msgs


class State:
    """The newest of each; what the robot does not have is calm, and fully charged.

    Attributes:
        charge: of the battery [0..1].
    """

    def __init__(self) -> None:
        """Nothing has been told."""
        self.charge = 1.0
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
        return any(self._drops.values())

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

    def charge_to(self, message: Any) -> None:
        """BatteryState of sensor_msgs; NaN tells nothing."""
        self._take_charge(message.percentage)

    def charge_to_ratio(self, message: Any) -> None:
        """Float32 of std_msgs, 0 to 1."""
        self._take_charge(message.data)

    def _take_charge(self, share: float) -> None:
        if math.isfinite(share):
            self.charge = min(max(share, 0.0), 1.0)


Reader = Callable[[State, Any], None]
READERS: Dict[str, Dict[str, Reader]] = {  # by topic below the robot's name, and by type
    'bumper': {'rumba_msg/Bumper': State.press, 'create_msgs/Bumper': State.press, 'ca_msgs/Bumper': State.press,
               'kobuki_msgs/BumperEvent': State.press_one},
    'cliff': {'rumba_msg/Cliff': State.see_cliffs_and_drops, 'create_msgs/Cliff': State.see_cliffs,
              'ca_msgs/Cliff': State.see_cliffs, 'kobuki_msgs/CliffEvent': State.see_one_cliff},
    'wheel_drop': {'kobuki_msgs/WheelDropEvent': State.drop_one},
    'battery_state': {'sensor_msgs/BatteryState': State.charge_to, 'std_msgs/Float32': State.charge_to_ratio}}
