"""What the page holds when it is left open: a browser that gets the messages of hours, one right after the other.

`page_day.py [--hours N]`, 1 by default. While a robot cleans, what the page really receives is kept for a while; then
the same frames are given to the page again and again, each time with later stamps, until it has got as many as in N
hours. Needs chromium and selenium, as the tests of the page do.
"""

import argparse
import importlib.util
import pathlib
import time

import actionlib
import tqdm
from common import figures, ros_session
from common.ports import free_port

from rumba_msg.msg import CleanAction, CleanGoal

SECONDS = 40.0  # [s] for which frames are kept
SPEED = 5  # times real time while they are kept: more happens on the floor
HOUR = 3600.0  # [s]
GROWTH = 10.0  # [%] after the first third, the upper bound: in that, what is bounded fills, such as the trail
PARTS = 24  # of the whole, after each of which the memory is read
KEEP_FRAMES = """
window.kept = []; window.sockets = []; window.keeps = true;
window.WebSocket = class extends WebSocket {
  constructor(...address) {
    super(...address);
    sockets.push(this);
    this.addEventListener('message', event => { if (keeps) kept.push(event.data); });
  }
};"""
GIVE_AGAIN = """
const [rounds, first, step, done] = arguments, socket = sockets[sockets.length - 1];
(async () => {
  for (let round = 0; round < rounds; round++) {
    const later = (first + round) * step;
    for (const [number, frame] of kept.entries()) {
      socket.onmessage({data: frame.replace(/"secs": ?(\\d+)/g, (_, secs) => `"secs": ${Number(secs) + later}`)});
      if (number % 100 === 0) await new Promise(resolve => setTimeout(resolve));  // the page paints meanwhile
    }
  }
  done();
})();"""
CHROMEDRIVER = pathlib.Path('/usr/bin/chromedriver')
HELD = """
gc();
return [performance.memory.usedJSHeapSize / 1e6, document.getElementsByTagName('*').length];"""


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--hours', type=float, default=1.0)
    hours = parser.parse_args().hours
    if not CHROMEDRIVER.exists() or importlib.util.find_spec('selenium') is None:
        figures.heading('The page in a browser: not measured, without chromium-driver and python3-selenium')
        return
    port = free_port()
    with ros_session.master(), ros_session.simulator(map='apartment', speed=SPEED), ros_session.process(
            ['rosrun', 'rumba_cleaning', 'cleaner']), ros_session.process(
            ['rosrun', 'rumba_viewer', 'page', f'_port:={port}']):
        client = actionlib.SimpleActionClient('/rumba/clean', CleanAction)
        client.wait_for_server()
        client.send_goal(CleanGoal(strategy='boustrophedon'))
        driver = browser()
        try:
            measure(driver, f'http://127.0.0.1:{port}/', hours)
        finally:
            driver.quit()


def browser():
    """Chromium without a window, that tells its memory exactly and collects its garbage when it is told to."""
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    options = Options()
    for argument in ('--headless=new', '--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage',
                     '--enable-precise-memory-info', '--js-flags=--expose-gc', '--window-size=1280,800'):
        options.add_argument(argument)
    driver = webdriver.Chrome(service=Service(str(CHROMEDRIVER)), options=options)
    driver.set_script_timeout(HOUR)
    driver.execute_cdp_cmd('Page.addScriptToEvaluateOnNewDocument', {'source': KEEP_FRAMES})
    return driver


def measure(driver, address, hours):
    """Keep frames, give them again, and print what the page holds."""
    driver.get(address)
    ros_session.wait_until(lambda: driver.execute_script('return kept.length') > 10)
    time.sleep(SECONDS)
    frames = driver.execute_script('keeps = false; sockets[sockets.length - 1].close = () => {}; return kept.length')
    rounds = max(round(hours * HOUR / SECONDS / PARTS), 1)
    held = []
    for part in tqdm.trange(PARTS, unit='part', disable=None):
        driver.execute_async_script(GIVE_AGAIN, rounds, part * rounds + 1, int(SECONDS * SPEED) + 1)
        held.append(driver.execute_script(HELD))
    figures.heading(f'The page in a browser, left open for {PARTS * rounds * SECONDS / HOUR:.1f} h')
    figures.row('messages', frames * rounds * PARTS)
    heap = [megabytes for megabytes, _ in held]
    early, late = max(heap[:PARTS // 3]), max(heap[-PARTS // 3:])
    figures.row('JavaScript heap after the first third, at most [MB]', early)
    figures.row('  growth after that [%]', 100.0 * (late / early - 1.0), below=GROWTH)
    figures.row('elements of the page, growth', held[-1][1] - held[0][1], below=1)


if __name__ == '__main__':
    main()
