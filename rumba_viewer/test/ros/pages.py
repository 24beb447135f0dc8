"""What the tests of the page share: a page as a user starts it, a client of its protocol, and a browser."""

import importlib.util
import io
import itertools
import json
import os
import re
import shutil
import tempfile

import numpy as np
import programs
import rospy
from PIL import Image
from simulators import TIMEOUT, Master, Simulator, wait
from tornado.ioloop import IOLoop
from tornado.websocket import websocket_connect

HAS_BROWSER = all(map(shutil.which, ('chromium', 'chromedriver'))) and importlib.util.find_spec('selenium')
PHONE, DESK = (360, 740), (1280, 800)  # [pixels]
HALF = '\ud83d'  # of a character, as JavaScript cuts texts
ROBOT = (31, 111, 214)  # colour of the first robot


class Page:
    """A page for one test, and what it prints."""

    def __init__(self, test, *arguments, port=0, master=None):
        self._test = test
        if master is None and rospy.has_param('/page'):
            rospy.delete_param('/page')
        environment = {**os.environ, **({'ROS_MASTER_URI': master} if master else {})}
        self._output = tempfile.TemporaryFile('w+')
        test.addCleanup(self._output.close)
        self.process = programs.start('rumba_viewer', 'page', f'_port:={port}', *arguments, env=environment,
                                      stdout=self._output, stderr=self._output)
        test.addCleanup(self.process.wait)
        test.addCleanup(self.process.kill)
        wait(test, lambda: self.process.poll() is not None or self._port(), 'the page')
        test.assertIsNone(self.process.poll(), self.printed)
        self.port = self._port()
        self.url = f'http://127.0.0.1:{self.port}'

    @property
    def printed(self):
        """What it printed so far."""
        self._output.seek(0)
        return self._output.read()

    def _port(self):
        found = re.search(r'the page is at http://[\w.]+:(\d+)', self.printed)
        return found and int(found.group(1))

    def end(self):
        """End it as by Ctrl-C; it must end in time and without an error."""
        self.process.terminate()
        self._test.assertEqual(self.process.wait(TIMEOUT), 0, self.printed)


class OwnMaster(Master):
    """A separate master, and simulators at it."""

    def simulator(self, *arguments):
        """A simulator."""
        return Simulator(self._test, '_map:=field', *arguments, environment=self.environment, master=self.uri,
                         forget=False)


class Client:
    """A client of rosbridge's protocol."""

    def __init__(self, test, page, token=None):
        self._loop, self._numbers = IOLoop(make_current=False), itertools.count()
        test.addCleanup(self._loop.close)
        query = '' if token is None else f'?token={token}'
        self._socket = self._run(websocket_connect, f'ws://127.0.0.1:{page.port}/{query}')
        test.addCleanup(self._socket.close)

    def _run(self, act, *arguments):
        return self._loop.run_sync(lambda: act(*arguments), TIMEOUT)

    def send(self, **operation):
        """Send an operation."""
        self._run(self._socket.write_message, json.dumps(operation))

    def raw(self):
        """The next text, or data."""
        message = self._run(self._socket.read_message)
        if message is None:
            raise EOFError('the connection has ended')
        return message

    def find(self, condition):
        """The next operation that meets a condition."""
        while True:
            operation = json.loads(self.raw())
            if condition(operation):
                return operation

    def status(self):
        """The text of the next status."""
        return self.find(lambda one: one['op'] == 'status')['msg']

    def close(self):
        """Leave."""
        self._socket.close()
        self._run(self._socket.read_message)

    def message(self, topic, condition=lambda message: True):
        """The next message of a topic that meets a condition."""
        return self.find(lambda one: one['op'] == 'publish' and one['topic'] == topic and condition(one['msg']))['msg']

    def call(self, service, **values):
        """Whether a service worked, and its answer."""
        number = str(next(self._numbers))
        self.send(op='call_service', id=number, service=service, args=values)
        answer = self.find(lambda one: one['op'] == 'service_response' and one['id'] == number)
        return answer['result'], answer['values']


