"""The script of the site in Chromium, on the parts of a page of furo that it mends."""

import importlib.util
import os
import shutil

import pytest
from workspaces import ROOT

HAS_BROWSER = all(map(shutil.which, ('chromium', 'chromedriver'))) and importlib.util.find_spec('selenium')
pytestmark = pytest.mark.skipif(not HAS_BROWSER, reason='needs chromium, chromium-driver and python3-selenium')
SITE = ROOT / 'docs' / 'site'
PAGE = f'''<!DOCTYPE html><html lang="en"><title>Search - Rumba</title><link rel="stylesheet" href="{SITE}/site.css">
<script src="{SITE}/site.js"></script><body data-theme="auto"><input type="checkbox" id="__navigation">
<label class="overlay sidebar-overlay" for="__navigation">Hide</label>
<aside class="sidebar-drawer"><p class="caption" role="heading">Begin</p></aside>
<label class="nav-overlay-icon" for="__navigation">Pages</label>
<div class="content-icon-container"></div><article role="main">
<div class="highlight"><pre style="overflow-x: auto; width: 300px">short</pre></div>
<div class="highlight"><pre style="overflow-x: auto; width: 300px">{"long " * 100}</pre></div>
<table><thead><tr><th>key</th><th></th></tr></thead></table></article><aside class="toc-drawer"></aside>'''


@pytest.fixture(scope='module')
def browser(tmp_path_factory):
    """Chromium with such a page, on a light desktop."""
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
    ('.nav-overlay-icon', 'role', ['button'])])
def test_what_screen_readers_and_keyboards_need_is_there(browser, selector, attribute, values):
    assert browser.execute_script(
        'return [...document.querySelectorAll(arguments[0])].map(one => arguments[1] in one && arguments[1] !== "role"'
        ' ? one[arguments[1]] : one.getAttribute(arguments[1]))', selector, attribute) == values


def test_the_sidebar_opens_by_the_keyboard(browser):
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    for key, is_open in ((Keys.ENTER, True), (Keys.SPACE, False)):
        browser.find_element(By.CLASS_NAME, 'nav-overlay-icon').send_keys(key)
        assert browser.execute_script('return document.getElementById("__navigation").checked') is is_open


@pytest.mark.parametrize('chosen, scheme, theme', [
    ('auto', 'dark', 'dark'), (None, 'light', 'auto'), ('light', 'dark', 'light')])
def test_the_pages_are_dark_where_the_desktop_is_unless_a_person_chose(browser, chosen, scheme, theme):
    if chosen:
        browser.execute_script('document.body.dataset.theme = arguments[0]', chosen)
    browser.execute_cdp_cmd('Emulation.setEmulatedMedia', {'features': [
        {'name': 'prefers-color-scheme', 'value': scheme}]})
    browser.execute_async_script('requestAnimationFrame(() => requestAnimationFrame(arguments[0]))')
    assert browser.execute_script('return document.body.dataset.theme') == theme
