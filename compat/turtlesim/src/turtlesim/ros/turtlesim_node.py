"""turtlesim_node: turtles that draw on a field of 500 x 500 pixels, 11.09 x 11.09 m, with or without a window.

For each turtle, below the name of the turtle (turtle1, turtle2, ...), it publishes every 16 ms
  pose               turtlesim/Pose           color_sensor       turtlesim/Color
subscribes to
  cmd_vel            geometry_msgs/Twist: linear.x, linear.y [m/s], angular.z [rad/s], held for 1 s
and serves
  set_pen            turtlesim/SetPen         teleport_absolute  turtlesim/TeleportAbsolute
                                              teleport_relative  turtlesim/TeleportRelative
It serves clear, reset (std_srvs/Empty), spawn (turtlesim/Spawn), kill (turtlesim/Kill), and below its own name
save_png (std_srvs/Trigger), which writes a picture of the field. If the speed is not 1, it publishes /clock.

Parameters, as in `rosrun turtlesim turtlesim_node _gui:=false _speed:=10`:
"""

import contextlib
import gc
import queue
import sys
import threading
import time
from typing import Any, Dict, Iterable, Iterator, List, Optional, Tuple

import rospy
from std_srvs.srv import Empty, EmptyResponse, Trigger, TriggerResponse

from turtlesim import pictures, window
from turtlesim.model.canvas import Colour, colour_part
from turtlesim.model.errors import TurtlesimError
from turtlesim.model.field import Field
from turtlesim.ros import node
from turtlesim.ros.pace import Pace, wake_on_time
from turtlesim.ros.requests import Requests
from turtlesim.ros.turtle_inputs import COMPLAINT_PERIOD, TurtleInputs, answered
from turtlesim.ros.turtle_outputs import Broadcaster, TurtleOutputs
from turtlesim.srv import Kill, KillResponse, Spawn, SpawnResponse

BACKGROUND = ('background_r', 'background_g', 'background_b')
PARAMETERS: node.Parameters = {
    **{name: node.Parameter(default, lambda _: True, '0 to 255, other numbers wrap',
                            'colour of the field; clear and reset read it again')
       for name, default in zip(BACKGROUND, (69, 86, 255))},
    'speed': node.number(1.0, 0.0, 1e6, 'times real time, 0: as fast as possible; if it is not 1, time is simulated'),
    'gui': node.Parameter('auto', lambda value: value in (True, False, 'auto'), 'true, false or auto',
                          'whether to open a window; auto: if there is a display'),
    'png_name': node.Parameter('turtlesim.png', pictures.is_name,
                               'letters, digits, _, . and -, and end with .png',
                               f'name of the picture that save_png writes to {pictures.folder()}; read at each call'),
}
FRAME_PERIOD = 1.0 / 30.0  # [s] between two pictures in the window


def main() -> None:
    """Run the node."""
    window.take_platform(sys.argv)
    node.run('turtlesim', PARAMETERS, lambda: Turtlesim().run(), own_clock=True)


