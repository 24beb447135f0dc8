"""What share of a furnished room robots sweep that are not ours, by their own judgement, and how long that takes.

    ./rumba shell python3 bench/own_robot.py --runs 10

Each run has a fake robot of the tests of rumba_cleaning, with errors of its own: without a map, and with one, by
own_robot.launch; the kinds that begin with create have a fake Create instead, which begins and ends on its dock, and
charges there, by create.launch.
"""

import argparse
import pathlib
import sys
import tempfile
import time
from typing import NamedTuple

import rospy
from common import ros_session
from create_msgs.msg import ChargingState
from std_msgs.msg import Float32

from rumba_msg.msg import MissionStatus

FAKE = pathlib.Path(__file__).resolve().parents[1] / 'rumba_cleaning' / 'test' / 'ros'
PATIENCE = 1200.0  # [s] of the wall clock for a mission
ROOM = 'furnished'
OWN = ('own_robot.launch', f'robot:={FAKE / "fake_robot.yaml"}', 'scan:=/front/laser', 'odom:=/base/odometry',
       'cmd_vel:=/base/velocity')
BATTERY = '_lasts:=400', '_fills:=100'  # [s]


class Kind(NamedTuple):
    """Robots of one kind, and what they know."""

    fake: str
    launch: tuple
    has_map: bool
    least: float  # share to sweep


KINDS = {'slam': Kind('fake_robot', OWN, False, 0.95), 'mcl': Kind('fake_robot', OWN, True, 0.97),
         'create_slam': Kind('fake_create', ('create.launch',), False, 0.95),
         'create_mcl': Kind('fake_create', ('create.launch',), True, 0.97)}


def main():
    """Run the missions and print their shares."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--runs', type=int, default=10, help='of each kind')
    parser.add_argument('--kinds', nargs='+', choices=KINDS, default=list(KINDS), help='without a map, and with one')
    arguments = parser.parse_args()
    sys.path.append(str(FAKE))
    with ros_session.master(), tempfile.TemporaryDirectory() as folder:
        rospy.set_param('/use_sim_time', True)
        for name in arguments.kinds:
            kind = KINDS[name]
            more = draw(kind.fake, folder) if kind.has_map else []
            runs = [run(name, kind, seed, more) for seed in range(1, arguments.runs + 1)]
            fit = sum(share >= kind.least and is_home for share, is_home in runs)
            how = ' that end on the dock' if kind.fake == 'fake_create' else ''
            print(f'{name}: {fit} of {len(runs)} with {kind.least:.0%} or more{how}; the least is '
                  f'{min(share for share, _ in runs):.1%}')


def draw(fake, folder):
    """Write the map of the room of a fake robot; the arguments of the launch file for it."""
    import fake_create
    import fake_robot
    room = fake_create.ROOMS[ROOM][0] if fake == 'fake_create' else fake_robot.ROOMS[ROOM]
    fake_robot.draw(room, f'{folder}/room')
    return [f'map:={folder}/room.yaml', *(['home:=%.3f %.3f %.4f' % room.start] if fake == 'fake_create' else [])]


def run(name, kind, seed, more):
    """The share that a mission sweeps, and whether it ends where it shall; prints them."""
    statuses, shares, chargers, begin = [], [], [0], time.monotonic()
    with ros_session.process([
            sys.executable, str(FAKE / f'{kind.fake}.py'), f'_seed:={seed}', f'_room:={ROOM}',
            '_wait_for_correction:=true', '_answer:=/rumba/seek_dock', '_witness:=/rumba/dock_status',
            *BATTERY]), ros_session.process(
                ['roslaunch', 'rumba_launch', *kind.launch, *more]):
        subscribers = [rospy.Subscriber('/rumba/mission_status', MissionStatus, statuses.append),
                       rospy.Subscriber('/coverage', Float32, shares.append),
                       rospy.Subscriber('/battery/charging_state', ChargingState,
                                        lambda message: chargers.append(message.state))]
        try:
            ros_session.wait_until(lambda: any(status.state == MissionStatus.CLEANING for status in statuses)
                                   and statuses[-1].state in (MissionStatus.IDLE, MissionStatus.STRANDED), PATIENCE)
        except TimeoutError:
            print(f'{name}, seed {seed}: not done in {PATIENCE:g} s')
        for subscriber in subscribers:
            subscriber.unregister()
    passed = statuses[-1].header.stamp.to_sec() - statuses[0].header.stamp.to_sec() if statuses else 0.0
    share, message = (shares[-1].data if shares else 0.0), statuses[-1].message if statuses else 'no mission'
    is_create = kind.fake == 'fake_create'
    dockings = sum(after and not before for before, after in zip(chargers, chargers[1:]))
    end = 'where' if chargers[-1] else 'and not there'
    how = f', {dockings} times onto its dock, {end} it ends' if is_create else ''
    print(f'{name}, seed {seed}: {share:.1%} swept after {passed:.0f} s{how}, the cleaner says: {message}; '
          f'{time.monotonic() - begin:.0f} s', flush=True)
    return share, bool(chargers[-1]) or not is_create


if __name__ == '__main__':
    main()
