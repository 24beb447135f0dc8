"""The script of the site in Chromium, on the parts of a page of furo that it mends."""

import importlib.util
import os
import re
import runpy
import shutil

import pytest
from workspaces import ROOT

HAS_BROWSER = all(map(shutil.which, ('chromium', 'chromedriver'))) and importlib.util.find_spec('selenium')
SITE = ROOT / 'docs' / 'site'
PAGE = f'''<!DOCTYPE html><html lang="en"><title>Search - Rumba</title><link rel="stylesheet" href="{SITE}/site.css">
<script src="{SITE}/site.js"></script><body data-theme="auto"><input type="checkbox" id="__navigation">
<label class="overlay sidebar-overlay" for="__navigation">Hide</label>
<aside class="sidebar-drawer"><p class="caption" role="heading">Begin</p></aside>
<label class="nav-overlay-icon" for="__navigation"><b>Pages</b><i class="icon">=</i></label>
<div class="content-icon-container"></div><article role="main">
<div class="highlight"><pre style="overflow-x: auto; width: 300px">short</pre></div>
<div class="highlight"><pre style="overflow-x: auto; width: 300px">{"long " * 100}</pre></div>
<table><thead><tr><th>key</th><th></th></tr></thead></table></article><aside class="toc-drawer"></aside>'''


@pytest.fixture(scope='module')
def browser(tmp_path_factory):
    """Chromium with such a page, on a light desktop."""
    if not HAS_BROWSER:
        pytest.skip('needs chromium, chromium-driver and python3-selenium')
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    path = tmp_path_factory.mktemp('site') / 'page.html'
    path.write_text(PAGE)
    options = webdriver.ChromeOptions()
    for argument in ('--headless=new', '--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage'):
        options.add_argument(argument)
    service = Service('/usr/bin/chromedriver', env={**os.environ, 'TMPDIR': str(path.parent)})  # it leaves sockets
    driver = webdriver.Chrome(service=service, options=options)
    driver.get(path.as_uri())
    yield driver
    driver.quit()


@pytest.mark.parametrize('selector, attribute, values', [
    ('[role=heading]', 'aria-level', ['2']), ('aside', 'aria-label', ['All pages', 'On this page']),
    ('.content-icon-container', 'role', ['region']), ('.overlay', 'aria-hidden', ['true']),
    ('pre', 'tabindex', [None, '0']), ('th', 'textContent', ['key']), ('h1', 'textContent', ['Search - Rumba']),
    ('.icon', 'role', ['button']), ('[role=main] > h1', 'textContent', ['Search - Rumba'])])
def test_what_screen_readers_and_keyboards_need_is_there(browser, selector, attribute, values):
    assert browser.execute_script(
        'return [...document.querySelectorAll(arguments[0])].map(one => arguments[1] in one && arguments[1] !== "role"'
        ' ? one[arguments[1]] : one.getAttribute(arguments[1]))', selector, attribute) == values


def test_the_sidebar_opens_by_the_keyboard(browser):
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    for key, is_open in ((Keys.ENTER, True), (Keys.SPACE, False)):
        browser.find_element(By.CLASS_NAME, 'icon').send_keys(key)
        assert browser.execute_script('return document.getElementById("__navigation").checked') is is_open


@pytest.mark.parametrize('style', ['pygments_style', 'pygments_dark_style'])
def test_the_colours_of_code_differ_from_their_background(style):
    styles = pytest.importorskip('pygments.styles')
    chosen = styles.get_style_by_name(runpy.run_path(str(ROOT / 'docs' / 'conf.py'))[style])
    ground = luminance(chosen.background_color.lstrip('#'))
    for kind, colours in chosen:
        if colours['color'] and 'Whitespace' not in str(kind):
            low, high = sorted((luminance(colours['color']), ground))
            assert (high + 0.05) / (low + 0.05) > 4.5, kind


def luminance(colour):
    """Relative luminance of a colour in hexadecimal digits, as WCAG defines it."""
    digits = colour if len(colour) == 6 else re.sub('(.)', r'\1\1', colour)
    parts = [int(part, 16) / 255.0 for part in re.findall('..', digits)]
    return sum(weight * (part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4)
               for weight, part in zip((0.2126, 0.7152, 0.0722), parts))


@pytest.mark.parametrize('chosen, scheme, theme', [
    ('auto', 'dark', 'dark'), (None, 'light', 'auto'), ('light', 'dark', 'light')])
def test_the_pages_are_dark_where_the_desktop_is_unless_a_person_chose(browser, chosen, scheme, theme):
    if chosen:
        browser.execute_script('document.body.dataset.theme = arguments[0]', chosen)
    browser.execute_cdp_cmd('Emulation.setEmulatedMedia', {'features': [
        {'name': 'prefers-color-scheme', 'value': scheme}]})
    browser.execute_async_script('requestAnimationFrame(() => requestAnimationFrame(arguments[0]))')
    assert browser.execute_script('return document.body.dataset.theme') == theme
