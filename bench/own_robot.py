"""What share of a furnished room a robot sweeps that is not ours, by its own judgement, and how long that takes.

    ./rumba shell python3 bench/own_robot.py --runs 10

Each run has a fake robot of the tests of rumba_cleaning, with errors of its own, and own_robot.launch, without a map
and with one on which the robot looks for its place.
"""

import argparse
import pathlib
import sys
import tempfile
import time

import rospy
from common import ros_session
from std_msgs.msg import Float32

from rumba_msg.msg import MissionStatus

FAKE = pathlib.Path(__file__).resolve().parents[1] / 'rumba_cleaning' / 'test' / 'ros'
TOPICS = 'scan:=/front/laser', 'odom:=/base/odometry', 'cmd_vel:=/base/velocity'
PATIENCE = 1200.0  # [s] of the wall clock for a mission
LEAST = {'slam': 0.95, 'mcl': 0.97}  # share to sweep


def main():
    """Run the missions and print their shares."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--runs', type=int, default=10, help='of each kind')
    parser.add_argument('--kinds', nargs='+', choices=LEAST, default=list(LEAST), help='without a map, and with one')
    arguments = parser.parse_args()
    with ros_session.master(), tempfile.TemporaryDirectory() as folder:
        rospy.set_param('/use_sim_time', True)
        draw(f'{folder}/room')
        for kind in arguments.kinds:
            more = [f'map:={folder}/room.yaml'] if kind == 'mcl' else []
            shares = [run(kind, seed, more) for seed in range(1, arguments.runs + 1)]
            fit = sum(share >= LEAST[kind] for share in shares)
            print(f'{kind}: {fit} of {len(shares)} with {LEAST[kind]:.0%} or more; the least is {min(shares):.1%}')


def draw(path):
    """Write the map of the room."""
    sys.path.append(str(FAKE))
    import fake_robot
    fake_robot.draw(fake_robot.ROOMS['furnished'], path)


def run(kind, seed, more):
    """The share that a mission sweeps; prints it."""
    statuses, shares, begin = [], [], time.monotonic()
    with ros_session.process([sys.executable, str(FAKE / 'fake_robot.py'), f'_seed:={seed}',
                              '_wait_for_correction:=true']), ros_session.process(
            ['roslaunch', 'rumba_launch', 'own_robot.launch', f'robot:={FAKE / "fake_robot.yaml"}', *TOPICS, *more]):
        subscribers = [rospy.Subscriber('/rumba/mission_status', MissionStatus, statuses.append),
                       rospy.Subscriber('/coverage', Float32, shares.append)]
        try:
            ros_session.wait_until(lambda: any(status.state == MissionStatus.CLEANING for status in statuses)
                                   and statuses[-1].state == MissionStatus.IDLE, PATIENCE)
        except TimeoutError:
            print(f'{kind}, seed {seed}: not done in {PATIENCE:g} s')
        for subscriber in subscribers:
            subscriber.unregister()
    passed = statuses[-1].header.stamp.to_sec() - statuses[0].header.stamp.to_sec() if statuses else 0.0
    share, message = (shares[-1].data if shares else 0.0), statuses[-1].message if statuses else 'no mission'
    print(f'{kind}, seed {seed}: {share:.1%} swept after {passed:.0f} s, the cleaner says: {message}; '
          f'{time.monotonic() - begin:.0f} s', flush=True)
    return share


if __name__ == '__main__':
    main()
