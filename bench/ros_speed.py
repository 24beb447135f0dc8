"""How fast the simulator node is, what it costs in real time, and how soon its first message comes.

One robot on the map studio, at the rates of the node's defaults: odom and tf 50 Hz; scan, ground_truth, bumper, cliff,
dock_status and battery_state 10 Hz; battery_status 5 Hz; cleaning_status and coverage 1 Hz. simulator/state, once
a second of the wall clock, always has a subscriber: it tells how much simulated time has passed.
"""

import statistics
import time

import rospy
from common import figures, ros_session

from rumba_msg.msg import BatteryStatus

MAP = 'studio'
RUNS = 3
SECONDS = 8.0  # of each run
ALONE, HEARD = 300.0, 40.0  # times real time, at least
SHARE = 5.0  # [%] of a core, in real time, below
MEMORY = 200.0  # [MB] below
FIRST_MESSAGE = 2.0  # [s] below


def main():
    """Measure and print."""
    with ros_session.master():
        figures.heading(f'Through ROS: one robot on the map {MAP}, all topics at their usual rates')
        figures.row('rosrun to the first battery_status, warm caches [s]', first_message(), below=FIRST_MESSAGE)
        alone()
        heard()
        real_time()


def first_message():
    """Seconds from `rosrun` to the first message that a waiting subscriber gets: the median."""
    seconds = []
    for _ in range(RUNS + 1):
        came = []
        subscriber = rospy.Subscriber('/rumba/battery_status', BatteryStatus, came.append)
        begin = time.monotonic()
        with ros_session.fresh_parameters(), ros_session.process(ros_session.command(map=MAP)):
            ros_session.wait_until(lambda came=came: came)
            seconds.append(time.monotonic() - begin)
        subscriber.unregister()
    return statistics.median(seconds[1:])  # the first run may have had to compile


def alone():
    """Speed 0 without any subscriber."""
    with ros_session.simulator(map=MAP, speed=0) as node:
        as_fast_as_it_goes('speed 0, nobody listens', node, ALONE)


def heard():
    """Speed 0 with one subscriber to each topic."""
    with ros_session.simulator(map=MAP, speed=0) as node:
        with ros_session.listener() as counts:
            as_fast_as_it_goes('speed 0, one subscriber to each topic, in another process', node, HEARD)
    for topic in ('/rumba/odom', '/rumba/scan', '/rumba/battery_state'):
        came, sent = counts[topic]
        figures.row(f'  messages of {topic} that came, of those sent [%]', 100.0 * came / sent)


def as_fast_as_it_goes(title, node, bound):
    """Simulated seconds in a wall second and in a CPU second: the median."""
    runs = [node.watch(SECONDS) for _ in range(RUNS)]
    figures.row(f'{title}: simulated s per s', statistics.median(sim / wall for sim, wall, _ in runs), at_least=bound)
    figures.row('  simulated s per CPU s of the node', statistics.median(sim / cpu for sim, _, cpu in runs))


def share(node):
    """Share of a core [%] that a node takes: the median."""
    runs = [node.watch(SECONDS) for _ in range(RUNS)]
    return statistics.median(100.0 * cpu / wall for _, wall, cpu in runs)


def real_time():
    """CPU and memory at speed 1."""
    with ros_session.simulator(map=MAP) as node:
        figures.row('real time, nobody listens: share of a core [%]', share(node), below=SHARE)
        figures.row('  resident memory [MB]', node.resident, below=MEMORY)
        with ros_session.listener():
            figures.row('real time, one subscriber to each topic: share of a core [%]', share(node))
            figures.row('  resident memory [MB]', node.resident, below=MEMORY)


if __name__ == '__main__':
    main()
