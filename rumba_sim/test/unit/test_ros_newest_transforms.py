"""Of messages of tf, the newest transform of each link."""

import io

import genpy
import pytest
import rospy
from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

from rumba_sim.ros.common.newest_transforms import NewestTransforms


def link(frame, child, number):
    """A transform whose numbers tell it from others."""
    turn = Quaternion(0.1, 0.2, 0.3, number)
    place = Vector3(number, -1.0, 2.0)
    return TransformStamped(Header(number, rospy.Time(number, 5), frame), child, Transform(place, turn))


def packed(*transforms):
    """A message as on the wire."""
    buffer = io.BytesIO()
    TFMessage(list(transforms)).serialize(buffer)
    return buffer.getvalue()


def test_it_has_the_last_transform_of_each_link_whole():
    sent = [link('map', 'odom', 1), link('odom', 'base', 2), link('map', 'odom', 3), link('odom', 'base', 4),
            link('odom', 'basé', 5), link('', '', 6), link('/odom', 'base', 7), link('map', 'odom', 8)]
    assert NewestTransforms().deserialize(packed(*sent)).transforms == [sent[7], *sent[3:7]]


def test_it_may_be_empty():
    assert NewestTransforms().deserialize(packed()).transforms == []


def test_it_is_the_same_message_to_publishers():
    assert (NewestTransforms._type, NewestTransforms._md5sum) == (TFMessage._type, TFMessage._md5sum)


@pytest.mark.parametrize('cut', range(1, 60))
def test_a_message_that_is_cut_off_is_none(cut):
    with pytest.raises(genpy.DeserializationError):
        NewestTransforms().deserialize(packed(link('map', 'odom', 1), link('odom', 'base', 2))[:-cut])


def test_a_message_of_nonsense_is_none():
    for content in (b'', b'\xff' * 4, b'\xff' * 1000, b'\1\0\0\0' * 20 + b'\xff' * 4):
        with pytest.raises(genpy.DeserializationError):
            NewestTransforms().deserialize(content)
