"""A mission in a bag, written by rosbag, and the report that the evaluation makes of it."""

import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import threading
from typing import List, Optional, Sequence

import rospkg
import rospy

from rumba_sim.model.common.errors import one_line
from rumba_sim.ros.participants.maps import TRUE_TOPIC

TOPICS = ('ground_truth', 'battery_state', 'battery_status', 'cleaning_status', 'bumper', 'cliff', 'dock_status',
          'mission_status', 'coverage', 'clean/goal')  # of the robot, that docs/mission_report.md names
LARGEST = 1000  # [MB] a recording ends when it has grown so large
CLOSES_WITHIN = 20.0  # [s] of the wall clock: rosbag writes what it has buffered
MAKES_WITHIN = 600.0  # [s] of the wall clock: a recording of a day takes minutes
NEEDED = {'rosbag': 'python3-rosbag', 'rumba_evaluation': 'rumba_evaluation'}  # packages of ROS, and what brings them


class RecordError(Exception):
    """A mission cannot be recorded, or its report cannot be made."""


class MissionRecord:
    """Records robots from the moment at which it is made, into a folder of its own."""

    def __init__(self, robots: Sequence[str]) -> None:
        """Begin to record robots, by their names, in the thread that lives as long as the program: rosbag ends with it.

        Raises:
            RecordError: rosbag or the evaluation is not installed, or no file can be written.
        """
        _check_installed()
        self._lock = threading.Lock()  # held while the recording ends
        self._kept: Optional[pathlib.Path] = None  # where the bag goes in the end; None: nowhere
        topics = [f'{robot}/{topic}' for robot in robots for topic in TOPICS]
        try:
            self._folder = pathlib.Path(tempfile.mkdtemp(prefix='rumba-'))
            self.bag = self._folder / 'mission.bag'
            self._process: Optional['subprocess.Popen[bytes]'] = subprocess.Popen(
                ['setpriv', '--pdeathsig', 'INT', 'rosrun', 'rosbag', 'record', '--lz4', f'--size={LARGEST}',
                 '--output-name', str(self.bag), '/map', '/tf_static', rospy.resolve_name(TRUE_TOPIC),
                 *map(rospy.resolve_name, topics)],
                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        except OSError as error:
            raise RecordError(f'cannot be recorded: {error}') from error

    def keep_as(self, bag: pathlib.Path) -> None:
        """Have the bag stay under a path.

        Raises:
            RecordError: that cannot be written.
        """
        try:
            bag.parent.mkdir(parents=True, exist_ok=True)
            bag.touch(exist_ok=False)
        except OSError as error:
            raise RecordError(f'cannot be saved: {error}') from error
        bag.unlink()
        self._kept = bag

    def close(self) -> None:
        """End the recording, and wait until the bag is complete."""
        with self._lock:
            process, self._process = self._process, None
            if process is None:
                return
            process.send_signal(signal.SIGINT)
            try:
                process.wait(CLOSES_WITHIN)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    def discard(self) -> None:
        """End the recording, and delete it; if it was to stay, move it to its place, or leave it if that fails."""
        if self._kept is None:
            self._kill()
        try:
            self._save()
        except OSError as error:
            rospy.logwarn(f'{self.bag} cannot be moved to {self._kept}: {error}')

    def _kill(self) -> None:
        """End rosbag without waiting for what it has buffered."""
        with self._lock:
            process, self._process = self._process, None
            if process is not None:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()

    def _save(self) -> None:
        self.close()
        if self._kept is not None and self.bag.exists():
            shutil.move(str(self.bag), str(self._kept))
        shutil.rmtree(self._folder, ignore_errors=True)

    def report(self, robot: str) -> str:
        """End the recording, and make a report about a robot; returns the path of its page.

        Raises:
            RecordError: there is no bag, or no report can be made of it.
        """
        bag = self._kept or self.bag
        try:
            self._save()
        except OSError as error:
            raise RecordError(f'{bag} cannot be saved: {error}') from error
        if not bag.exists():
            raise RecordError(f'rosbag wrote no {bag}: is there a gigabyte of space, as it wants?')
        command = ['rosrun', 'rumba_evaluation', 'mission_report', str(bag), '--robot', rospy.resolve_name(robot)]
        try:
            done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                  universal_newlines=True, timeout=MAKES_WITHIN)
        except (OSError, subprocess.TimeoutExpired) as error:
            raise RecordError(f'{bag} is there, but no page: {error}') from error
        if done.returncode != 0:
            said = _last_line(done.stderr) or f'mission_report ended with exit code {done.returncode}'
            raise RecordError(f'{bag} is there, but no page: {said}')
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
