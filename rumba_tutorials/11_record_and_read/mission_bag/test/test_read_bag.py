"""A bag is read without ROS, in a Python environment created as the lesson says."""

import csv
import os
import pathlib
import subprocess
import sys

import pytest
import rosbag
import rospy
from matplotlib import image

from rumba_msg.msg import BatteryStatus, CleaningStatus

PACKAGE = pathlib.Path(__file__).resolve().parents[1]
WITHOUT_ROS = {name: value for name, value in os.environ.items() if 'ROS' not in name and name != 'PYTHONPATH'}


@pytest.fixture(scope='session')
def python():
    """The Python of the environment, which is created if it does not exist yet."""
    venv = pathlib.Path(os.environ['MISSION_BAG_VENV'])
    wanted = (PACKAGE / 'requirements.txt').read_text()
    made_for = venv / 'made_for.txt'
    if not made_for.exists() or made_for.read_text() != wanted:
        subprocess.check_call([sys.executable, '-m', 'venv', '--clear', '--system-site-packages', str(venv)])
        pip = subprocess.run([f'{venv}/bin/pip', 'install', '-q', '-r', str(PACKAGE / 'requirements.txt')],
                             stderr=subprocess.PIPE, universal_newlines=True)
        if 'No matching distribution' in pip.stderr:  # what pip also says without a network
            pytest.skip(f'pip cannot get rosbags, which Debian lacks: {pip.stderr.strip()}')
        assert pip.returncode == 0, pip.stderr
        made_for.write_text(wanted)
    return f'{venv}/bin/python'


@pytest.fixture
def read_bag(python):
    """A function that runs the reader with arguments, without ROS, and returns the finished process."""
    return lambda *arguments: subprocess.run(
        [python, str(PACKAGE / 'scripts' / 'read_bag'), *map(str, arguments)], env=WITHOUT_ROS,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)


def write_bag(path, messages):
    """Write a bag of (seconds, topic, message)."""
    with rosbag.Bag(str(path), 'w') as bag:
        for seconds, topic, message in messages:
            bag.write(topic, message, rospy.Time.from_sec(seconds))


def test_every_status_becomes_a_row_with_the_coverage_at_its_time(read_bag, tmp_path):
    write_bag(tmp_path / 'mission.bag', [
        (10.0, '/rumba/battery_status', BatteryStatus(99, 1.5, -2.5, 0.0, True, 'one')),
        (10.5, '/rumba/cleaning_status', CleaningStatus(coverage=0.25)),
        (11.5, '/rumba/battery_status', BatteryStatus(percentage_battery=50)),
        (12.0, 'rumba/battery_status', BatteryStatus(42, 1.75, 2.0, 0.0, False, 'two'))])
    process = read_bag(tmp_path / 'mission.bag')
    assert (process.stdout, process.stderr) == ('3 rows, 2 s: battery 99 % to 42 %, 25.0 % swept\n', '')
    assert list(csv.reader((tmp_path / 'mission.csv').open())) == [
        ['time', 'percentage', 'x', 'y', 'brushes_up', 'coverage'],
        ['0.0', '99', '1.5', '-2.5', 'True', 'nan'],
        ['1.5', '50', '0.0', '0.0', 'False', '0.25'],
        ['2.0', '42', '1.75', '2.0', 'False', '0.25']]
    picture = image.imread(str(tmp_path / 'mission.png'))
    assert picture.shape == (500, 800, 4)
    # The curve of the coverage is tab:green and in the lower half.
    green = (picture[..., 1] > 0.5) & (picture[..., 0] < 0.4) & (picture[..., 2] < 0.4)
    rows = green.any(axis=1).nonzero()[0]
    assert rows.size and rows.min() > 235


def test_the_error_names_a_file_that_cannot_be_read(read_bag, tmp_path):
    write_bag(tmp_path / 'other.bag', [(1.0, '/other', BatteryStatus())])
    (tmp_path / 'text.bag').write_text('no bag')
    for arguments, wrong in ((['/no/such.bag'], '/no/such.bag: '), ([tmp_path / 'text.bag'], 'text.bag: '),
                             ([tmp_path / 'other.bag'], 'other.bag: no message on /rumba/battery_status'),
                             ([], 'read_bag BAG: ')):
        process = read_bag(*arguments)
        assert process.returncode == 1 and wrong in process.stderr and 'Traceback' not in process.stderr
