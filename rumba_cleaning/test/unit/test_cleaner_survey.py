"""How the cleaner takes over a map that grows, and one that was redrawn, from the messages of a mapper."""

import numpy as np
import pytest
import rospy
from geometry_msgs.msg import Point, PoseArray, PoseStamped
from geometry_msgs.msg import Pose as PoseMessage
from rooms import room
from std_msgs.msg import Header

from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.ros.cleaner.goals import survey as module
from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.ros.common.conversions import grid, quaternion

FLOOR = room(4.0, 3.0, 0.02, boxes=[(2.0, 0.0, 2.1, 2.0)])
CORRECTED = room(4.0, 3.0, 0.02, boxes=[(2.2, 0.0, 2.3, 2.0)])
LEFT, RIGHT, MOVED = Pose(0.5, 0.5, 0.0), Pose(3.0, 0.5, 0.0), Pose(3.3, 0.5, 0.0)


def map_of(plan, second):
    """The message of a map."""
    return grid(plan, plan.occupancy, rospy.Time(second))


def message_of(pose):
    """A pose in the plane as one in space."""
    return PoseMessage(Point(pose.x, pose.y, 0.0), quaternion(pose.theta))


def frames_of(poses, second):
    """The message of key frames."""
    return PoseArray(Header(stamp=rospy.Time(second)), [message_of(pose) for pose in poses])


@pytest.fixture(name='survey')
def _survey(monkeypatch):
    """One that listens to nobody, and has heard a map with its key frames."""
    monkeypatch.setattr(module.rospy, 'Subscriber', lambda *_, **__: None)
    survey = module.SurveyListener('rumba')
    with pytest.raises(MapError, match='^no map came on /map yet$'):
        survey.plan()
    survey._take_frames(frames_of([LEFT, RIGHT], 1))
    assert not len(survey.frames())  # no map shows them
    survey._take_map(map_of(FLOOR, 1))
    assert survey.frames()[:, 0] == pytest.approx([0.5, 3.0]) and survey.frames() is survey.frames()
    return survey


def swept(survey):
    """A robot that swept at the right key frame."""
    context = Context(survey.plan(), RobotConfig(), CleaningConfig(), survey=survey)
    context.swept.begin(0.5, 0.5)
    context.swept.sweep(RIGHT, RIGHT._replace(x=3.2))
    return context


def is_swept(context, x):
    """Whether the middle of what was swept is at x [m]."""
    row, column = (int((at - low) / context.plan.resolution) for at, low in zip((0.5, x), context.plan.origin[::-1]))
    return context.swept.missing_share()[row, column] == 0.0


@pytest.mark.parametrize('first, second', [('_take_map', '_take_frames'), ('_take_frames', '_take_map')])
def test_a_redrawn_map_is_taken_over_with_what_was_swept_in_whichever_order_its_messages_come(survey, first, second):
    context = swept(survey)
    messages = {'_take_map': map_of(CORRECTED, 2), '_take_frames': frames_of([LEFT, MOVED], 2)}
    getattr(survey, first)(messages[first])
    assert not context.follow(LEFT)
    getattr(survey, second)(messages[second])
    assert context.follow(LEFT) and not context.follow(LEFT)
    assert context.plan.clearance_at(2.05, 1.0) > 0.1 and context.plan.clearance_at(2.25, 1.0) == 0.0
    assert is_swept(context, 3.4) and not is_swept(context, 2.95)


def test_a_map_of_a_mapper_that_tells_no_key_frames_is_taken_over_as_it_is(survey):
    context = swept(survey)
    survey._take_map(map_of(CORRECTED, 2))
    assert not context.follow(LEFT) and context.learn(LEFT)
    assert context.plan.clearance_at(2.25, 1.0) == 0.0 and is_swept(context, 3.1)


def test_the_dock_is_on_the_plan_once_it_is_told_and_where_it_was_told_last(survey):
    assert survey.plan().dock is None and survey.plan() is survey.plan()
    for pose in (LEFT, MOVED):
        survey._take_dock(PoseStamped(Header(), message_of(pose)))
        assert np.allclose(survey.plan().dock, pose)
