"""The robots of a simulator: their topics, services and frames, and how they come and go."""

import gc
from typing import Callable, Dict, List, Optional

import rosgraph
import rospy
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from rumba_sim.model.common.errors import WorldError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.common.name import check_name
from rumba_sim.model.simulation.robot import nth_name
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.common.conversions import transform
from rumba_sim.ros.common.frames import MAP, WORLD
from rumba_sim.ros.participants.examiner import ExaminerServer
from rumba_sim.ros.participants.requests import Requests
from rumba_sim.ros.robot import packed
from rumba_sim.ros.robot.latecomers import Latecomers
from rumba_sim.ros.robot.localisation import SLAM, TRUTH, true_frame
from rumba_sim.ros.robot.map_anchor import MapAnchor
from rumba_sim.ros.robot.rates import EVERYTHING, Due
from rumba_sim.ros.robot.robot_node import RobotNode
from rumba_sim.ros.simulator.diagnostics import Diagnostics
from rumba_sim.ros.simulator.settings import Settings


class Fleet:
    """All robots of a world, as those who listen to them see them; only the owner of the world calls it.

    Attributes:
        settings: those in force.
    """

    def __init__(self, world: World, settings: Settings, requests: Requests, diagnostics: Diagnostics,
                 stamp: Callable[[], rospy.Time], is_held: Callable[[], bool],
                 on_command: Callable[[str], None], examiner: Optional[ExaminerServer]) -> None:
        """Open the topics of the robots that the world has.

        Args:
            world: where the robots are.
            settings: those in force.
            requests: to the owner of the world.
            diagnostics: where the batteries are reported.
            stamp: gives the present time.
            is_held: whether the world waits for those who come late: they are sent what they have missed.
            on_command: called after each velocity, with the full name of its topic, in a thread of rospy.
            examiner: in an examination, gets everything of the robots.

        Raises:
            WorldError: another node has a robot of that name.
        """
        self.settings = settings
        self._world = world
        self._requests = requests
        self._diagnostics = diagnostics
        self._stamp = stamp
        self._is_held = is_held
        self._on_command = on_command
        self._examiner = examiner
        self._robots: Dict[str, RobotNode] = {}
        self._anchors: Dict[str, MapAnchor] = {}  # of robots that may make a map
        self._map: List[TransformStamped] = []  # where that is; none if it is unknown
        self._kept: List[bytes] = []  # transforms that were not published yet
        self._tf = rospy.Publisher('/tf', TFMessage, Latecomers(requests, self._missed_transforms), queue_size=100)
        self._tf_static = rospy.Publisher('/tf_static', TFMessage, queue_size=10, latch=True)
        for name in world.robots:
            self._open(name)

    # --- in each tick ---------------------------------------------------------------------------------------------

    def apply_commands(self) -> None:
        """Give each robot the newest velocity that counts, if one came since the last tick."""
        for robot in self._robots.values():
            robot.apply_command()

    def forget_commands(self) -> None:
        """Do not give the robots what came since the last tick."""
        for robot in self._robots.values():
            robot.forget_command()

    def publish(self, due: Due, keep_transforms: bool = False) -> None:
        """Publish what is due; transforms that are kept are published with those of a later tick."""
        for robot in self._robots.values():
            robot.publish(due, self.settings.paced_rates, self._stamp())
        if due.scan:
            for name, anchor in self._anchors.items():
                anchor.note(self._stamp(), self._world.robots[name].pose)
        if due.odom and self._tf.get_num_connections():
            self._kept += self._transforms()
        if not keep_transforms:
            self.publish_transforms()

    def publish_transforms(self) -> None:
        """Publish the transforms that were kept."""
        if self._kept:
            self._tf.publish(packed.transforms(self._kept))
            self._kept = []

    def is_commanded(self, topic: str) -> bool:
        """Whether a topic, given by its full name, is one of the velocities of a robot, and has a publisher."""
        return any(robot.is_commanded(topic) for robot in self._robots.values())

    def _transforms(self) -> List[bytes]:
        return [part for robot in self._robots.values() for part in robot.transforms()]

    def _missed_transforms(self) -> Optional[rospy.AnyMsg]:
        return packed.transforms(self._transforms()) if self._is_held() else None

    # --- robots come and go ---------------------------------------------------------------------------------------

    def spawn(self, name: str = '', pose: Optional[Pose] = None) -> str:
        """Put a robot into the world; returns its name.

        Args:
            name: of the robot; empty: the first of rumba, rumba2, rumba3, ... that is free.
            pose: of the robot; None: as near to the start of the map as possible.

        Raises:
            WorldError: the name or the pose is wrong or taken, or the master does not answer.
        """
        name = name or self._free_name()
        check_name(name)
        if not rosgraph.is_master_online():  # otherwise its topics could not be registered, and time would stand still
            raise WorldError('the master does not answer: a robot needs it for its topics')
        self._world.spawn(name, pose, self.settings.percentage / 100.0, self.settings.brushes_up)
        try:
            self._open(name)
        except Exception:
            self._world.kill(name)
            raise
        if self._is_held():  # whoever works for the robot shall be able to answer
            self._robots[name].publish(EVERYTHING, self.settings.paced_rates, self._stamp())
            self._tf.publish(packed.transforms(self._transforms()))
        return name

    def kill(self, name: str) -> None:
        """Take a robot out of the world.

        Raises:
            WorldError: there is no robot of that name.
        """
        self._world.kill(name)
        self._robots.pop(name).close()
        if name in self._anchors:
            self._anchors.pop(name).close()
        gc.collect()  # rospy leaves a file descriptor of each topic open until then
        self._diagnostics.remove(name)
        self._tell_static()

    def _free_name(self) -> str:
        names = map(nth_name, range(1, len(self._robots) + 2))
        return next(name for name in names if name not in self._robots)

    def _open(self, name: str) -> None:
        self._robots[name] = RobotNode(self._world, name, self._requests, self.settings.localisation == TRUTH,
                                       self._stamp(), is_held=self._is_held, on_command=self._on_command,
                                       examiner=self._examiner, frame=true_frame(self.settings.localisation),
                                       interface=self.settings.interface)
        if self.settings.localisation == SLAM and not self.settings.exam:
            self._anchors[name] = MapAnchor(name, self._requests, self._place_map)
        self._diagnostics.add(name, lambda: self._world.robots[name])
        self._tell_static()

    def _tell_static(self) -> None:
        parts = [part for robot in self._robots.values() for part in robot.static_transforms()]
        self._tf_static.publish(self._map + parts)

    def _place_map(self, pose: Pose) -> None:
        """Tell where the map that a robot makes is in the world."""
        self._map = [transform(WORLD, MAP, pose, self._stamp())]
        self._tell_static()
