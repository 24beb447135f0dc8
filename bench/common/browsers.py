"""Chromium without a window: pictures of a page in several sizes, light and dark, and what axe-core says of it."""

import importlib.util
import os
import pathlib
import tempfile

CHROMEDRIVER = pathlib.Path('/usr/bin/chromedriver')
IS_THERE = CHROMEDRIVER.exists() and importlib.util.find_spec('selenium') is not None
SCHEMES = ('light', 'dark')
# axe-core is for developers and no part of Debian: npm install axe-core, and its node_modules in NODE_PATH.
AXE = pathlib.Path(os.environ.get('NODE_PATH', ''), 'axe-core', 'axe.min.js')
RUN_AXE = """
const done = arguments[0];
axe.run(document, {resultTypes: ['violations']}).then(({violations}) => done(violations.map(
    ({id, nodes}) => `${id}: ${nodes.map(({target}) => target.join(' ')).join(', ')}`)));
"""


class Browser:
    """A browser for one page at a time."""

    def __init__(self, *arguments):
        """Start Chromium with further arguments; close it with `quit`."""
        from selenium import webdriver
        from selenium.webdriver.chrome.options import Options
        from selenium.webdriver.chrome.service import Service
        options = Options()
        for argument in ('--headless=new', '--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage',
                         '--hide-scrollbars', *arguments):
            options.add_argument(argument)
        self._folder = tempfile.TemporaryDirectory()  # Chromium leaves sockets behind
        service = Service(str(CHROMEDRIVER), env={**os.environ, 'TMPDIR': self._folder.name})
        self.driver = webdriver.Chrome(service=service, options=options)

    def quit(self):
        """Close it."""
        self.driver.quit()
        self._folder.cleanup()

    def look(self, size, scheme):
        """Have a screen of a size [pixels] that is light or dark."""
        self.driver.execute_cdp_cmd('Emulation.setDeviceMetricsOverride', {
            'width': size[0], 'height': size[1], 'deviceScaleFactor': 1, 'mobile': False})
        self.driver.execute_cdp_cmd('Emulation.setEmulatedMedia', {'features': [
            {'name': 'prefers-color-scheme', 'value': scheme}]})
        self.driver.execute_async_script('requestAnimationFrame(() => requestAnimationFrame(arguments[0]))')

    def violations(self):
        """What axe-core finds wrong: one line for each rule; none without axe-core."""
        if not AXE.exists():
            return []
        if not self.driver.execute_script('return Boolean(window.axe)'):
            self.driver.execute_script(AXE.read_text())
        return self.driver.execute_async_script(RUN_AXE)
