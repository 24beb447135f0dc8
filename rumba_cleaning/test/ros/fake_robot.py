#!/usr/bin/env python3
"""A robot that knows nothing of Rumba: differential drive, a room, a laser off its centre, odometry that errs.

It takes `/base/velocity` and publishes `/base/odometry`, `/front/laser` and `/clock`, and judges by itself what its
brush has swept: `/coverage` (std_msgs/Float32) of the floor that it can reach. It drives as fast as those keep up who
drive it: with the parameter `~wait_for_correction` it waits for map -> wheels, and once it was commanded, for the next
command. Nobody else is waited for, and `~haste` is how many times as fast as the real one it is then.
The parameter `~fault` plants one of the faults that owners of robots make.
"""

import math
import os
import signal
import time
from typing import List, NamedTuple, Tuple

import numpy as np
import rospy
import tf2_msgs.msg
from geometry_msgs.msg import Quaternion, TransformStamped, Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from scipy import ndimage
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32, Header

RADIUS, BASE, BRUSH, LASER, DT, STEPS = 0.16, 0.2, 0.2, 0.05, 0.1, 10  # [m], [s]
CELL = 0.01  # [m]


class Room(NamedTuple):
    """Walls from (0, 0) to its size, and boxes (x0, y0, x1, y1) in it [m]."""

    size: Tuple[float, float]
    boxes: List[Tuple[float, float, float, float]]
    start: Tuple[float, float, float] = (0.8, 0.5, 0.4)  # [m], [rad]


ROOMS = {
    'furnished': Room((5.0, 4.0), [
        (1.6, 3.2, 2.6, 4.0), (0.0, 2.6, 0.5, 3.4), (3.2, 1.2, 3.9, 2.0), (4.4, 0.0, 5.0, 1.0),
        *((x, y, x + 0.05, y + 0.05) for x in (1.2, 1.8) for y in (1.1, 1.7))]),  # the last four: legs of a table
    'chamber': Room((2.4, 2.0), [(1.6, 0.0, 2.0, 0.6)])}


def sides(x0, y0, x1, y1):
    """The four sides of a rectangle: corners and the next ones, (4, 2) each."""
    corners = np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], float)
    return corners, np.roll(corners, -1, axis=0)


def draw(room, path):
    """Write the map of a room: path.yaml and path.pgm, with a wall of 10 cm around it."""
    xs, ys = (np.arange(-0.1 + CELL, size + 0.1, 2 * CELL) for size in room.size)
    x, y = np.meshgrid(xs, ys)
    free = (x > 0) & (x < room.size[0]) & (y > 0) & (y < room.size[1])
    for x0, y0, x1, y1 in room.boxes:
        free &= ~((x > x0) & (x < x1) & (y > y0) & (y < y1))
    with open(f'{path}.pgm', 'wb') as image:
        image.write(b'P5 %d %d 255\n' % (len(xs), len(ys)) + np.uint8(np.where(free[::-1], 254, 0)).tobytes())
    with open(f'{path}.yaml', 'w', encoding='utf-8') as file:
        file.write(f'{{image: {os.path.basename(path)}.pgm, resolution: {2 * CELL}, origin: [-0.1, -0.1, 0.0], '
                   'negate: 0, occupied_thresh: 0.65, free_thresh: 0.196}\n')


class Walls:
    """Those of a room, and of what stands in it, for a robot of a radius [m]."""

    def __init__(self, room, radius=RADIUS):
        self.radius = radius
        self.begin, self.end = (np.concatenate(part) for part in zip(sides(0, 0, *room.size),
                                                                     *(sides(*box) for box in room.boxes)))

    def ranges(self, x, y, angles):
        """How far they are in some directions, (n) [m]."""
        dx, dy = np.cos(angles)[:, None], np.sin(angles)[:, None]
        ex, ey = (self.end - self.begin).T
        fx, fy = self.begin[:, 0] - x, self.begin[:, 1] - y
        with np.errstate(divide='ignore', invalid='ignore'):
            crossing = dx * ey - dy * ex
            along, share = (fx * ey - fy * ex) / crossing, (fx * dy - fy * dx) / crossing
        return np.where((along > 0) & (share >= 0) & (share <= 1), along, np.inf).min(axis=1)

    def nearest(self, x, y):
        """The nearest point of them, (2) [m]."""
        edge = self.end - self.begin
        share = (((x, y) - self.begin) * edge).sum(1) / (edge ** 2).sum(1)
        points = self.begin + np.clip(share, 0, 1)[:, None] * edge
        return points[np.hypot(*(points - (x, y)).T).argmin()]

    def leave_free(self, x, y):
        """Whether the robot can stand somewhere."""
        return math.hypot(*(self.nearest(x, y) - (x, y))) >= self.radius


