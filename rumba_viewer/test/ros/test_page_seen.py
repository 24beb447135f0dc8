#!/usr/bin/env python3
"""The page in a browser for people who see little, or have no mouse: contrast by pixels, axe-core, the keyboard."""

import itertools
import os
import pathlib
import unittest

import programs
import rospy
import rostest
from pages import DESK, HAS_BROWSER, PHONE, Browser, Page
from simulators import Heard, Simulator, wait

from rumba_msg.msg import MissionStatus
from rumba_sim.model.maps.floor_colours import contrast

AXE = pathlib.Path(os.environ.get('NODE_PATH', ''), 'axe-core', 'axe.min.js')
SCHEMES = ('light', 'dark')
LEAST = 3.0  # contrast of whatever lies side by side
PAINTED = """
// The colours of each part of a floor, as the page paints it: without lines, and those that lines and things add.
const done = arguments[0], side = 12;  // [pixels] of a cell
(async () => {
  const {Floor, ROBOT_COLOURS} = await import('/floor.js'), {SAME} = await import('/own_map.js');
  const parts = ['swept', 'to_sweep', 'out_of_reach', 'wall', 'cliff', 'carpet', 'dirty_carpet'], wide = 8, high = 12;
  const of = value => Array.from({length: high * wide * parts.length},
    (_, at) => value(parts[Math.floor(at % (wide * parts.length) / wide)]));
  const info = {width: wide * parts.length, height: high, resolution: 0.05, origin: {position: {x: 0, y: 0}}};
  const map = {info, data: of(part => part === 'wall' ? 100 : 0)};
  const swept = {swept: 100, carpet: 100, to_sweep: 0, dirty_carpet: 0};
  const layers = {width: info.width, height: info.height, carpet: of(part => part.endsWith('carpet') ? 1 : 0),
    cliff: of(part => part === 'cliff' ? 1 : 0)};
  const canvas = document.createElement('canvas');
  canvas.style.cssText = `position: fixed; left: 0; top: 0; width: ${side * info.width + 32}px;
    height: ${side * high + 16}px`;
  document.body.append(canvas);
  const painted = (number, line, obstacles) => {
    const floor = new Floor(canvas);
    floor.map = map;
    floor.resize();
    floor.paint({selected: {coverage: {data: of(part => swept[part] ?? -1)}, number, trail: [], plan: line, scan: null},
      frame: SAME, layers, docks: [], obstacles, robots: [], hasTrueMap: false, target: null}, 0);
    const colours = parts.map((part, at) => {
      const {data} = canvas.getContext('2d').getImageData(16 + side * wide * at + 2, 18, side * wide - 4,
        side * high - 8);
      const counts = {};
      for (let i = 0; i < data.length; i += 4) {
        const colour = '#' + [...data.slice(i, i + 3)].map(value => value.toString(16).padStart(2, '0')).join('');
        counts[colour] = (counts[colour] ?? 0) + 1;
      }
      return [part, Object.keys(counts).filter(colour => counts[colour] >= 20)];
    });
    return Object.fromEntries(colours);
  };
  const line = [{x: 0, y: 0.3}, {x: 0.05 * info.width, y: 0.3}];
  const box = {type: 1, pose: {position: {x: 0.4, y: 0.1}, orientation: {w: 1, x: 0, y: 0, z: 0}},
    scale: {x: 0.6, y: 0.1}};
  const result = {bare: painted(0, [], []), things: painted(0, [], [box]),
    lines: ROBOT_COLOURS.map((_, number) => painted(number, line, []))};
  canvas.remove();
  done(result);
})().catch(error => done(String(error)));
"""
VIOLATIONS = """
const done = arguments[0];
axe.run(document, {resultTypes: ['violations']}).then(({violations}) => done(violations.map(
    ({id, nodes}) => `${id}: ${nodes.map(({target}) => target.join(' ')).join(', ')}`)));
"""


def best(some, others):
    """The highest contrast between a colour of some and one of others."""
    return max(contrast(one, other) for one, other in itertools.product(some, others))


