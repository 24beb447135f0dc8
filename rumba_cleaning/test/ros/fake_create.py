#!/usr/bin/env python3
"""A Create and its driver that know nothing of Rumba: the topics of create_driver, a laser, and a dock with beams.

It publishes and subscribes to what create_driver does, below `/`, with messages of create_msgs; beside that `/scan`, of
a laser that somebody mounted on it, and `/clock`. Once told to dock, it is passive, and follows the beams of its dock
by itself: it knows neither map nor position, only what its receivers get. In full mode it obeys, and does not charge.
It judges by itself what its brush has swept: `/coverage` (std_msgs/Float32). As fake_robot, it waits for those who
drive it: for a velocity or what comes on the topic `~answer` while they let it dock, and for what comes on the topic
`~witness`. `~fault` plants a fault: `no beams` of a dock that is not plugged in, `lifted` wheels after half a minute.
"""

import math
import threading
import time
import warnings

import numpy as np
import rospy
import tf2_msgs.msg
from create_msgs.msg import Bumper, ChargingState, Cliff, Mode, MotorSetpoint
from fake_create_dock import Dock, Firmware
from fake_robot import DT, Judge, Room, Walls, has_ended, live, moved, transform, turned
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Empty, Float32, Header, UInt16

RADIUS, BASE, BRUSH, LASER, STEPS = 0.17425, 0.235, 0.17, 0.04, 5  # [m]
LATCH = 0.2  # [s] after which create_driver stops a robot that gets no command
CAPACITY = 2.7  # [Ah]
IDLE, WHEELS, BRUSHES = 0.1, 0.5, 0.4  # shares of the load of a robot that cleans at 0.3 m/s
TRICKLE_AT = 0.999
ROOMS = {
    'room': (Room((2.6, 2.2), [(2.0, 0.0, 2.6, 0.5)], (0.8, 2.2 - 0.05 - RADIUS, math.pi / 2)), Dock(0.8, 2.2)),
    'furnished': (Room((5.0, 4.0), [
        (1.6, 3.2, 2.6, 4.0), (0.0, 2.6, 0.5, 3.4), (3.2, 1.2, 3.9, 2.0), (4.4, 0.0, 5.0, 1.0),
        *((x, y, x + 0.05, y + 0.05) for x in (1.2, 1.8) for y in (1.1, 1.7))],
        (3.6, 4.0 - 0.05 - RADIUS, math.pi / 2)), Dock(3.6, 4.0))}


NEWS = threading.Condition()  # something came for which it waits


