"""The lists of libraries of the supported systems: complete, exact, and the bounds of the Python distribution."""

import re

import pytest
import yaml
from checkouts import make_checkout, rumba
from workspaces import ROOT

LISTS = sorted((ROOT / 'test' / 'platforms').glob('*.txt'))
OF_LIST = pytest.mark.parametrize('path', LISTS, ids=lambda path: path.stem)
PYTHON = re.compile(r'# Python (3\.\d+): ')


def versions(path):
    """The version of each library in a list, as numbers; an empty one for the newest."""
    lines = [re.match(r'([\w-]+)(?:==([\d.]+))?', line).groups() for line in path.read_text().splitlines()
             if not line.startswith('#')]
    return {name.lower(): numbers(version or '') for name, version in lines}


def numbers(version):
    return tuple(int(part) for part in version.split('.') if part)


def bounds():
    """The lowest version that the distribution asks for, by library."""
    text = (ROOT / 'pyproject.toml').read_text()
    found = re.findall(r'"([\w-]+)>=([\d.]+)"', re.search(r'^dependencies = .*$', text, re.MULTILINE).group())
    return {name: numbers(version) for name, version in found}


@OF_LIST
def test_a_list_begins_with_the_version_of_python_and_has_each_library_that_is_needed(path):
    assert PYTHON.match(path.read_text())
    assert {*bounds(), 'matplotlib', 'pytest', 'pytest-xdist', 'hypothesis', 'psutil', 'tornado',
            'pyqt5'} <= {*versions(path)}


@OF_LIST
def test_all_versions_are_exact_but_those_of_the_newest(path):
    assert all(versions(path).values()) == (path.stem != 'newest')


@pytest.mark.parametrize('name', sorted(bounds()))
def test_the_lower_bound_of_a_library_is_its_oldest_version_in_the_lists(name):
    oldest = min(versions(path)[name] for path in LISTS if path.stem != 'newest')
    assert oldest[:len(bounds()[name])] == bounds()[name]


def test_hosted_ci_and_the_page_know_each_list_and_its_python():
    job = yaml.safe_load((ROOT / '.github' / 'workflows' / 'test.yml').read_text())['jobs']['platform']
    wanted = {path.stem: PYTHON.match(path.read_text()).group(1) for path in LISTS}
    assert {each['platform']: each['python'] for each in job['strategy']['matrix']['include']} == wanted
    rows = re.findall(r'^\| `(\w+)` \| [^|]+ \| ([\d.]+) \|', (ROOT / 'docs' / 'building.md').read_text(), re.MULTILINE)
    assert dict(rows) == wanted


def test_an_unknown_platform_is_refused_with_those_that_there_are(tmp_path):
    checkout = make_checkout(tmp_path / 'checkout')
    (checkout / 'test' / 'platforms').mkdir(parents=True)
    for name in ('focal', 'jammy'):
        (checkout / 'test' / 'platforms' / f'{name}.txt').write_text('# Python 3.99: not there\n')
    for given in ('focall', ''):
        code, _, error = rumba(checkout, 'test', '--platform', given)
        assert (code, error) == (2, f"rumba: unknown platform '{given}': give one of these: focal jammy\n")
    code, _, error = rumba(checkout, 'test', '--platform', 'focal')
    assert (code, error) == (1, 'rumba: there is no Python 3.99, neither python3.99 in PATH nor in pyenv: '
                                'pyenv install 3.99\n')