class Browser:
    """Chromium without a window, at a page."""

    def __init__(self, test, page, size, rest=''):
        """Open a page in a window of some size; `rest` follows its address."""
        from selenium import webdriver
        from selenium.webdriver.chrome.options import Options
        from selenium.webdriver.chrome.service import Service
        options = Options()
        for argument in ('--headless=new', '--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage', '--no-first-run',
                         '--disable-background-networking'):
            options.add_argument(argument)
        options.set_capability('goog:loggingPrefs', {'browser': 'ALL'})
        self._test = test
        folder = tempfile.TemporaryDirectory()  # Chromium leaves sockets behind
        test.addCleanup(folder.cleanup)
        service = Service('/usr/bin/chromedriver', env={**os.environ, 'TMPDIR': folder.name})
        self.driver = webdriver.Chrome(service=service, options=options)
        test.addCleanup(self.driver.quit)
        self.driver.set_script_timeout(TIMEOUT)
        self.look(size)
        self.driver.get(page.url + '/' + rest)

    def look(self, size, scheme='light'):
        """Have a screen of a size [pixels] that is light or dark."""
        self.driver.execute_cdp_cmd('Emulation.setDeviceMetricsOverride', {
            'width': size[0], 'height': size[1], 'deviceScaleFactor': 1, 'mobile': False})
        self.driver.execute_cdp_cmd('Emulation.setEmulatedMedia', {'features': [
            {'name': 'prefers-color-scheme', 'value': scheme}]})

    def text(self, name):
        """The text of an element, by its id."""
        return self.driver.execute_script('return document.getElementById(arguments[0]).textContent', name)

    def wait_for(self, name, pattern):
        """Wait until the text of an element matches a pattern."""
        wait(self._test, lambda: re.search(pattern, self.text(name)), f'{pattern} in {name}')

    def element(self, name):
        """An element, by its id."""
        return self.driver.find_element('id', name)

    def floor_size(self):
        """Width and height of the picture of the floor [pixels]."""
        size = self.element('floor').size
        return size['width'], size['height']

    def robot(self):
        """Column and row of the robot on the screen [pixels]; None if it is not there."""
        picture = np.asarray(Image.open(io.BytesIO(self.driver.get_screenshot_as_png())).convert('RGB')).astype(int)
        width, height = self.floor_size()
        rows, columns = np.nonzero(abs(picture[:height, :width] - ROBOT).max(axis=2) <= 12)
        if len(rows) <= 50:
            return None
        return 0.5 * (columns.min() + columns.max()), 0.5 * (rows.min() + rows.max())  # of the ring around it

    def robot_at_rest(self):
        """The same, if two pictures show it at the same place."""
        before, after = self.robot(), self.robot()
        return after if before == after else None

    def colour_at(self, column, row):
        """Red, green and blue of a pixel of the floor."""
        return self.driver.execute_script(
            'return [...document.getElementById("floor").getContext("2d").getImageData(...arguments, 1, 1).data]'
            '.slice(0, 3)', round(column), round(row))

    def touch(self, kind, name):
        """`touchStart` on the middle of an element, or `touchEnd`."""
        box = self.driver.execute_script(
            'const element = document.getElementById(arguments[0]); element.scrollIntoView({block: "center"});'
            'return element.getBoundingClientRect().toJSON()', name)
        point = {'x': box['x'] + box['width'] / 2, 'y': box['y'] + box['height'] / 2}
        self.driver.execute_cdp_cmd('Input.dispatchTouchEvent', {
            'type': kind, 'touchPoints': [point] if kind == 'touchStart' else []})

    def unlabelled(self):
        """Controls for which a screen reader has no name."""
        return self.driver.execute_script(
            'return [...document.querySelectorAll("button, input, select, canvas, progress")].filter(one => !('
            'one.getAttribute("aria-label") || one.getAttribute("aria-labelledby") || one.textContent.trim() || '
            'one.labels?.length)).map(one => one.id)')

    def errors(self):
        """What went wrong in the page, by its own account; not what the network did."""
        return [entry['message'] for entry in self.driver.get_log('browser')
                if entry['level'] == 'SEVERE' and entry['source'] != 'network' and 'WebSocket' not in entry['message']]