class FakeCreate:
    """The robot, its firmware, its driver and its world."""

    def __init__(self):
        self.random = np.random.default_rng(rospy.get_param('~seed', 1))
        self.scale = self.random.normal(1.0, 0.01, 2)  # of each wheel
        self.fault = rospy.get_param('~fault', '')
        room, self.dock = ROOMS[rospy.get_param('~room', 'room')]
        self.dock.sends = self.fault != 'no beams'
        self.seen = Walls(room)  # by the laser, which looks over the dock
        body = room._replace(boxes=[*room.boxes, self.dock.body])
        x, y, theta = room.start
        self.solid, self.judge = Walls(body, RADIUS), Judge(body._replace(start=(x, y - 0.5, theta)), RADIUS, BRUSH)
        self.pose, self.guess, self.wheels = np.array(room.start), np.zeros(3), np.zeros(2)
        self.bumped = False, False
        self.mode, self.duties, self.firmware = Mode.MODE_FULL, {}, None  # the driver begins in full mode
        self.charge = rospy.get_param('~charge', 1.0)
        self.lasts, self.fills = rospy.get_param('~lasts', 3600.0), rospy.get_param('~fills', 3600.0)  # [s]
        self.command, self.commanded, self.corrected = Twist(), None, rospy.Time()
        self.answered = {}  # when each of those came on whom it waits
        self.waits = rospy.get_param('~wait_for_correction', False)
        self.now = rospy.Time(100)
        self.publishers = {}
        if self.fault != 'no tf':
            self.publish('/tf_static', tf2_msgs.msg.TFMessage(
                [transform(self.now, 'base_footprint', 'laser', (LASER, 0.0, 0.0))]), latch=True)
        for topic, kind, take in (('cmd_vel', Twist, self.take), ('dock', Empty, self.seek_dock),
                                  ('undock', Empty, self.obey), ('tf', tf2_msgs.msg.TFMessage, self.hear)):
            rospy.Subscriber(f'/{topic}', kind, take)
        for whose in ('answer', 'witness'):
            rospy.Subscriber(rospy.get_param(f'~{whose}', f'/{whose}'), rospy.AnyMsg, self.take_answer, whose)
        for motor in ('main_brush_motor', 'side_brush_motor', 'vacuum_motor'):
            rospy.Subscriber(f'/{motor}', MotorSetpoint, self.take_duty, motor)

    # --- what it is told --------------------------------------------------------------------------------------------

    def take(self, message):
        """Take a velocity, which a passive robot ignores."""
        self.command, self.commanded = message, self.now
        self.take_answer(message, 'answer')

    def take_answer(self, _, whose):
        """Note that one of those who drive has heard everything so far."""
        with NEWS:
            self.answered[whose] = self.now
            NEWS.notify()

    def take_duty(self, message, motor):
        """Have a brush turn, unless the robot is passive."""
        if self.mode == Mode.MODE_FULL:
            self.duties[motor] = message.duty_cycle

    def seek_dock(self, _):
        """Become passive, and find the dock."""
        self.mode, self.duties, self.firmware = Mode.MODE_PASSIVE, {}, Firmware()

    def obey(self, _):
        """Be in full mode, and stand."""
        self.mode, self.firmware = Mode.MODE_FULL, None

    def hear(self, message):
        """Note that somebody knows where the robot was when it took a scan."""
        for each in message.transforms:
            if each.header.frame_id == 'map':
                with NEWS:
                    self.corrected = each.header.stamp
                    NEWS.notify()

    # --- what happens -------------------------------------------------------------------------------------------------

    @property
    def is_on_contacts(self):
        """Whether the robot stands on the dock, plugged in or not."""
        return self.dock.touches(self.pose, RADIUS)

    @property
    def charging_state(self):
        """As the charger tells it: a robot in full mode does not charge."""
        if not self.is_on_contacts or self.mode != Mode.MODE_PASSIVE:
            return ChargingState.CHARGE_NONE
        return ChargingState.CHARGE_TRICKLE if self.charge >= TRICKLE_AT else ChargingState.CHARGE_FULL

    def step(self):
        """Live for DT, and tell of it."""
        self.now += rospy.Duration(DT)
        self.publish('/clock', Clock(self.now))
        is_charging = self.charging_state != ChargingState.CHARGE_NONE
        v, w = self.wanted(is_charging)
        wanted = np.array([v - w * BASE / 2, v + w * BASE / 2]) if self.charge > 0.0 else np.zeros(2)
        self.bumped = False, False
        for _ in range(STEPS):
            self.move(wanted)
        load = IDLE + WHEELS * abs(self.wheels).mean() / 0.3 + BRUSHES * bool(self.duties.get('main_brush_motor'))
        self.charge += DT / self.fills if is_charging else -DT * load / self.lasts
        self.charge = min(max(self.charge, 0.0), 1.0)
        self.tell()

    def wanted(self, is_charging):
        """The velocity of the driver, or of the firmware."""
        if self.mode == Mode.MODE_PASSIVE:
            return (0.0, 0.0) if is_charging or self.firmware is None else self.firmware.step(
                self.dock.received(self.pose, self.seen), self.bumped, self.guess)
        is_old = self.commanded is None or (self.now - self.commanded).to_sec() > LATCH
        return (0.0, 0.0) if is_old else (self.command.linear.x, self.command.angular.z)

    def move(self, wanted):
        """Turn the wheels for a part of DT; what is in the way stops the body, and presses the bumper."""
        self.wheels += np.clip(wanted - self.wheels, -1.0 * DT / STEPS, 1.0 * DT / STEPS)
        went = self.wheels * DT / STEPS
        x, y, theta = moved(self.pose, went, BASE)
        if self.solid.leave_free(x, y):
            self.pose = np.array([x, y, theta])
        else:
            touched = self.solid.nearest(x, y) - (x, y)
            angle = math.remainder(math.atan2(touched[1], touched[0]) - theta, math.tau)
            self.bumped = (self.bumped[0] or -0.2 < angle < 1.3, self.bumped[1] or -1.3 < angle < 0.2)
            self.pose = np.array([*self.pose[:2], theta])
        self.guess = moved(self.guess, went * self.scale + self.random.normal(0.0, 0.002, 2) * np.sqrt(abs(went)), BASE)
        if self.duties.get('main_brush_motor'):
            self.judge.sweep(*self.pose)

    # --- what it tells ------------------------------------------------------------------------------------------------

    def publish(self, topic, message, latch=False):
        """Publish a message; the first one opens the topic."""
        if topic not in self.publishers:
            self.publishers[topic] = publisher(topic, type(message), latch)
        self.publishers[topic].publish(message)

    def tell(self):
        """Publish what the driver and the laser do, in the order of `CreateDriver::update`."""
        odometry = Odometry(header=Header(stamp=self.now, frame_id='odom'), child_frame_id='base_footprint')
        odometry.pose.pose.position.x, odometry.pose.pose.position.y = self.guess[:2]
        odometry.pose.pose.orientation = turned(self.guess[2])
        self.publish('/tf', tf2_msgs.msg.TFMessage([transform(self.now, 'odom', 'base_footprint', self.guess)]))
        self.publish('/odom', odometry)
        header = Header(stamp=self.now, frame_id='base_footprint')
        self.publish('/battery/charge', Float32(self.charge * CAPACITY))
        self.publish('/battery/capacity', Float32(CAPACITY))
        self.publish('/battery/charge_ratio', Float32(self.charge))
        self.publish('/battery/charging_state', ChargingState(header, self.charging_state))
        self.publish('/ir_omni', UInt16(self.dock.received(self.pose, self.seen).omni))
        self.publish('/mode', Mode(header, self.mode))
        self.publish('/bumper', Bumper(header=header, is_left_pressed=self.bumped[0], is_right_pressed=self.bumped[1]))
        self.publish('/cliff', Cliff(header=header))
        if self.fault == 'lifted' and self.now.to_sec() > 130.0:
            self.publish('/wheeldrop', Empty())
        self.publish('/scan', self.scan())
        self.publish('/coverage', Float32(self.judge.coverage()))

    def scan(self):
        """What the laser sees: all around from straight ahead on."""
        x, y, theta = self.pose
        angles = np.arange(360) * math.pi / 180
        found = self.seen.ranges(x + LASER * math.cos(theta), y + LASER * math.sin(theta), theta + angles)
        found += self.random.normal(0.0, 0.01, 360)
        return LaserScan(Header(stamp=self.now, frame_id='laser'), 0.0, angles[-1], math.pi / 180, 0.0, DT, 0.1, 12.0,
                         np.float32(found).tolist(), [])

    def is_followed(self):
        """Whether those on whom it waits have answered what it last told."""
        return not (self.waits and self.corrected < self.now) and all(
            when >= self.now for when in self.answered.values())

    def run(self):
        """Live, as fast as the others keep up, but at most ten times as fast as the real one would."""
        while not has_ended():
            begin = time.monotonic()
            self.step()
            with NEWS:
                NEWS.wait_for(self.is_followed, 1.0)
            time.sleep(max(begin + DT / 10 - time.monotonic(), 0.0))


def publisher(topic, kind, latch=False):
    """A publisher that writes by itself: a queue takes a thread for each reader, and most of the CPU time of a fake."""
    with warnings.catch_warnings():
        warnings.simplefilter('ignore', SyntaxWarning)  # that it has no queue
        return rospy.Publisher(topic, kind, latch=latch, queue_size=None)


if __name__ == '__main__':
    live('fake_create', FakeCreate)