class Turtlesim:
    """The field, the loop that owns it, and topics and services of the turtles."""

    def __init__(self) -> None:
        """Open all topics and services.

        Raises:
            TurtlesimError: a parameter is bad, no window can be opened, or another node publishes /clock.
        """
        gui, speed = node.read(PARAMETERS, 'gui', 'speed')
        background = read_background()
        self._pace = Pace(speed)
        self._window = open_window(gui)
        self._shown = -1  # `Field.changes` of the picture in the window
        self._window_due = time.monotonic()
        self._requests = Requests()
        self._commands: 'queue.SimpleQueue[Tuple[str, List[float]]]' = queue.SimpleQueue()
        self._complained: Dict[str, float] = {}  # by turtle: when the next warning about a wall is due
        self._field = Field(background, rospy.resolve_name)
        self._changing = threading.Lock()  # held while turtles come and go
        self._closing = threading.Thread()
        self._closing.start()
        self._inputs: Dict[str, TurtleInputs] = {}
        self._outputs: Dict[str, TurtleOutputs] = {}
        self._broadcaster = Broadcaster(self._field, self._outputs)
        for name in BACKGROUND:
            if not rospy.has_param(f'~{name}'):
                rospy.set_param(f'~{name}', PARAMETERS[name].default)
        self._pace.begin()
        rospy.loginfo(f'Starting turtlesim with node name {rospy.get_name()}')
        self._open('turtle1')
        for service, kind, handler in (('clear', Empty, self._on_clear), ('reset', Empty, self._on_reset),
                                       ('spawn', Spawn, self._on_spawn), ('kill', Kill, self._on_kill),
                                       ('~save_png', Trigger, self._on_save_png)):
            rospy.Service(service, kind, handler)

    # --- the loop -------------------------------------------------------------------------------------------------

    def run(self) -> None:
        """Move the turtles until ROS shuts down."""
        wake_on_time()
        while not rospy.is_shutdown():
            self._obey()
            self._field.move()
            self._pace.step()
            self._broadcaster.publish()
            self._field.draw()
            self._complain()
            if self._window is not None:
                self._show(self._window)
            self._requests.serve(self._pace.next_step())

    def _obey(self) -> None:
        while not self._commands.empty():
            name, velocity = self._commands.get()
            if name in self._field:
                self._field.command(name, velocity)

    def _complain(self) -> None:
        """Log a warning, once a second, for each turtle that drives against a wall."""
        if not self._field.hits:
            return
        now = time.monotonic()
        for name, x, y in self._field.hits:
            if now >= self._complained.get(name, now):
                rospy.logwarn(f'Oh no! I hit the wall! (Clamping from [x={x:f}, y={y:f}])')
                self._complained[name] = now + COMPLAINT_PERIOD
        self._field.hits.clear()

    def _show(self, shown: window.Window) -> None:
        now = time.monotonic()
        if now < self._window_due:
            return
        self._window_due = now + FRAME_PERIOD
        if self._shown != self._field.changes:
            self._shown = self._field.changes
            shown.show(self._field.picture())
        shown.poll()
        if not shown.is_open:
            rospy.signal_shutdown('the window was closed')

    # --- turtles come and go, in the threads of the services ------------------------------------------------------

    def _open(self, name: str) -> None:
        self._outputs[name] = TurtleOutputs(name, self._broadcaster.changed)
        self._inputs[name] = TurtleInputs(name, self._field, self._requests, self._commands.put)
        self._broadcaster.changed()
        self._tell_spawn(name)

    def _tell_spawn(self, name: str) -> None:
        x, y, theta = self._requests.call(lambda: self._field.pose(name))
        rospy.loginfo(f'Spawning turtle [{name}] at x=[{x:f}], y=[{y:f}], theta=[{theta:f}]')

    def _close(self, names: Iterable[str]) -> None:
        """Close topics and services in a thread: that takes six calls of the master for each turtle."""
        gone: List[Any] = []
        for name in names:
            gone += self._outputs.pop(name), self._inputs.pop(name)
        self._closing = threading.Thread(target=close_all, args=[gone])
        self._closing.start()

    @contextlib.contextmanager
    def _change(self) -> Iterator[None]:
        """Let turtles come or go; the names of those that went before are free."""
        with self._changing:
            self._closing.join()
            yield

    def _on_spawn(self, request: Any) -> SpawnResponse:
        with self._change():
            name = answered(self._requests.call,
                            lambda: self._field.spawn(request.name, request.x, request.y, request.theta))
            self._open(name)
        return SpawnResponse(name)

    def _on_kill(self, request: Any) -> KillResponse:
        def kill() -> None:
            self._field.kill(request.name)
            self._broadcaster.changed()

        with self._change():
            answered(self._requests.call, kill)
            self._close([request.name])
            self._closing.join()
        return KillResponse()

    def _on_reset(self, _: Any) -> EmptyResponse:
        """Restore the initial field; if turtle1 exists, its topics and their connections stay open."""
        def reset() -> None:
            self._field.reset(background)
            self._broadcaster.changed()

        with self._change():
            background = read_background()
            rospy.loginfo('Resetting turtlesim.')
            self._requests.call(reset)
            self._close(set(self._outputs) - {'turtle1'})
            if 'turtle1' in self._outputs:
                self._tell_spawn('turtle1')
            else:
                self._closing.join()
                self._open('turtle1')
        return EmptyResponse()

    # --- the drawing ----------------------------------------------------------------------------------------------

    def _on_clear(self, _: Any) -> EmptyResponse:
        background = read_background()
        rospy.loginfo('Clearing turtlesim.')
        self._requests.call(lambda: self._field.clear(background))
        return EmptyResponse()

    def _on_save_png(self, _: Any) -> TriggerResponse:
        picture = self._requests.call(self._field.picture)
        try:
            [name] = node.read(PARAMETERS, 'png_name')
            path = pictures.save(picture, name)
        except (OSError, TurtlesimError) as error:
            return TriggerResponse(False, str(error))
        return TriggerResponse(True, f'saved {path}')


def close_all(gone: List[Any]) -> None:
    """Close topics and services, and take them from the list."""
    while gone:
        gone.pop().close()
    gc.collect()  # rospy leaves a file descriptor of each topic open until then


def read_background() -> Colour:
    """Return the present background colour of the parameters."""
    red, green, blue = (colour_part(value, PARAMETERS[name].default)
                        for name, value in zip(BACKGROUND, node.read(PARAMETERS, *BACKGROUND)))
    return red, green, blue


def open_window(gui: Any) -> Optional[window.Window]:
    """Open a window if one is wanted and possible.

    Args:
        gui: True, False or 'auto'.

    Raises:
        TurtlesimError: gui is True and no window can be opened.
    """
    if gui is False or gui == 'auto' and window.is_unseen():
        return None
    why_none = window.why_none()
    if not why_none:
        return window.Window(f'TurtleSim {rospy.get_name()}')
    if gui is True:
        raise TurtlesimError(f'gui is true, but {why_none}')
    rospy.loginfo(f'no window: {why_none}')
    return None
