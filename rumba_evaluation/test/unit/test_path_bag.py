"""Paths in bags."""

import pytest
import rosbag
import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path
from pytest import approx
from std_msgs.msg import Empty

from rumba_evaluation.ros import evaluate
from rumba_evaluation.ros.path_bag import read
from rumba_evaluation.scoring.drawn_path import PathError
from rumba_sim.model.common.geometry import half_angle


def message(points, headings=None, times=None):
    """A nav_msgs/Path."""
    path = Path()
    for index, (x, y) in enumerate(points):
        pose = PoseStamped()
        pose.pose.position.x, pose.pose.position.y = x, y
        if headings is not None:
            pose.pose.orientation.z, pose.pose.orientation.w = half_angle(headings[index])
        if times is not None:
            pose.header.stamp = rospy.Time.from_sec(times[index])
        path.poses.append(pose)
    return path


@pytest.fixture
def bag(tmp_path):
    """A function that writes messages by topic into a bag, and returns its path."""
    def write(*messages):
        path = str(tmp_path / 'path.bag')
        with rosbag.Bag(path, 'w') as file:
            for number, (topic, one) in enumerate(messages, 1):
                file.write(topic, one, rospy.Time(number))
        return path
    return write


def test_the_last_path_counts_with_its_headings_and_times(bag):
    found = read(bag(('/plan', message([(9.0, 9.0), (8.0, 9.0)])),
                     ('/plan', message([(1.0, 2.0), (1.0, 3.0)], [1.5, -2.0], [1e9, 1e9 + 0.25])), ('/other', Empty())))
    assert found.points.tolist() == [[1.0, 2.0], [1.0, 3.0]] and found.headings.tolist() == approx([1.5, -2.0])
    assert found.times.tolist() == approx([0.0, 0.25]) and found.at(1).endswith('path.bag, /plan, pose 2')


def test_a_path_without_headings_and_stamps(bag):
    found = evaluate.read_bag(bag(('plan', message([(1.0, 2.0), (2.0, 3.0)]))), '')
    assert found.headings is found.times is None


def test_one_of_several_topics(bag):
    path = bag(('/a', message([(1.0, 1.0), (2.0, 1.0)])), ('/b', message([(3.0, 1.0), (2.0, 1.0)])))
    assert read(path, 'b').points[0].tolist() == [3.0, 1.0]
    with pytest.raises(PathError, match='several topics of type nav_msgs/Path: choose one by --topic: /a, /b$'):
        read(path)
    with pytest.raises(PathError, match='has no nav_msgs/Path on /c: has /a, /b$'):
        read(path, '/c')


def test_bags_without_a_path_and_damaged_bags(bag, tmp_path):
    with pytest.raises(PathError, match='has no topics of type nav_msgs/Path: has /other$'):
        read(bag(('/other', Empty())))
    with pytest.raises(PathError, match='path.bag, /plan: has no poses'):
        read(bag(('/plan', message([]))))
    with pytest.raises(PathError, match='path.bag, /plan, pose 2: the position must be finite numbers$'):
        read(bag(('/plan', message([(1.0, 1.0), (float('nan'), 1.0)]))))
    (tmp_path / 'cut.bag').write_bytes(b'#ROSBAG V2.0\nnothing more')
    with pytest.raises(PathError, match='cut.bag: has no index, .*: repair it by rosbag reindex'):
        read(str(tmp_path / 'cut.bag'))
