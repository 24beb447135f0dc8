"""Faults that are planted into real nodes: each is a function that changes classes of the node."""

import math
import os
import socket
import sys
import threading
import time

from planting import after, after_import, before, die, is_odd, on_message, texts

FOR_EVER = 1e6  # [s]
BODY = 'a planted fault'
HANG = threading.Event()
kept = []  # what leaks


# --- leaks -----------------------------------------------------------------------------------------------------------

def file_for_each_goal():
    from rumba_cleaning.ros.cleaner.cleaner import Cleaner
    before(Cleaner, '_accept', lambda *_: kept.append(open(os.devnull)))


def memory_for_each_goal():
    from rumba_cleaning.ros.cleaner.cleaner import Cleaner
    before(Cleaner, '_accept', lambda *_: kept.append(os.urandom(50_000)))


def thread_for_each_robot():
    from rumba_sim.ros.simulator.fleet import Fleet
    before(Fleet, 'kill', lambda *_: threading.Thread(target=time.sleep, args=[FOR_EVER], daemon=True).start())


def socket_for_each_visit():
    from tornado.websocket import WebSocketHandler
    before(WebSocketHandler, '__init__', lambda *_: kept.append(socket.socket()))


def socket_for_each_caller():
    from rosgraph.xmlrpc import ThreadingXMLRPCServer
    before(ThreadingXMLRPCServer, 'process_request', lambda _, request, *__: kept.append(os.dup(request.fileno())))


# --- what is true in the world ---------------------------------------------------------------------------------------

def charge_below_zero():
    from rumba_sim.ros.common import conversions
    after(conversions, 'battery_state', lambda message: _set(message, charge=-0.1))


def percentage_below_zero():
    from rumba_sim.ros.common import conversions
    after(conversions, 'battery_status', lambda message: _set(message, percentage_battery=-5))


def _set(message, **fields):
    for name, value in fields.items():
        setattr(message, name, value)
    return message


def pose_that_is_no_number():
    from rumba_sim.model.common.errors import RumbaError
    from rumba_sim.model.common.geometry import Pose
    from rumba_sim.ros.robot.packed import OdometryPacker
    from rumba_sim.ros.robot.robot_node import RobotNode
    teleport, message, refused = RobotNode._teleport, OdometryPacker.message, []

    def planted(self, pose):
        try:
            teleport(self, pose)
        except RumbaError:
            refused.append(pose)
            raise

    def packed(self, stamp, pose, *more):
        return message(self, stamp, Pose(math.nan, 0.0, 0.0) if refused else pose, *more)
    RobotNode._teleport, OdometryPacker.message = planted, packed


def coverage_is_lost():
    from rumba_sim.ros.common import conversions
    odd = []
    on_message(lambda message: is_odd(message) and odd.append(message))
    after(conversions, 'cleaning_status', lambda message: _set(message, time=0.0, distance=0.0) if odd else message)


def steps_one_too_many():
    from rumba_sim.ros.simulator.simulator import Simulator
    step = Simulator._step
    Simulator._step = lambda self, ticks: step(self, ticks + 1)


def reset_fails():
    from rumba_sim.model.common.errors import WorldError
    from rumba_sim.ros.simulator.simulator import Simulator

    def refuse(*_):
        raise WorldError(BODY)
    before(Simulator, '_reset', refuse)


def stands_after_odd_speed():
    from rumba_sim.ros.simulator.simulator import Simulator
    before(Simulator, '_tune', lambda _, values: 0.0 < values.get('speed', 1.0) < 1e-9 and time.sleep(FOR_EVER))


def pose_estimate_that_is_no_number():
    from rumba_localisation.ros import conversions
    after(conversions, 'pose_with_covariance',
          lambda message: _set(message, pose=_set(message.pose, covariance=[math.nan] * 36)))


# --- life and death --------------------------------------------------------------------------------------------------

def dies_of_a_broken_handshake():
    from rospy.impl import tcpros_base
    usual = tcpros_base.read_ros_handshake_header

    def read(*arguments):
        try:
            return usual(*arguments)
        except Exception:
            die()
    tcpros_base.read_ros_handshake_header = read


def dies_of_a_broken_request():
    from rosgraph.xmlrpc import SilenceableXMLRPCRequestHandler
    before(SilenceableXMLRPCRequestHandler, 'report_404', die)


def dies_of_a_reader_that_goes():
    from rospy.impl.tcpros_base import TCPROSTransport
    usual = TCPROSTransport.write_data

    def write(self, data):
        try:
            usual(self, data)
        except Exception:
            die()
    TCPROSTransport.write_data = write


