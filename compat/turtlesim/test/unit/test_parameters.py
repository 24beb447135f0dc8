"""Bad parameters are refused with a message that names good values."""

import pytest

from turtlesim.model.errors import TurtlesimError
from turtlesim.ros import node

PARAMETERS = {
    'scale': node.number(2.0, 0.0, 1000.0, 'a factor'),
    'path': node.Parameter('here', lambda value: type(value) is str and value != '', 'a path', 'where'),
}


@pytest.fixture
def server(monkeypatch):
    """The private parameters of the node on the parameter server, as a dictionary."""
    private = {}
    monkeypatch.setattr(node.rospy, 'get_param', lambda name, default: private.get(name[1:], default))
    monkeypatch.setattr(node.rospy, 'resolve_name', lambda name: f'/node/{name[1:]}')
    return private


def test_a_parameter_that_is_not_set_has_its_default(server):
    server['scale'] = 3
    assert node.read(PARAMETERS, 'path', 'scale') == ['here', 3]


@pytest.mark.parametrize('name, value, message', [
    ('scale', -1, '^parameter /node/scale is -1: must be 0 to 1000$'),
    ('scale', float('nan'), '^parameter /node/scale is nan: must be 0 to 1000$'),
    ('scale', True, '^parameter /node/scale is True: must be 0 to 1000$'),
    ('scale', 'fast', "^parameter /node/scale is 'fast': must be 0 to 1000$"),
    ('path', 5, '^parameter /node/path is 5: must be a path$'),
    ('path', '', "^parameter /node/path is '': must be a path$")])
def test_a_bad_value_is_refused(server, name, value, message):
    server[name] = value
    with pytest.raises(TurtlesimError, match=message):
        node.read(PARAMETERS, name)
