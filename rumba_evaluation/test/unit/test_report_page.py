"""The page and its figures: the figures have the values of the record, and the page needs no other file."""

import html.parser
import re

import numpy as np
import pytest
from mission_bags import CORNERS, record
from pytest import approx

from rumba_cleaning.mission.stages import State
from rumba_evaluation.report import report_figures
from rumba_evaluation.report.mission_events import events
from rumba_evaluation.report.mission_record import Grid, MissionRecord, MissionState, Series, series
from rumba_evaluation.report.report_figures import figures
from rumba_evaluation.report.report_page import page
from rumba_evaluation.report.report_slider import track
from rumba_sim.model.maps.floor_colours import DARK

VOID = ('meta', 'br', 'img', 'input')


class Checker(html.parser.HTMLParser):
    """Reads a page tag by tag, and checks that each tag is closed."""

    def __init__(self):
        super().__init__()
        self.open, self.ids, self.found, self.text = [], [], [], ''

    def handle_starttag(self, tag, attrs):
        self.found.append((tag, dict(attrs)))
        self.ids += [value for name, value in attrs if name == 'id']
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.handle_endtag(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data


class Axes:
    """Stores the arguments of imshow."""

    def imshow(self, picture, **options):
        vars(self).update(picture=picture, **options)


def check(text):
    """A page that was read to its end."""
    checker = Checker()
    checker.feed(text)
    checker.close()
    assert checker.open == []
    assert len(checker.ids) == len(set(checker.ids))
    return checker


def group(figure, name):
    """The points (n, 2) of the lines of a group of a figure, y down, and the number of lines."""
    drawn = re.search(rf'<g id="{name}">\s*<path [^>]*?\bd="([^"]*)"', figure).group(1)
    points = [[float(x), float(y)] for _, x, y in re.findall(r'([ML]) (\S+) (\S+)', drawn)]
    return np.array(points), drawn.count('M')


# --- the page -------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('changes', [
    {}, {'floor': None}, {'swept': None}, {'coverage': series([], [])}, {'states': ()}, {'areas': None},
    {'power': series([], []), 'pressed': series([], []), 'docked': series([], []), 'charging': series([], [])},
    {'path': series([5.0], [[1.0, 2.0]]), 'charge': series([5.0], [50.0]), 'floor': None, 'swept': None}])
def test_a_page_is_complete_and_needs_no_other_file(changes):
    text = page(record(**changes))
    checker = check(text)
    tags = [tag for tag, _ in checker.found]
    assert not {'link', 'iframe', 'object', 'base'} & set(tags)
    for tag, attributes in checker.found:
        for name in ('href', 'xlink:href', 'src', 'srcset', 'action'):
            assert attributes.get(name, '#').startswith(('#', 'data:image/png;base64,')), (tag, name)
    assert set(re.findall(r'\w+://[^"\s<]*', text)) <= {'http://www.w3.org/2000/svg', 'http://www.w3.org/1999/xlink'}
    assert '@import' not in text and not re.search(r'url\((?!#)', text)
    assert 'nan' not in checker.text.lower()
    assert {'main', 'h1', 'figure', 'table'} <= set(tags)


def test_what_is_not_on_the_robots_own_map_is_faint(monkeypatch):
    drawn = []
    monkeypatch.setattr(report_figures, '_show', lambda _, grid, layer: drawn.append((grid.cells.tolist(), layer)))
    floor = Grid(np.array([[0, 0, 100], [0, 0, 100]], np.int8), 1.0, 0.0, 0.0)
    known = floor._replace(cells=np.array([[0, 100, 100], [-1, -1, -1]], np.int8))
    swept = floor._replace(cells=np.array([[100, 0, -1], [0, 100, -1]], np.int8))
    own = record(floor=floor, known=known, swept=swept)
    text = page(own)
    plain = [(floor.cells.tolist(), ('out_of_reach', 255, 0)), (swept.cells.tolist(), ('to_sweep', 255, 0)),
             (swept.cells.tolist(), ('swept', 255, 50)), (floor.cells.tolist(), ('wall', 255, 65))]
    assert drawn == [*plain, ([[-1, -1, -1], [0, 0, 0]], ('veil', 178, 0)), (known.cells.tolist(), ('wall', 255, 65))]
    assert "not on the robot's map" in check(text).text
    drawn.clear()
    assert "not on the robot's map" not in check(page(record(floor=floor, swept=swept))).text
    assert drawn == plain


def test_all_references_have_a_target():
    text = page(record())
    wanted = set(re.findall(r'(?:url\(#|href="#)([^)"]+)', text))
    assert wanted and wanted <= set(check(text).ids)


