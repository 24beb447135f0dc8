"""The report in Chromium: the slider shows the mission until a time, and all of it at the end."""

import importlib.util
import io
import os
import shutil

import numpy as np
import pytest
from mission_bags import record
from PIL import Image

from rumba_evaluation.report.report_page import page
from rumba_sim.model.maps.floor_colours import DARK, LIGHT

HAS_BROWSER = all(map(shutil.which, ('chromium', 'chromedriver'))) and importlib.util.find_spec('selenium')
pytestmark = pytest.mark.skipif(not HAS_BROWSER, reason='needs chromium, chromium-driver and python3-selenium')
AT = """
const [input, output] = ['input[type=range]', 'output'].map(name => document.querySelector(name));
input.value = arguments[0];
input.oninput();
const path = document.querySelector('#map-path path').getAttribute('d');
const shown = query => [...document.querySelectorAll(query)].filter(
    one => getComputedStyle(one).visibility === 'visible' && getComputedStyle(one).display !== 'none').length;
return [path.match(/[ML]/g).length, shown('#map-bumps use'), shown('svg.map image'), shown('svg line'),
        output.textContent];
"""


@pytest.fixture(scope='module')
def browser(tmp_path_factory):
    """Chromium with the page of a mission of 100 s."""
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    path = tmp_path_factory.mktemp('page') / 'report.html'
    path.write_text(page(record()), encoding='utf-8')
    options = webdriver.ChromeOptions()
    for argument in ('--headless=new', '--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage'):
        options.add_argument(argument)
    options.set_capability('goog:loggingPrefs', {'browser': 'ALL'})
    environment = {**os.environ, 'TMPDIR': str(path.parent)}  # Chromium leaves sockets behind
    service = Service('/usr/bin/chromedriver', env=environment)
    driver = webdriver.Chrome(service=service, options=options)
    driver.get(path.as_uri())
    yield driver
    driver.quit()


@pytest.mark.parametrize('place, points, bumps, pictures, cursors, told', [
    (1000, 4, 2, 4, 0, '0:01:40 · stranded · battery 50 % · 90.0 % swept'),
    (0, 1, 0, 3, 2, '0:00:00 · cleaning · battery 100 % · 10.0 % swept'),
    (550, 2, 1, 3, 2, '0:00:55 · cleaning · battery 100 % · 30.0 % swept')])
def test_the_slider_shows_the_mission_until_a_time(browser, place, points, bumps, pictures, cursors, told):
    assert browser.execute_script(AT, place) == [points, bumps, pictures, cursors, told]
    assert browser.get_log('browser') == []


@pytest.mark.parametrize('scheme, colours', [('light', LIGHT), ('dark', DARK)])
def test_the_map_has_the_colours_of_window_and_page(browser, scheme, colours):
    browser.execute_cdp_cmd('Emulation.setEmulatedMedia', {'features': [
        {'name': 'prefers-color-scheme', 'value': scheme}]})
    browser.execute_script(AT, 1000)
    png = browser.find_element('css selector', 'svg.map').screenshot_as_png
    seen = np.asarray(Image.open(io.BytesIO(png)).convert('RGB')).reshape(-1, 3).astype(int)
    for name, fewest in (('swept', 1000), ('to_sweep', 1000), ('wall', 100)):
        colour = list(bytes.fromhex(getattr(colours, name)[1:]))
        assert (abs(seen - colour).max(axis=1) <= 2).sum() > fewest, name
    assert (abs(seen - list(bytes.fromhex(colours.lines[0][1:]))).max(axis=1) <= 30).sum() > 50  # lines are smoothed


def test_bumps_can_be_hidden(browser):
    browser.find_element('css selector', 'label[for=bumps]').click()
    assert not browser.find_element('css selector', '#map-bumps').is_displayed()


def test_a_press_of_the_time_of_an_event_shows_it_on_the_map(browser):
    buttons = browser.find_elements('css selector', '.events button')
    times = [button.text for button in buttons]
    assert len(times) > 2 and times == sorted(times)
    for button in buttons[:-1]:
        browser.execute_script('arguments[0].click()', button)
        assert browser.find_element('css selector', 'output').text.startswith(f'{button.text} · ')
    assert browser.get_log('browser') == []