class Judge:
    """What a brush of a width has swept of what it can reach on a robot of a radius [m]."""

    def __init__(self, room, radius=RADIUS, brush=BRUSH):
        self.brush = brush
        self.x, self.y = np.meshgrid(*(np.arange(CELL / 2, size, CELL) for size in room.size))
        wall = np.zeros(self.x.shape, bool)
        for x0, y0, x1, y1 in room.boxes:
            wall |= (self.x > x0) & (self.x < x1) & (self.y > y0) & (self.y < y1)
        clear = CELL * ndimage.distance_transform_edt(np.pad(~wall, 1))[1:-1, 1:-1] > radius
        rooms, _ = ndimage.label(clear)
        there = rooms == rooms[int(room.start[1] / CELL), int(room.start[0] / CELL)]
        self.reachable = CELL * ndimage.distance_transform_edt(~there) < brush / 2
        self.swept = np.zeros(self.x.shape, bool)

    def sweep(self, x, y, theta):
        """The brush, 2 cm long, is at a pose."""
        rows, columns = (slice(max(int((at - self.brush) / CELL), 0), int((at + self.brush) / CELL)) for at in (y, x))
        dx, dy = self.x[rows, columns] - x, self.y[rows, columns] - y
        ahead, aside = dx * math.cos(theta) + dy * math.sin(theta), dy * math.cos(theta) - dx * math.sin(theta)
        self.swept[rows, columns] |= (abs(ahead) < 0.01) & (abs(aside) < self.brush / 2)

    def coverage(self):
        """Share [0..1]."""
        return float((self.swept & self.reachable).sum() / self.reachable.sum())


