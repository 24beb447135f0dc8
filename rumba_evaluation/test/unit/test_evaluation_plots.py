"""Pictures are drawn of one run, of many runs, and of runs with little coverage."""

import numpy as np
import pytest
from evaluations import case, result, steady
from PIL import Image
from rooms import crooked

from rumba_evaluation.trials import plots
from rumba_evaluation.trials.batch import Job, Trace
from rumba_evaluation.trials.cases import Conditions
from rumba_evaluation.trials.table import Group

MISSED = (213, 94, 0)  # colour of the floor that was missed


def picture(path):
    """The pixels of a picture: int (rows, columns, 3)."""
    with Image.open(path) as image:
        return np.array(image.convert('RGB')).astype(int)


def share(pixels, colour):
    """Share of the pixels that have a colour."""
    return (np.abs(pixels - colour).sum(axis=-1) < 10).mean()


@pytest.mark.parametrize('groups', [
    {Group('room', 'ahead', 1): [steady(1.2)]},
    {Group('room', 'ahead', 1): [result()], Group('room', 'bounce', 2): [result(time=0.0)]},
    {Group('room', f's{number}', 1): [steady(1.0 + 0.1 * number), steady(2.0, 50)] for number in range(8)}])
def test_results_of_any_number_are_drawn(tmp_path, groups):
    plots.draw_results(str(tmp_path), groups)
    assert sorted(path.name for path in tmp_path.iterdir()) == ['coverage_room.png', 'times.png']
    for path in tmp_path.iterdir():
        pixels = picture(path)
        assert pixels.shape[0] > 300 and pixels.shape[1] > 700 and pixels.std() > 10.0


def test_each_map_has_its_own_picture_of_coverage(tmp_path):
    plots.draw_results(str(tmp_path), {Group(name, 'ahead', 1): [steady(1.2)] for name in ('/a/b c.yaml', 'studio')})
    assert sorted(path.name for path in tmp_path.glob('cov*')) == ['coverage_a_b_c.png', 'coverage_studio.png']


def test_a_curve_has_the_values_of_the_results():
    """A run that was twice as slow as T, and reached 50 %."""
    sampled = plots._sampled(steady(2.0, until=50), np.array([0.0, 0.5, 1.0, 1.5]))
    assert sampled.tolist() == [0.0, 25.0, 50.0, 50.0]


def test_a_picture_of_a_path_shows_the_missed_floor(tmp_path):
    plan = crooked(0.02)
    missed = np.zeros((plan.rows, plan.columns), bool)
    shares = []
    for width in (0, 20, 40):
        missed[60:100, 120:120 + width] = True
        path = np.random.default_rng(1).uniform(0.5, 2.5, (200, 2)).astype(np.float32)
        job = Job(case(), Conditions(), 'room.yaml', '')
        plots.draw_path(str(tmp_path), plan, Trace(job, steady(1.5), [path], missed))
        shares.append(share(picture(tmp_path / 'path_room_bounce_1.png'), MISSED))
    legend, small, large = shares
    assert legend < 0.001 and large - small > 0.01
    assert small - legend == pytest.approx(large - small, rel=0.6)  # the paths hide a part of it
