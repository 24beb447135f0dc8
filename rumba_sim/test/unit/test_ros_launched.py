"""Parameters of a file, which nobody changes on the parameter server."""

import json

import pytest

from rumba_sim.ros.running import launched


@pytest.fixture
def parameters(tmp_path, monkeypatch):
    """Parameters as a launch file sets them."""
    path = tmp_path / 'parameters.json'
    path.write_text(json.dumps({'nodes': ['/judge'], 'parameters': {
        '/judge/coverage': 0.3, '/judge/a/b': 1, '/judge/a/c/d': [2], '/judges/x': 3, '/use_sim_time': True}}))
    monkeypatch.setenv(launched.VARIABLE, str(path))


def test_a_node_finds_those_below_its_name(parameters):
    assert launched.is_fixed() and launched.nodes() == ['/judge'] and launched.parameters()['/judges/x'] == 3
    assert launched.below('/judge') == {'coverage': 0.3, 'a': {'b': 1, 'c': {'d': [2]}}}
    assert launched.below('/other') == {}


def test_without_the_variable_the_parameter_server_counts(monkeypatch):
    monkeypatch.delenv(launched.VARIABLE, raising=False)
    assert not launched.is_fixed()