@unittest.skipUnless(HAS_BROWSER, 'needs chromium, chromium-driver and python3-selenium')
class SeenTest(unittest.TestCase):
    """Chromium."""

    def test_states_of_the_floor_and_lines_over_it_have_contrast(self):
        browser = Browser(self, Page(self), DESK)
        for scheme in SCHEMES:
            browser.look(DESK, scheme)
            painted = browser.driver.execute_async_script(PAINTED)
            bare = painted['bare']
            self.assertEqual([len(bare[part]) for part in ('swept', 'to_sweep', 'wall', 'out_of_reach', 'cliff')],
                             [1, 1, 1, 2, 2], bare)
            for one, other in itertools.combinations(('swept', 'to_sweep', 'wall', 'out_of_reach', 'cliff'), 2):
                self.assertGreaterEqual(best(bare[one], bare[other]), LEAST, (scheme, one, other))
            for carpet, floor in (('carpet', 'swept'), ('dirty_carpet', 'to_sweep')):
                self.assertIn(bare[floor][0], bare[carpet])  # what is swept is as plain there as elsewhere
                self.assertGreaterEqual(best(bare[carpet], bare[floor]), LEAST, (scheme, carpet))
            for shown in (painted['things'], *painted['lines']):
                for part in ('swept', 'to_sweep'):
                    added = set(shown[part]) - set(bare[part])
                    self.assertTrue(added, (scheme, part))
                    self.assertGreaterEqual(best(added, bare[part]), LEAST, (scheme, part))

    @unittest.skipUnless(AXE.exists(), 'no axe-core: npm install axe-core, and its node_modules in NODE_PATH')
    def test_axe_core_finds_nothing(self):
        Simulator(self, '_map:=apartment')
        page = Page(self, '_token:=teacher', '_robot_tokens:=rumba:blue,rumba2:green')
        for rest in ('', '#token=teacher'):
            browser = Browser(self, page, DESK, rest)
            browser.wait_for('waiting', '^$')
            browser.driver.execute_script(AXE.read_text())
            browser.driver.execute_script('document.getElementById("more").open = true')
            self.check_rules(browser)
        page.end()
        browser.wait_for('state', '^Not connected$')
        self.check_rules(browser)

    def check_rules(self, browser):
        """Check a page by axe-core on a phone and on a desk, light and dark."""
        for scheme, size in itertools.product(SCHEMES, (PHONE, DESK)):
            browser.look(size, scheme)
            self.assertEqual(browser.driver.execute_async_script(VIOLATIONS), [], (scheme, size))

    def test_all_can_be_done_by_the_keyboard_alone(self):
        simulator = Simulator(self, '_map:=apartment', '_robots:=2', '_speed:=5')
        cleaner = programs.start('rumba_cleaning', 'cleaner')
        self.addCleanup(cleaner.wait)
        self.addCleanup(cleaner.kill)
        browser = Browser(self, Page(self), DESK)
        browser.wait_for('waiting', '^$')
        keys, mission = Keyboard(browser), Heard(self, '/rumba/mission_status', MissionStatus)

        def reads(label):
            browser.wait_for('clean', f'^{label}$')
            wait(self, lambda: browser.element('clean').is_enabled(), f'{label} to be enabled')

        def leads_to(key, *states):
            mission.messages.clear()
            keys.press(key)
            mission.find(lambda message: message.state in states)
        keys.tab_to('robots')
        keys.press('ARROW_DOWN')
        wait(self, lambda: browser.element('robots').get_attribute('value') == '/rumba2', 'the second robot')
        keys.press('ARROW_UP')
        wait(self, lambda: browser.element('clean').is_enabled(), 'the cleaner of the first')
        keys.tab_to('clean')
        leads_to('ENTER', MissionStatus.CLEANING)
        reads('Pause')
        leads_to('SPACE', MissionStatus.IDLE)
        reads('Resume')
        leads_to('ENTER', MissionStatus.CLEANING)
        reads('Pause')
        keys.tab_to('home')
        leads_to('ENTER', MissionStatus.RETURNING, MissionStatus.DOCKING)
        leads_to('ESCAPE', MissionStatus.IDLE)
        truth = Heard(self, '/rumba/ground_truth')
        for way in ('i', 'ARROW_UP'):
            keys.down(way)
            truth.find(lambda message: message.twist.twist.linear.x > 0.1)
            keys.up(way)
            truth.fresh(lambda message: message.twist.twist.linear.x == 0.0)
        keys.tab_to('left')
        keys.down('SPACE')
        truth.find(lambda message: message.twist.twist.angular.z > 0.5)
        keys.up('SPACE')
        truth.fresh(lambda message: message.twist.twist.angular.z == 0.0)
        keys.tab_to('x')
        keys.type('5.6')
        keys.tab_to('y')
        keys.type('3.9')
        leads_to('ENTER', MissionStatus.GOING_TO)
        leads_to('ESCAPE', MissionStatus.IDLE)
        keys.tab_to('more', 'summary')
        keys.press('ENTER')
        keys.tab_to('laser')
        keys.press('SPACE')
        wait(self, lambda: browser.element('laser').is_selected(), 'the laser')
        keys.tab_to('pause')
        keys.press('ENTER')
        browser.wait_for('pause', '^Resume time$')
        self.assertIsNone(simulator.process.poll())
        self.assertEqual(browser.errors(), [])


class Keyboard:
    """The keys of a browser, by which alone a person uses a page."""

    def __init__(self, browser):
        self._driver = browser.driver

    @staticmethod
    def _key(name):
        from selenium.webdriver.common.keys import Keys
        return getattr(Keys, name, name)

    def _do(self, act, *keys):
        from selenium.webdriver.common.action_chains import ActionChains
        getattr(ActionChains(self._driver), act)(*keys).perform()

    def down(self, name):
        """A key goes down."""
        self._do('key_down', self._key(name))

    def up(self, name):
        """A key goes up."""
        self._do('key_up', self._key(name))

    def press(self, name):
        """A key goes down and up."""
        self.type(self._key(name))

    def type(self, text):
        """Keys one after another."""
        self._do('send_keys', text)

    def tab_to(self, name, inside=None):
        """Press Tab until an element, by its id, has the focus, or an element inside of it; that must be visible."""
        for _ in range(60):
            at, what, outline = self._driver.execute_script(
                'const one = document.activeElement, at = one.closest("[id]");'
                'return [at?.id, one.localName, getComputedStyle(one).outlineStyle]')
            if at == name and inside in (None, what):
                assert outline != 'none', f'{name} does not show that it has the focus'
                return
            self.press('TAB')
        raise AssertionError(f'Tab does not lead to {name}')


if __name__ == '__main__':
    rospy.init_node('test_page_seen', disable_rostime=True)
    rostest.rosrun('rumba_viewer', 'page_seen', '__main__')