def dies_of_a_broken_frame():
    import genpy
    before(genpy.DeserializationError, '__init__', die)


def dies_of_a_stop():
    def watch():
        last = time.monotonic()
        while time.monotonic() - last < 0.5:
            last = time.monotonic()
            time.sleep(0.02)
        die()
    threading.Thread(target=watch, daemon=True).start()


def dies_of_a_silent_master():
    import rosgraph
    from rumba_sim.ros.running import peers
    peers.ANSWER_TIMEOUT = 0.3

    def watch():
        while True:
            time.sleep(0.05)
            try:
                peers.hasty_master('/watch').getUri()
            except socket.timeout:
                die()
            except (OSError, rosgraph.MasterException):
                pass
    threading.Thread(target=watch, daemon=True).start()


def dies_without_a_home():
    if not os.path.isdir(os.path.expanduser('~')):
        die()


def dies_of_a_full_disk():
    import logging

    from rumba_sim.ros.running import node
    after(node, '_log_trouble_once', lambda _: before(logging.Handler, 'handleError', die))


def hangs_after_an_odd_number():
    from rumba_sim.ros.simulator.simulator import Simulator
    on_message(lambda message: is_odd(message) and HANG.set())
    before(Simulator, '_tick', lambda _: HANG.is_set() and time.sleep(FOR_EVER))


def hears_no_signal():
    from rumba_sim.ros.running import node
    node._shut_down = lambda *_: None


def ends_with_an_error():
    from rumba_sim.ros.running import node
    node._shut_down = lambda *_: os._exit(1)


def ignores_rosnode_kill():
    from rospy.impl.masterslave import ROSHandler
    ROSHandler.shutdown = lambda *_: (1, '', 0)


def is_a_twin():
    from rumba_sim.ros.robot import robot_node
    from rumba_sim.ros.running import peers
    from rumba_sim.ros.simulator import simulator
    peers.Reservation.take = lambda _: True
    peers.refuse_twin = robot_node.refuse_twin = lambda _: None
    simulator.refuse_second = lambda: None


def forgets_the_master():
    from rumba_sim.ros.running import master_watch
    master_watch.start = lambda: None


# --- what is said, and done for others -------------------------------------------------------------------------------

def raises_for_an_odd_name():
    from rumba_sim.ros.simulator import fleet

    def check(name):
        if '/' in name or ' ' in name:
            raise KeyError(BODY)
    before(fleet, 'check_name', check)


def prints_what_it_gets():
    on_message(lambda message: [print(text, flush=True) for text in texts(message) if '\x1b' in text])


def prints_too_much():
    on_message(lambda message: is_odd(message) and print('\n'.join(20 * [BODY]), flush=True))


def drops_goals():
    from rumba_cleaning.ros.cleaner.cleaner import Cleaner
    usual, numbers = Cleaner._accept, iter(range(10 ** 9))

    def accept(self, name, handle):
        if next(numbers) % 10 == 9:
            handle.set_accepted()
        else:
            usual(self, name, handle)
    Cleaner._accept = accept


def leaves_robots_behind():
    from rumba_sim.ros.robot.robot_node import RobotNode
    RobotNode.close = lambda _: None


def raises_at_the_end_of_a_test():
    from rumba_evaluation.ros.mission_monitor import MissionMonitor

    def fail(_):
        raise RuntimeError(BODY)
    before(MissionMonitor, 'close', fail)


def raises_for_a_bad_map():
    from rumba_sim.model.common.errors import MapError
    from rumba_sim.model.maps import map_file
    usual = map_file.load

    def load(path, *radius):
        try:
            return usual(path, *radius)
        except MapError as error:
            raise KeyError(BODY) from error
    map_file.load = load


def refuses_in_two_lines():
    from rumba_sim.ros.running import node
    before(node, '_refuse', lambda *_: print(BODY, file=sys.stderr))


def forgets_rows():
    def change(module):
        module.Results._write = lambda *_: None
    after_import('rumba_evaluation.trials.results', change)


def page_falls_silent():
    from tornado.iostream import IOStream
    writes = iter(range(6))
    before(IOStream, 'write', lambda *_: next(writes, None) is None and time.sleep(FOR_EVER))


def raises_for_an_odd_date():
    from rumba_viewer.page.web import Files
    del Files.should_return_304


def sleeps_over_what_is_no_number():
    from rumba_viewer.page.protocol import Session
    before(Session, 'receive', lambda _, text: time.sleep(5.0 * ('Infinity' in text)))


def repeats_what_is_no_id():
    from rumba_viewer.page.messages import operations
    after(operations, 'can_be_id', lambda _: True)