class FakeRobot:
    """The robot, its driver and its world."""

    def __init__(self):
        self.random = np.random.default_rng(rospy.get_param('~seed', 1))
        self.scale = self.random.normal(1.0, 0.01, 2)  # of each wheel
        room = ROOMS[rospy.get_param('~room', 'furnished')]
        self.walls, self.judge = Walls(room), Judge(room)
        self.pose, self.guess, self.wheels = np.array(room.start), np.zeros(3), np.zeros(2)
        self.command, self.commanded, self.corrected = Twist(), None, rospy.Time()
        self.waits = rospy.get_param('~wait_for_correction', False)
        self.haste = rospy.get_param('~haste', 10)
        self.fault = rospy.get_param('~fault', '')
        self.now = rospy.Time(100)
        self.clock = rospy.Publisher('/clock', Clock, queue_size=1)
        self.odometry = rospy.Publisher('/base/odometry', Odometry, queue_size=10)
        self.scan = rospy.Publisher('/front/laser', LaserScan, queue_size=10)
        self.covered = rospy.Publisher('/coverage', Float32, queue_size=1, latch=True)
        self.tf = rospy.Publisher('/tf', tf2_msgs.msg.TFMessage, queue_size=10)
        self.static = rospy.Publisher('/tf_static', tf2_msgs.msg.TFMessage, queue_size=1, latch=True)
        if self.fault != 'no tf':
            self.static.publish([transform(self.now, 'chassis', 'front_laser', (LASER, 0.0, 0.0))])
        rospy.Subscriber('/base/velocity', Twist, self.take)
        rospy.Subscriber('/tf', tf2_msgs.msg.TFMessage, self.hear)

    def take(self, message):
        """Take a command."""
        self.command, self.commanded = message, self.now

    def hear(self, message):
        """Note that somebody knows where the robot was when it took a scan."""
        for each in message.transforms:
            if each.header.frame_id == 'map':
                self.corrected = each.header.stamp

    def step(self):
        """Drive for DT, and tell of it."""
        self.now += rospy.Duration(DT)
        self.clock.publish(self.now)
        is_old = self.commanded is None or (
            (self.now - self.commanded).to_sec() > 0.6 and self.fault != 'no watchdog')
        v, w = (0.0, 0.0) if is_old else (self.command.linear.x, self.command.angular.z)
        wanted = np.array([v - w * BASE / 2, v + w * BASE / 2])
        for _ in range(STEPS):
            self.wheels += np.clip(wanted - self.wheels, -1.0 * DT / STEPS, 1.0 * DT / STEPS)
            went = self.wheels * DT / STEPS
            x, y, theta = moved(self.pose, went)
            self.pose = np.array([x, y, theta]) if self.walls.leave_free(x, y) else np.array([*self.pose[:2], theta])
            self.guess = moved(self.guess, went * self.scale + self.random.normal(0.0, 0.002, 2) * np.sqrt(abs(went)))
            self.judge.sweep(*self.pose)
        self.tell()

    def tell(self):
        """Publish odometry and scan."""
        x, y, theta = self.guess * {'mirrored odometry': (1, -1, -1), 'odometry stands': (0, 0, 0)}.get(
            self.fault, (1, 1, 1))
        stamp = {'old odometry': self.now - rospy.Duration(9), 'no stamps': rospy.Time()}.get(self.fault, self.now)
        frame = 'odom' if self.fault == 'other odom frame' else 'wheels'
        message = Odometry(header=Header(stamp=stamp, frame_id=frame), child_frame_id='chassis')
        message.pose.pose.position.x, message.pose.pose.position.y = x, y
        message.pose.pose.orientation = turned(theta)
        message.pose.pose.orientation.w *= self.fault != 'no quaternion'
        if self.fault != 'silent odometry':
            self.odometry.publish(message)
        self.tf.publish([transform(self.now, 'wheels', 'chassis', self.guess)])
        x, y, theta = self.pose
        angles = np.arange(360) * math.pi / 180
        seen = {'turned laser': angles + math.pi / 2, 'laser upside down': -angles}.get(self.fault, angles)
        found = self.walls.ranges(x + LASER * math.cos(theta), y + LASER * math.sin(theta), theta + seen)
        found = (found + self.random.normal(0.0, 0.01, 360)) * (1000 if self.fault == 'millimetres' else 1)
        tick = round(self.now.to_sec() / DT)
        if self.fault != 'silent scan' and (self.fault != 'slow scan' or tick % 10 == 0):
            self.scan.publish(LaserScan(
                Header(stamp=self.now - rospy.Duration(3 * (self.fault == 'old scan')),
                       frame_id='lidar' if self.fault == 'wrong frame' else 'front_laser'),
                0.0, angles[-1], math.pi / 180, 0.0, DT, 0.1, 12000.0 if self.fault == 'millimetres' else 12.0,
                np.float32(found).tolist(), []))
        self.covered.publish(self.judge.coverage())

    def run(self):
        """Drive, as fast as the others keep up, but at most `haste` times as fast as the real one would."""
        while not has_ended():
            begin = time.monotonic()
            self.step()
            while not has_ended() and time.monotonic() - begin < 1.0 and (
                    self.waits and self.corrected < self.now or time.monotonic() - begin < DT / self.haste
                    or self.commanded is not None and self.commanded < self.now):
                time.sleep(0.001)


def moved(pose, went, base=BASE):
    """Where a pose is after both wheels, which are apart by a base, went some way."""
    x, y, theta = pose
    way, turn = went.mean(), (went[1] - went[0]) / base
    return np.array([x + way * math.cos(theta + turn / 2), y + way * math.sin(theta + turn / 2), theta + turn])


def turned(theta):
    """A heading as a quaternion."""
    return Quaternion(0.0, 0.0, math.sin(theta / 2), math.cos(theta / 2))


def transform(stamp, parent, child, pose):
    """A transform in the plane."""
    found = TransformStamped(header=Header(stamp=stamp, frame_id=parent), child_frame_id=child)
    found.transform.translation.x, found.transform.translation.y = pose[:2]
    found.transform.rotation = turned(pose[2])
    return found


SIGNALS = []  # that told it to end


def has_ended():
    """Whether it was told to."""
    return bool(SIGNALS) or rospy.is_shutdown()


def live(name, kind):
    """Have a robot of a kind live as a node of a name.

    What rospy does at a signal may wait for ever, for what the publishing that it interrupts holds.
    """
    rospy.init_node(name, disable_rostime=True, disable_signals=True)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda received, _: SIGNALS.append(received))
    kind().run()
    rospy.signal_shutdown('told to end')


if __name__ == '__main__':
    live('fake_robot', FakeRobot)
