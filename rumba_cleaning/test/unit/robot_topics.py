"""A robot's topics without ROS, for tests of what the cleaner reads."""

import types

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped, Quaternion, Transform, TransformStamped, Vector3
from sensor_msgs.msg import BatteryState
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

from rumba_cleaning.ros.cleaner.robots import certainty, location, senses
from rumba_msg.msg import Bumper, CleaningStatus, Cliff, DockStatus, Lockstep
from rumba_sim.model.common.geometry import Pose
from rumba_sim.ros.common.conversions import transform

WORLD = 'run', 0  # and number of resets, of a world in lockstep


class Robot:
    """A robot's topics without ROS: what it publishes goes straight to the subscribers."""

    def __init__(self, monkeypatch, name='rumba', lockstep=None, expected=''):
        self._name = name
        self.lockstep = lockstep
        self._callbacks = {}
        self.connections = 1
        self.expected = expected  # the topic that has a publisher already
        self.readings = 0
        monkeypatch.setattr(senses.rospy, 'Subscriber', self._subscribe)
        monkeypatch.setattr(certainty, '_has_publisher', lambda topic: topic == self.expected)
        self.warnings = []
        monkeypatch.setattr(location.rospy, 'logwarn_throttle', lambda _, line: self.warnings.append(line))
        self.senses = senses.Senses(name, self._count, lambda: self.lockstep)

    def _subscribe(self, topic, _, callback, *arguments, **__):
        self._callbacks[topic] = lambda message: callback(message, *arguments)
        return types.SimpleNamespace(get_num_connections=lambda: self.connections, resolved_name=topic)

    def _count(self):
        self.readings += 1

    def tells(self, topic, message):
        """Publish a message."""
        self._callbacks[f'{self._name}/{topic}'](message)

    def reads(self, seconds, topics=('bumper', 'cliff', 'dock_status'), **fields):
        """Publish parts of a reading, in this order, with one stamp; returns how many readings that completed."""
        before = self.readings
        kinds = {'bumper': Bumper, 'cliff': Cliff, 'dock_status': DockStatus}
        for topic in topics:
            mine = {name: value for name, value in fields.items() if name in kinds[topic].__slots__}
            self.tells(topic, kinds[topic](header=Header(stamp=rospy.Time.from_sec(seconds)), **mine))
        return self.readings - before

    def stands(self, odom=Pose(0.0, 0.0, 0.0), base=Pose(0.0, 0.0, 0.0), topic='/tf'):
        """Tell tf the pose of the odom frame, and that of the robot in it, 10 s later."""
        prefix = '' if self._name == 'rumba' else f'{self._name}/'
        for frame, child, pose, seconds in (('map', f'{prefix}odom', odom, 1),
                                            (f'{prefix}odom', f'{prefix}base_footprint', base, 11)):
            self.transforms(transform(frame, child, pose, rospy.Time(seconds)), topic=topic)

    def transforms(self, *transforms, topic='/tf'):
        """Publish transforms in one message."""
        self._callbacks[topic](TFMessage(list(transforms)))


def standing(monkeypatch):
    """A robot that stands at the origin, with half its charge."""
    robot = Robot(monkeypatch)
    robot.stands()
    robot.tells('battery_state', BatteryState(percentage=0.5))
    return robot


def odometry(x=1.0, y=2.0, z=0.0, rotation=(0.0, 0.0, 0.0, 1.0), stamp=rospy.Time(5), frame='odom',
             child='base_footprint'):
    """A transform with any numbers and names."""
    return TransformStamped(Header(0, stamp, frame), child, Transform(Vector3(x, y, z), Quaternion(*rotation)))


def believes(stamp, **covariance):
    """What a localisation tells: entries of the covariance by their number, such as c35."""
    message = PoseWithCovarianceStamped(header=Header(stamp=stamp))
    for name, value in covariance.items():
        message.pose.covariance[int(name[1:])] = value
    return message


def parts_of(stamp):
    """What a world in lockstep publishes up to a control tick: a function for each message."""
    header = Header(stamp=stamp)
    return {
        'bumper': lambda robot: robot.tells('bumper', Bumper(header=header)),
        'cliff': lambda robot: robot.tells('cliff', Cliff(header=header)),
        'dock_status': lambda robot: robot.tells('dock_status', DockStatus(header=header)),
        'battery_state': lambda robot: robot.tells('battery_state', BatteryState(header=header, percentage=0.5)),
        'cleaning_status': lambda robot: robot.tells('cleaning_status', CleaningStatus(header=header)),
        'tf': lambda robot: robot.transforms(odometry(stamp=stamp), odometry(stamp=stamp, frame='map', child='odom')),
        'tick': lambda robot: robot.senses.on_tick(Lockstep(header, *WORLD, stamp, rospy.Time(), stamp))}
