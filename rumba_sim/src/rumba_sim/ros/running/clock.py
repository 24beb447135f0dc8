"""Which times on /clock count, and whether one has come."""

import rospy
from rosgraph_msgs.msg import Clock
from rospy.impl import simtime

from rumba_sim.ros.running.shared_reception import share

CLOCK = '/clock'
LATEST = 2 ** 31 - 1  # [s]: sums with durations are still times, and differences are durations
SECOND = 1_000_000_000  # [ns]
COMPLAINT_PERIOD = 10.0  # [s]


def guard() -> None:
    """Have this node ignore times that cannot be stamps; to be called before it is registered.

    rospy takes any time. Once it has a stamp that does not fit into a message, nothing can be published any more.
    """
    setattr(simtime, '_set_rostime_clock_wrapper', take)
    share(CLOCK)


def is_unknown() -> bool:
    """Whether this node goes by /clock, and no time has come there yet."""
    return not rospy.rostime.is_wallclock() and rospy.get_rostime().is_zero()


def take(message: Clock) -> None:
    """Make a time that of this node, if it counts."""
    time = message.clock
    if time.secs <= LATEST and time.nsecs < SECOND:
        rospy.rostime._set_rostime(time)
    else:
        rospy.logwarn_throttle(COMPLAINT_PERIOD, f'/clock is {time.secs} s and {time.nsecs} ns: must be at most '
                                                 f'{LATEST} s, with less than {SECOND} ns; ignored')