def test_each_figure_has_a_description_for_screen_readers():
    told = [attributes['aria-label'] for tag, attributes in check(page(record(robot='<r>'))).found if tag == 'svg']
    assert len(told) == 3 and 'path of <r>' in told[0] and '90.0 %' in told[1] and '100 % to 50 %' in told[2]


def test_names_and_messages_are_escaped():
    text = page(record(source='a/<b>&"c".bag', robot='<i>', remarks=['<u>&']))
    assert all(wrong not in text for wrong in ('<b>&', '<i>', '<u>', '<end>'))
    checker = check(text)
    for right in ('Mission of <i>', '<b>&"c".bag', '<u>&', 'stranded: the <end> & more'):
        assert right in checker.text


def test_the_page_says_what_was_not_recorded():
    bare = MissionRecord('a.bag', 'rumba', series([0.0], [[0.0, 0.0]]), series([0.0], [50.0]))
    text = check(page(bare)).text
    # Five figures, map, strategy, outcome.
    assert text.count('not recorded') == 8 and text.count('Not recorded.') == 1
    assert 'at rest' in text


def test_a_long_list_of_events_is_cut():
    states = [MissionState(0.1 * number, 2 + number % 2, '', '') for number in range(300)]
    text = page(record(states=states))
    assert text.count('</td></tr>') - text.count('</th><td>') == 201
    assert f'... and {len(events(record(states=states))) - 200} more' in text


@pytest.mark.parametrize('began, told', [(49.8, '49.8 s after the simulation began'),
                                         (1_700_000_000.0, '2023-11-14 22:13:20 UTC')])
def test_the_start_is_a_date_or_a_time_of_the_simulation(began, told):
    assert told in page(record(began=began))


def test_the_page_of_an_hour_is_small():
    times = np.arange(0.0, 3600.0, 0.1)
    turns = np.cumsum(np.random.default_rng(1).normal(0.0, 0.1, len(times)))
    path = Series(times, np.cumsum(0.03 * np.array([np.cos(turns), np.sin(turns)]).T, axis=0))
    long = record(path=path, pressed=Series(times, (np.arange(len(times)) % 20 < 3).astype(float)),
                  charge=Series(times, 50.0 + np.sin(times)))
    text = page(long)
    assert len(text.encode()) < 2_000_000
    assert text == page(long)


# --- the slider -----------------------------------------------------------------------------------------------------

def test_the_track_of_the_slider_lies_on_the_drawn_path():
    points, _ = group(figures(record()).path, 'map-path')
    found = track(record())
    assert np.array([found['x'], found['y']]).T / 10.0 == approx(points, abs=0.06)
    assert found['t'] == [0.0, 40.0, 60.0, 100.0] and found['duration'] == 100.0
    scale = (points[1, 0] - points[0, 0]) / 4.0
    assert (found['brush'], found['radius']) == approx((0.17 * scale, 0.1743 * scale), rel=0.01)


def test_the_track_tells_where_the_robot_cleaned_and_what_it_had_done():
    found = track(record())
    assert found['clean'] == [1, 1, 1, 0]  # stranded after 80 s
    assert found['bumps'] == [50.0, 70.0] and found['states'] == [[0.0, 'cleaning'], [80.0, 'stranded']]
    assert (found['charge'][0], found['charge'][-1], found['swept'][249:251]) == (100.0, 50.0, [10.0, 30.0])


def test_the_track_breaks_at_a_jump_and_is_never_long():
    times = np.arange(0.0, 40000.0)
    path = Series(times, np.stack([0.3 * times, np.where(times < 20000.0, 0.0, 50.0)], axis=1))
    found = track(record(path=path))
    assert len(found['t']) <= 8010 and len(found['breaks']) == 1
    assert found['t'][found['breaks'][0] - 1:found['breaks'][0] + 1] == [19999.0, 20000.0]


def test_a_map_that_is_a_picture_has_no_slider(monkeypatch):
    monkeypatch.setattr(report_figures, 'LARGE', 1000)
    assert '<script' not in page(record()) and 'type="range"' not in page(record())


# --- the figures ----------------------------------------------------------------------------------------------------

def test_the_map_has_equal_axes_and_y_goes_up():
    points, lines = group(figures(record()).path, 'map-path')
    assert lines == 1 and len(points) == 4
    scale = (points[1, 0] - points[0, 0]) / 4.0
    assert scale > 10.0
    assert (points - points[0]) / (scale, -scale) == approx(CORNERS, abs=1e-3)


