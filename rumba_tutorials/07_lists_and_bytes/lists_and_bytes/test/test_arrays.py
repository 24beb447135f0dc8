"""rospy treats lists, bytes and arrays as the page of this lesson says."""

import io

import genpy
import numpy as np
import pytest
from rospy.numpy_msg import numpy_msg

from lists_and_bytes.distances import nearest, to_millimetres
from lists_and_bytes.msg import IntList, Packet


def over_the_wire(message, kind):
    """Return a message as a subscriber to `kind` receives it."""
    buffer = io.BytesIO()
    message.serialize(buffer)
    return kind().deserialize(buffer.getvalue())


def test_metres_become_whole_millimetres_of_the_type_of_the_field():
    distances = to_millimetres(np.array([0.1236, np.inf, -np.inf, 2.0], np.float32))
    assert distances.dtype == np.int32
    assert distances.tolist() == [124, -1, -1, 2000]


def test_the_nearest_distance_ignores_beams_that_saw_nothing():
    assert nearest(np.array([300, -1, 200])) == 200
    assert nearest(np.array([-1, -1])) == -1


@pytest.mark.parametrize('kind, data', [
    (IntList, [1, -2, 3]), (IntList, np.array([1, -2, 3])), (numpy_msg(IntList), np.array([1, -2, 3], np.int32))])
def test_lists_and_arrays_arrive_as_tuples(kind, data):
    assert over_the_wire(kind(data), IntList).data == (1, -2, 3)


def test_with_numpy_msg_they_arrive_as_a_read_only_array():
    data = over_the_wire(IntList([1, -2, 3]), numpy_msg(IntList)).data
    assert data.dtype == np.int32 and data.tolist() == [1, -2, 3]
    with pytest.raises(ValueError, match='read-only'):
        data[0] = 0


def test_an_array_of_another_type_arrives_as_other_numbers_without_any_error():
    message = numpy_msg(IntList)(np.array([1, 2, 3], np.int64))
    assert over_the_wire(message, IntList).data == (1, 0, 2)


@pytest.mark.parametrize('data', [[1, 2, 255], (1, 2, 255), b'\x01\x02\xff'])
def test_uint8_arrives_as_bytes_whose_elements_are_numbers(data):
    payload = over_the_wire(Packet(data), Packet).payload
    assert payload == b'\x01\x02\xff' and payload[2] == 255
    assert np.frombuffer(payload, np.uint8).tolist() == [1, 2, 255]


@pytest.mark.parametrize('kind', [Packet, numpy_msg(Packet)])
def test_an_array_is_refused_for_uint8(kind):
    with pytest.raises(genpy.SerializationError, match='^field payload must be a list or tuple type$'):
        over_the_wire(kind(np.array([1, 2], np.uint8)), Packet)


def test_floats_are_refused_for_integers():
    with pytest.raises(genpy.SerializationError, match=r'^field data\[\] must be an integer type$'):
        over_the_wire(IntList([1.0]), IntList)
    with pytest.raises(genpy.SerializationError, match='^field data must be a list or tuple type$'):
        over_the_wire(IntList(np.array([1.5])), IntList)
