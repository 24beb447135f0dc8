"""A mission in a bag, written by rosbag, and the report that the evaluation makes of it."""

import pathlib
import signal
import subprocess
from typing import List, Optional

import rospkg
import rospy

from rumba_sim.model.common.errors import one_line
from rumba_sim.ros.participants.maps import TRUE_TOPIC

TOPICS = ('ground_truth', 'battery_state', 'battery_status', 'cleaning_status', 'bumper', 'cliff', 'dock_status',
          'mission_status', 'coverage', 'clean/goal')  # of the robot, that docs/mission_report.md names
CLOSES_WITHIN = 20.0  # [s] of the wall clock: rosbag writes what it has buffered
MAKES_WITHIN = 600.0  # [s] of the wall clock: a recording of a day takes minutes
NEEDED = {'rosbag': 'python3-rosbag', 'rumba_evaluation': 'rumba_evaluation'}  # packages of ROS, and what brings them


class RecordError(Exception):
    """A mission cannot be recorded, or its report cannot be made."""


class MissionRecord:
    """Records a mission from the moment at which it is made.

    Attributes:
        bag: path of the bag.
    """

    def __init__(self, robot: str, bag: pathlib.Path) -> None:
        """Begin to record a robot, by its name, in the thread that lives as long as the program: rosbag ends with it.

        Raises:
            RecordError: rosbag or the evaluation is not installed, or the folder cannot be written.
        """
        _check_installed()
        self.bag = bag
        self._process: Optional['subprocess.Popen[bytes]'] = None
        try:
            bag.parent.mkdir(parents=True, exist_ok=True)
            bag.touch(exist_ok=False)  # rosbag tells nobody if it cannot
            bag.unlink()
            self._process = subprocess.Popen(
                ['setpriv', '--pdeathsig', 'INT', 'rosrun', 'rosbag', 'record', '--lz4', '--output-name', str(bag),
                 '/map', '/tf_static', rospy.resolve_name(TRUE_TOPIC),
                 *(rospy.resolve_name(f'{robot}/{topic}') for topic in TOPICS)],
                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        except OSError as error:
            raise RecordError(f'cannot be recorded: {error}') from error

    def close(self) -> None:
        """End the recording, and wait until the bag is complete."""
        process, self._process = self._process, None
        if process is None:
            return
        process.send_signal(signal.SIGINT)
        try:
            process.wait(CLOSES_WITHIN)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()

    def report(self) -> str:
        """End the recording, and make the report; returns the path of its page.

        Raises:
            RecordError: there is no bag, or no report can be made of it.
        """
        self.close()
        if not self.bag.exists():
            raise RecordError(f'rosbag wrote no {self.bag}: is there a gigabyte of space, as it wants?')
        command = ['rosrun', 'rumba_evaluation', 'mission_report', str(self.bag)]
        try:
            done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                  universal_newlines=True, timeout=MAKES_WITHIN)
        except (OSError, subprocess.TimeoutExpired) as error:
            raise RecordError(f'{self.bag} is there, but no page: {error}') from error
        if done.returncode != 0:
            said = _last_line(done.stderr) or f'mission_report ended with exit code {done.returncode}'
            raise RecordError(f'{self.bag} is there, but no page: {said}')
        return done.stdout.split('\n')[0]


def _check_installed() -> None:
    packs = rospkg.RosPack()
    for package, source in NEEDED.items():
        try:
            packs.get_path(package)
        except rospkg.ResourceNotFound:
            raise RecordError(f'needs the package {package}: install {source}') from None


def _last_line(text: str) -> str:
    lines: List[str] = text.strip().split('\n')
    return one_line(lines[-1])
