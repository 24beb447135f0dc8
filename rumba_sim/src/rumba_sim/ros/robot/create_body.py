"""What a Create does beside driving as it is told: its mode, its brushes, its way to the dock, and what it tells."""

from typing import Any, Callable, Dict, Optional

import rospy
from std_msgs.msg import Empty, Float32, Int16, UInt16

from rumba_sim.model.devices.light_bumper import light_bumper
from rumba_sim.model.devices.seek_dock import RATE, Reading, SeekDock
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.participants.requests import Requests
from rumba_sim.ros.robot import interface_messages

try:
    from create_msgs.msg import Bumper, ChargingState, Cliff, Mode
except ImportError:  # an error only if the interface is that of a Create: InterfaceTopics refuses it then
    Bumper = None

INFRARED = 160  # added to the beams of a dock, it is the character that they send (Open Interface, packet 17)
ROOM_TEMPERATURE = 25  # [degrees Celsius] of the battery; our choice: it is not simulated
LOWEST_DUTY = {'main_brush_motor': -1.0, 'side_brush_motor': -1.0, 'vacuum_motor': 0.0}
LIGHTS = ('left', 'front_left', 'center_left', 'center_right', 'front_right', 'right')


class CreateBody:
    """The mode of a robot, and what it does of its own accord; all but `obey` is called by the owner of the world.

    Attributes:
        is_passive: whether it obeys no velocities.
    """

    def __init__(self, world: World, name: str, requests: Requests, drive: Callable[[float, float], None]) -> None:
        """Begin in full mode, as create_driver does.

        Args:
            world: where the robot is.
            name: of the robot.
            requests: to the owner of the world.
            drive: has the robot drive at a velocity [m/s, rad/s].
        """
        self._world = world
        self._name = name
        self._requests = requests
        self._drive = drive
        self._seek: Optional[SeekDock] = None
        self.is_passive = False

    def obey(self, message: Any, topic: str) -> None:
        """A command came on a topic, in a thread of rospy."""
        if topic in LOWEST_DUTY and not LOWEST_DUTY[topic] <= message.duty_cycle <= 1.0:
            rospy.logerr(f'{topic}: duty_cycle is {message.duty_cycle:g}: must be {LOWEST_DUTY[topic]:g} to 1; ignored')
            return
        act = {'dock': self._dock, 'undock': self._undock,
               'main_brush_motor': lambda: self._sweep(message.duty_cycle != 0.0)}.get(topic)
        if act is not None:
            self._requests.post(act)

    def _dock(self) -> None:
        self.is_passive, self._seek = True, SeekDock()

    def _undock(self) -> None:
        self.is_passive, self._seek = False, None

    def _sweep(self, is_on: bool) -> None:
        self._world.robots[self._name].brushes_up = not is_on

    def step(self) -> None:
        """Seek the dock, if it does so at this tick."""
        if self._seek is not None and (self._world.tick - 1) % max(1, int(self._world.step_rate) // RATE) == 0:
            robot = self._world.robots[self._name]
            self._drive(*self._seek.step(Reading(
                robot.odometry, self._world.infrared(self._name), robot.is_docked, robot.bumper,
                self._world.cliffs(self._name))))
            if robot.is_docked:
                self._seek = None  # it remains passive, and charges

    def makers(self) -> Dict[str, Callable[[interface_messages.Reading], Any]]:
        """Functions that make the messages, by topic; None: nothing is told now."""
        return {
            'mode': lambda reading: Mode(reading.header, Mode.MODE_PASSIVE if self.is_passive else Mode.MODE_FULL),
            'bumper': _bumper, 'cliff': _cliff, 'battery/charging_state': _charging_state,
            'wheeldrop': lambda reading: Empty() if reading.robot.has_fallen else None, 'ir_omni': _ir_omni,
            'battery/voltage': lambda reading: Float32(reading.robot.battery.voltage),
            'battery/current': lambda reading: Float32(reading.robot.battery.current),
            'battery/charge': lambda reading: Float32(reading.robot.battery.charge),
            'battery/capacity': lambda reading: Float32(reading.robot.battery.config.capacity),
            'battery/charge_ratio': lambda reading: Float32(reading.robot.battery.state_of_charge),
            'battery/temperature': lambda _: Int16(ROOM_TEMPERATURE)}


def _bumper(reading: interface_messages.Reading) -> Any:
    left, right = reading.robot.bumper
    message = Bumper(header=reading.header, is_left_pressed=left, is_right_pressed=right)
    for name, light in zip(LIGHTS, light_bumper(reading.world, reading.robot.name)):
        setattr(message, f'is_light_{name}', light.is_near)
        setattr(message, f'light_signal_{name}', light.signal)
    return message


def _cliff(reading: interface_messages.Reading) -> Any:
    left, front_left, front_right, right = reading.world.cliffs(reading.robot.name)
    return Cliff(header=reading.header, is_cliff_left=left, is_cliff_front_left=front_left, is_cliff_right=right,
                 is_cliff_front_right=front_right)


def _ir_omni(reading: interface_messages.Reading) -> UInt16:
    beams = reading.world.infrared(reading.robot.name).omni
    return UInt16(INFRARED + beams if beams else 0)


def _charging_state(reading: interface_messages.Reading) -> Any:
    state = ChargingState.CHARGE_NONE
    if reading.robot.is_docked:
        is_full = reading.robot.battery.state_of_charge >= 1.0
        state = ChargingState.CHARGE_TRICKLE if is_full else ChargingState.CHARGE_FULL
    return ChargingState(reading.header, state)
