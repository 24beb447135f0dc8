"""Paths in files: what is read, and the one line that says what is wrong, and where."""

import math

import numpy as np
import pytest
from paths import bare, path
from pytest import approx

from rumba_evaluation.scoring import drawn_path, path_file
from rumba_evaluation.scoring.drawn_path import PathError
from rumba_evaluation.scoring.path_file import read

TUM = '1305031098.6659 1.0 2.0 0.0 0.0 0.0 0.70710678 0.70710678\n1305031099.1659 1.0 3.5 0.1 0 0 0 1\n'


@pytest.fixture
def file(tmp_path):
    """A function that writes a file and returns its path."""
    def write(content, name='path.csv'):
        target = tmp_path / name
        target.write_bytes(content if isinstance(content, bytes) else content.encode())
        return str(target)
    return write


def test_csv_with_and_without_times_and_headings(file):
    found = read(file('x,y\n1,2\n\n# a comment\n1.5,-2e-1\n'))
    assert found.points.tolist() == [[1.0, 2.0], [1.5, -0.2]] and found.headings is found.times is None
    assert found.places == ['line 2', 'line 5']
    found = read(file('\ufefftheta, y ,x,t\r\n0.5,2,1,7\r\n1.5,2,3,9\r\n', 'odd.txt'))
    assert (found.points.tolist(), found.headings.tolist(), found.times.tolist()) == (
        [[1.0, 2.0], [3.0, 2.0]], [0.5, 1.5], [0.0, 2.0])


def test_tum_with_large_times(file):
    found = read(file('# timestamp tx ty tz qx qy qz qw\n' + TUM, 'path.tum'))
    assert found.points.tolist() == [[1.0, 2.0], [1.0, 3.5]]
    assert found.headings.tolist() == approx([0.5 * math.pi, 0.0]) and found.times.tolist() == approx([0.0, 0.5])


def test_one_heading_for_a_bent_path_and_one_time_for_all_poses_mean_nothing():
    bent = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)]
    found = path(bent, headings=[0.0] * 3, times=[5.0] * 3)
    assert found.headings is found.times is None and found.start == (0.0, 0.0, 0.0)
    assert path(bent[:2], headings=[0.0] * 2).headings is not None
    assert path([(0.0, 0.0), (0.0, 0.0), (0.0, 2.0)]).start == (0.0, 0.0, approx(0.5 * math.pi))


@pytest.mark.parametrize('content, message', [
    ('', r'path.csv: is empty: must be CSV \(x,y in the first line\), TUM \(timestamp tx .* qw\) or a bag$'),
    ('\n# nothing\n', 'path.csv: is empty'),
    ('x,y\n', 'path.csv: has no poses: must have two or more$'),
    ('x,y\n1,2\n', 'path.csv: has 1 pose: must have two or more$'),
    ('x,yy\n1,2\n', r"path.csv, line 1: column 'yy' is unknown: did you mean 'y'\?$"),
    ('1,2\n3,4\n', r"path.csv, line 1: column '1' is unknown: must name the columns, as in x,y or t,x,y,theta$"),
    ('x,y,speed\n', "path.csv, line 1: column 'speed' is unknown: known are t, x, y, theta$"),
    ('x,x,y\n', 'path.csv, line 1: column x appears twice$'),
    ('t,x\n', 'path.csv, line 1: column y is missing: must be as in x,y or t,x,y,theta$'),
    ('x,y\n1,2\n3\n', 'path.csv, line 3: has 1 values: must have 2, x,y$'),
    ('x,y\n1,2\n3,4,5\n', 'path.csv, line 3: has 3 values: must have 2, x,y$'),
    ('x,y\n1,2\n3,nan\n', 'path.csv, line 3: y is nan: must be a finite number$'),
    ('x,y\n1,2\n-inf,3\n', 'path.csv, line 3: x is -inf: must be a finite number$'),
    ('x,y\n1,2\n1e999,3\n', 'path.csv, line 3: x is 1e999: must be a finite number$'),
    ('x,y\n1,2\n3,four\n', "path.csv, line 3: y is 'four': must be a number$"),
    ('t,x,y\n5,1,2\n6,1,3\n4,1,4\n', r'path.csv, line 4: the time goes back \(-1 s after 1 s since the first pose\)'),
    ('t,x,y\n5,1,2\n6,1,3\n6,1,4\n', 'path.csv, line 4: the time stands still'),
    ('t,x,y\n0,1,2\n90000,1,3\n', 'path.csv: takes 90000 s: must take a day at most$'),
    ('x,y\n1,2\n1,2\n', 'path.csv: is shorter than 0.01 m: a path leads somewhere$'),
    (b'x,y\n1,2\n\xff\xfe,3\n', 'path.csv, line 3: is not text: must be CSV, TUM or a bag$'),
    (b'x,y\n' + 5000 * b'1', 'path.csv, line 2: is longer than 1000 characters: must be a pose$'),
    ('x;y\n1;2\n', "path.csv, line 1: column 'x;y' is unknown"),
])
def test_what_is_wrong_with_a_csv_file(file, content, message):
    with pytest.raises(PathError, match=message) as error:
        read(file(content))
    assert '\n' not in str(error.value)