@pytest.mark.parametrize('corners', [[[0.0, 0.0], [9.0, 0.0], [0.0, 0.1]], [[0.0, 0.0], [0.1, 0.0], [0.0, 9.0]]])
def test_axes_are_equal_also_if_the_floor_is_wide_or_high(corners):
    figure = figures(record(path=series([0, 50, 100], corners), floor=None, swept=None)).path
    points, _ = group(figure, 'map-path')
    scale = np.ptp(points, axis=0).max() / 9.0
    assert (points - points[0]) / (scale, -scale) == approx(np.array(corners), abs=2e-3)
    width, height = (float(size) for size in re.search(r'viewBox="0 0 (\S+) (\S+)"', figure).groups())
    assert 0.25 < width / height < 4.0 and max(width, height) < 700.0


def test_the_path_has_a_gap_at_a_jump():
    jumping = series([0, 2, 2.1, 5], [[0.0, 0.0], [1.0, 0.0], [3.0, 0.0], [3.0, 1.0]])
    _, lines = group(figures(record(path=jumping)).path, 'map-path')
    assert lines == 2


def test_the_map_and_the_swept_floor_are_drawn_as_pictures():
    report = figures(record()).path
    layers = ['out_of_reach', 'to_sweep', 'swept', 'wall']  # each for light and for dark screens
    assert re.findall('<image class="(.*?)"', report) == [
        f'{scheme} {layer}' for layer in layers for scheme in ('light', 'dark')]
    assert figures(record(floor=None)).path.count('<image') == 4
    assert figures(record(floor=None, swept=None)).path.count('<image') == 0


def test_each_value_of_a_cell_has_its_colour():
    axes = Axes()
    report_figures._show(axes, Grid(np.array([[100, 0, -1], [64, 65, 0]], np.int8), 0.5, -1.0, 2.0),
                         ('swept', 90, 65))
    picture = axes.picture[::axes.picture.shape[0] // 2, ::axes.picture.shape[1] // 3]
    assert picture[:, :, 3].tolist()[0][:3] == [90, 0, 0] and picture[:, :, 3].tolist()[1][:3] == [0, 90, 0]
    assert bytes(picture[0, 0]) == bytes.fromhex(f'{DARK.swept[1:]}5a')  # the last of both
    assert axes.origin == 'lower' and axes.extent == (-1.0, 0.5, 2.0, 3.0)


def test_a_fine_grid_is_drawn_with_larger_cells_at_the_same_position(monkeypatch):
    monkeypatch.setattr(report_figures, 'MOST_CELLS', 2)
    monkeypatch.setattr(report_figures, 'FEWEST_DOTS', 1)
    axes = Axes()
    cells = np.full((2, 5), -1, np.int8)
    cells[1, 4] = 100
    report_figures._show(axes, Grid(cells, 1.0, 0.0, 0.0), ('wall', 255, 65))
    assert axes.picture[:, :, 3].tolist() == [[0, 255]] and axes.extent == (0.0, 6.0, 0.0, 3.0)


def test_the_curve_of_the_coverage_is_in_scale():
    points, _ = group(figures(record()).coverage, 'coverage-coverage')
    across, up = points[1:, 0] - points[0, 0], points[0, 1] - points[1:, 1]
    assert across[1] / across[0] == approx(2.0, abs=1e-3)
    assert up[1] / up[0] == approx(4.0, abs=0.01)  # from 10 % to 30 %, and to 90 %


def test_times_of_charging_are_shaded():
    figure = figures(record()).battery
    shades = re.findall(r'<path [^>]*?\bd="([^"]*)"[^>]*style="fill: ?var\(--charging\)', figure)
    line, _ = group(figure, 'battery-battery')
    left, scale = line[0, 0], (line[-1, 0] - line[0, 0]) / 100.0
    edges = [sorted({round((float(x) - left) / scale) for x in re.findall(r'[ML] (\S+) \S+', shade)})
             for shade in shades]
    assert edges == [[10, 20], [30, 40]]


def test_a_figure_that_is_too_large_as_svg_is_a_png_picture(monkeypatch):
    monkeypatch.setattr(report_figures, 'LARGE', 1000)
    checker = check(page(record(robot='"r"')))
    pictures = [attributes for tag, attributes in checker.found if tag == 'img']
    assert len(pictures) == 3 and all(picture['src'].startswith('data:image/png;base64,iVBOR') for picture in pictures)
    assert 'path of "r"' in pictures[0]['alt']


def test_each_state_has_a_colour_of_its_own():
    colours = [report_figures.state_colour(state) for state in (*State, max(State) + 1)]
    assert len(set(colours)) == len(colours)


def test_the_legend_has_the_states_with_their_times():
    text = check(page(record())).text
    assert 'cleaning 0:01:20' in text and 'stranded 0:00:20' in text
