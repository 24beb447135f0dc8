"""What is asked after each blow: do the nodes live, is the world sane, do goals end, does everything come back?"""

import math
import time

import psutil
from geometry_msgs.msg import Pose2D, PoseWithCovarianceStamped
from std_srvs.srv import Trigger

from rumba_msg.msg import BatteryStatus
from stress import goals, page, printed, wire, world
from stress.failure import Failure
from stress.member import Usage
from stress.scenarios import PAGE_PORT

ANSWERS_WITHIN = 20.0  # [s] ...
SECONDS_PER_INPUT = 0.01  # ... and so much more, since what is in the queue comes first
ENDS_WITHIN = 2.0  # [s] after it does not answer any more
COMES_BACK_WITHIN = 25.0  # [s] until what a blow opened is closed again
# Python closes some files of ROS, epolls of topics, only when its garbage collector runs. The C library keeps what the
# planner took, up to 190 MB if a robot is reset while it plans, and the next plan takes the same again.
MORE = Usage(fds=90, sockets=8, threads=8, megabytes=250.0)


def check(ground, inputs):
    """Ask everything.

    Args:
        ground: the ground.
        inputs: how many hostile inputs the blow was.

    Raises:
        Failure: an answer is wrong.
    """
    for member in ground.everybody:
        alive(member)
    for member in ground.everybody:
        prints(member, inputs)
    try:
        answers(ground)
        if ground.world is not None:
            world.tidy(ground)
            world.check(ground)
        pulses(ground, ANSWERS_WITHIN + SECONDS_PER_INPUT * inputs)
    except wire.WireError as error:
        explain(ground, error)
    ground.settle()
    for member in ground.everybody:
        comes_back(member)
    for member in ground.everybody:
        alive(member)
        prints(member, inputs)


def explain(ground, error):
    """Raise a failure because nobody answers; that a node has ended, or is about to, explains it better."""
    time.sleep(ENDS_WITHIN)
    for member in ground.everybody:
        alive(member)
    raise Failure('silent', 'ground', str(error)) from error


def alive(member):
    """It runs."""
    if not member.is_alive:
        code = member.process.returncode if member.process else None
        raise Failure('ended', member.name, f'exit code {code}: {printed.tail(member.printed())}')


def prints(member, inputs=0):
    """What it printed is no traceback, no flood, and safe on a terminal."""
    most = None if member.role.talks else printed.LINES + printed.LINES_PER_INPUT * inputs
    printed.check(member.name, member.printed(), most)


def answers(ground):
    """Each node answers the questions of the master's clients, and is registered."""
    for member in ground.everybody[1:]:
        uri = ground.node_uri(member.name)
        if wire.ask(uri, 'getPid', timeout=ANSWERS_WITHIN) != member.process.pid:
            raise Failure('registered', member.name, f'the master knows another process as {member.name}')


def comes_back(member):
    """It holds no more than before."""
    if member.baseline is None:
        return
    end = time.monotonic() + COMES_BACK_WITHIN
    allowed = MORE._replace(sockets=MORE.sockets + member.role.keeps)
    most = [before + more for before, more in zip(member.baseline, allowed)]
    try:
        while any(now > bound for now, bound in zip(member.usage(), most)):
            if time.monotonic() > end:
                raise Failure('leak', member.name, f'{member.usage()}; at first {member.baseline}')
            time.sleep(0.1)
    except psutil.Error:
        alive(member)


# --- the pulse of each kind of node -----------------------------------------------------------------------------------

def pulses(ground, patience):
    """Each node still does what it is for."""
    for member in ground.members.values():
        PULSES[member.role.pulse](ground, member, patience)


def _goals(ground, _, patience):
    """Its loop refuses a goal that makes no sense."""
    try:
        _refused_goal(ground, patience)
    except wire.WireError:
        # A new master tells nodes of publishers by several threads, out of order: a node that hears last what was true
        # first leaves a publisher that it has just found. Once.
        _refused_goal(ground, patience)
    goals.keep_busy(ground)


def _refused_goal(ground, patience):
    with goals.client(ground, 'go_to') as client:
        client.send(target=Pose2D(math.nan, math.nan, math.nan))
        client.await_results(patience)


def _picture(ground, member, patience):
    """Its window can be painted."""
    answer = ground.call(f'{member.name}/save_png', Trigger, timeout=patience)
    if not answer.success:
        raise Failure('pulse', member.name, f'save_png: {answer.message}')
    for picture in ground.folder.glob('*.png'):
        picture.unlink()


def _charge(ground, member, patience):
    """Its battery has a charge."""
    status = ground.read(member.role.ready, BatteryStatus, member, patience)
    if not 0 <= status.percentage_battery <= 100:
        raise Failure('sane', member.name, f'percentage_battery is {status.percentage_battery}')


def _pose(ground, member, patience):
    """It tells where the robot is, again and again."""
    with ground.listen('/rumba/amcl_pose', PoseWithCovarianceStamped, member) as poses:
        first = newest = poses.next(patience)
        while newest.header.stamp <= first.header.stamp:
            newest = poses.next(patience)
    pose = newest.pose.pose
    numbers = pose.position.x, pose.position.y, pose.orientation.z, pose.orientation.w, *newest.pose.covariance
    if not all(map(math.isfinite, numbers)):
        raise Failure('sane', member.name, f'amcl_pose is {numbers[:4]}')


def _page(_ground, member, patience):
    """A browser gets the page, and the newest charge of the robot."""
    try:
        text = page.get(PAGE_PORT, '/', patience)
        with page.Client(PAGE_PORT, patience) as client:
            client.subscribe('/rumba/battery_state', 'sensor_msgs/BatteryState')
            charge = client.next()['msg']['charge']
    except page.NO_PAGE as error:
        raise Failure('pulse', member.name, f'{type(error).__name__}: {error}') from error
    if '<html' not in text or not isinstance(charge, float):
        raise Failure('pulse', member.name, f'the page begins with {text[:40]!r}, the charge is {charge!r}')


PULSES = {'': lambda *_: None, 'goals': _goals, 'picture': _picture, 'charge': _charge, 'pose': _pose, 'page': _page}