@pytest.mark.parametrize('content, message', [
    ('1 2 3\n', r'path.tum, line 1: has 3 values: must be TUM, timestamp .* qw, or CSV with x,y in the first line$'),
    (TUM + '3 1 2 0 0 0 0 0\n', 'path.tum, line 3: the quaternion has length 0: must have length 1$'),
    (TUM + '3 1 nan 0 0 0 0 1\n', 'path.tum, line 3: ty is nan: must be a finite number$'),
    (TUM + '3 1 2 0 0 0 0 1\n', 'path.tum, line 3: the time goes back'),
])
def test_what_is_wrong_with_a_tum_file(file, content, message):
    with pytest.raises(PathError, match=message):
        read(file(content, 'path.tum'))


def test_files_that_are_huge_missing_or_no_files(file, tmp_path, monkeypatch):
    monkeypatch.setattr(path_file, 'MOST_BYTES', 20)
    with pytest.raises(PathError, match='is larger than 0 MB: leave poses out$'):
        read(file('x,y\n' + 10 * '1,2\n'))
    monkeypatch.setattr(path_file, 'MOST_BYTES', 1000)
    for module in (path_file, drawn_path):
        monkeypatch.setattr(module, 'MOST_POSES', 3)
    with pytest.raises(PathError, match='path.csv, line 5: has more than 3 poses: leave some out$'):
        read(file('x,y\n' + 10 * '1,2\n'))
    with pytest.raises(PathError, match='none.csv: No such file or directory$'):
        read(str(tmp_path / 'none.csv'))
    with pytest.raises(PathError, match='is a directory: must be a regular file$'):
        read(str(tmp_path))


def test_a_bag_needs_ros_and_only_a_bag_has_topics(file):
    bag = file(b'#ROSBAG V2.0\n')
    with pytest.raises(PathError, match=r'path.csv: is a bag, and to read bags needs ROS: run `rosrun .* evaluate`'):
        read(bag)
    assert read(bag, '/plan', lambda name, topic: (name, topic)) == (bag, '/plan')
    with pytest.raises(PathError, match='is not a bag: only with one, --topic has a meaning$'):
        read(file('x,y\n1,2\n2,2\n'), '/plan')


@pytest.mark.parametrize('points, message', [
    ([(1, 1), (9, 1), (1, -3)], r'a path, pose 2: \(9.00, 1.00\) m lies outside the map room \(x -0.05 to 4.05 m, '
                                r'y -0.05 to 4.05 m\); so does 1 more$'),
    ([(1, 1), (1, 2), (-0.01, 2)], r'a path, pose 3: \(-0.01, 2.00\) m lies in a wall of the map room'),
    ([(1e300, 1), (1, 2)], 'a path, pose 1: .* lies outside the map')])
def test_poses_off_the_map_or_in_a_wall(points, message):
    with pytest.raises(PathError, match=message):
        drawn_path.check_on_map(path(points), bare())
    drawn_path.check_on_map(path([(0.01, 0.01), (3.99, 3.99)]), bare())


@pytest.mark.parametrize('what', ['headings', 'times'])
def test_what_no_number_is(what):
    with pytest.raises(PathError, match=f'a path, pose 2: the {what[:-1]} must be finite numbers$'):
        path([(0, 0), (1, 0)], **{what: [0.0, np.nan]})
