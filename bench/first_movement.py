"""From a clone to the first movement: `./rumba run` without a window, with all system packages installed.

The clone has neither a workspace nor compiled code. Time ends with the first velocity other than 0 that is commanded.
"""

import os
import pathlib
import queue
import subprocess
import tempfile
import time

import rosgraph
import rospy
from common import figures, ros_session
from common.ports import free_port
from geometry_msgs.msg import Twist

ROOT = pathlib.Path(__file__).resolve().parents[1]
MOST = 120.0  # CPU s
PATIENCE = 3600.0  # [s] for a build on a busy machine


def main():
    """Measure and print."""
    with tempfile.TemporaryDirectory(prefix='rumba_first_movement_') as folder:
        clone = pathlib.Path(folder) / 'rumba'
        subprocess.run(['git', 'clone', '-q', str(ROOT), str(clone)], check=True)
        os.environ.update(ROS_MASTER_URI=f'http://localhost:{free_port()}', ROS_HOSTNAME='localhost',
                          ROS_LOG_DIR=folder)
        begin = time.monotonic()
        with ros_session.process([str(clone / 'rumba'), 'run', 'gui:=false']) as run:
            built, seconds = at_first_movement(run)
            spent, wall = figures.cpu_seconds_of_tree(run.pid), seconds - begin
    figures.heading('./rumba run gui:=false, in a clone')
    figures.row('until the master answers: build and start of roslaunch [CPU s]', built)
    figures.row('until the robot is first told to move [CPU s]', spent, below=MOST)
    figures.row('    by the wall clock [s]', wall)


def at_first_movement(run):
    """Wait for the first velocity other than 0.

    Returns:
        CPU time until the master answered [s], and when the velocity came, as a time of `time.monotonic`.
    """
    def has_master():
        assert run.poll() is None, 'it has ended'
        return rosgraph.is_master_online()
    ros_session.wait_until(has_master, PATIENCE)
    built = figures.cpu_seconds_of_tree(run.pid)
    rospy.init_node('bench', disable_signals=True, disable_rostime=True, disable_rosout=True)
    velocities = queue.Queue()
    rospy.Subscriber('/rumba/cmd_vel', Twist, velocities.put)
    while True:
        velocity = velocities.get(timeout=PATIENCE)
        if velocity.linear.x or velocity.angular.z:
            return built, time.monotonic()


if __name__ == '__main__':
    main()
