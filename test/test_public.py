"""The public interface: what it names is there, documented, and shown by examples that run."""

import inspect
import re
import subprocess
import sys

import pytest
from workspaces import ROOT

import rumba

PAGE = (ROOT / 'docs' / 'python.md').read_text()
EXAMPLES = re.findall(r'^```python\n(.*?)^```$', PAGE, re.MULTILINE | re.DOTALL)
PRINTED = [r'turned to 0\.[1-9] rad; the laser has 360 beams', r'10 robots: 0\.\d+ of the floor or more is swept',
           'INCOMPLETE', r'(SUCCEEDED: 1\d%, \d+ collisions\n?){2}', r'SUCCEEDED: \d+% in \d+ s',
           r"\['coverage', 'is_success', 'reward'\] Discrete\(6\)"]


def test_the_page_names_all_that_is_public_and_each_has_a_docstring():
    cells = re.findall(r'^\| (`.*?) \|', PAGE, re.MULTILINE)
    assert sorted(name for cell in cells for name in re.findall(r'`(\w+)`', cell)) == sorted(rumba.__all__)
    assert [name for name in rumba.__all__ if not inspect.getdoc(getattr(rumba, name))] == []


@pytest.mark.parametrize('example, printed', zip(EXAMPLES, PRINTED))
def test_an_example_prints_what_it_should(example, printed):
    if 'make_env' in example:
        pytest.importorskip('gymnasium', minversion='1.1', reason="Gymnasium is optional: pip install 'gymnasium'")
    done = subprocess.run([sys.executable, '-c', example], stdout=subprocess.PIPE, universal_newlines=True,
                          check=True)
    assert re.fullmatch(printed, done.stdout.strip())


def test_every_example_is_tried():
    assert len(EXAMPLES) == len(PRINTED)


@pytest.mark.parametrize('points, message', [
    ([[0.5, 2.0]], r'the shape of points is \(1, 2\): must be \(n, 2\)'), ([1.0, 2.0], r'of points is \(2,\)'),
    ([[0.5, 2.0], [float('nan'), 2.0]], 'not finite'), ([[0.5, 2.0], [50.0, 2.0]], 'point 2')])
def test_a_path_that_is_none_is_refused(points, message):
    with pytest.raises(rumba.RumbaError, match=message):
        rumba.score_path(rumba.load_map('studio'), points)


def test_an_unknown_map_is_refused():
    with pytest.raises(rumba.RumbaError, match="there is no map 'nowhere'"):
        rumba.load_map('nowhere')


def test_it_is_typed():
    for folder in ('rumba_evaluation/src/rumba', *(f'{name}/src/{name}' for name in (
            'rumba_sim', 'rumba_localisation', 'rumba_cleaning', 'rumba_evaluation'))):
        assert (ROOT / folder / 'py.typed').exists(), folder
