#!/usr/bin/env python3
"""Pictures for make.sh: of web pages in Chromium, and smaller files.

shoot.py page URL FILE.png WIDTHxHEIGHT      the page for browsers, once it shows a robot
shoot.py report URL FILE.png WIDTHxHEIGHT    the report of a mission, its slider in the middle
shoot.py gif FRAME.png ... FILE.gif          pictures of a window as an animation
shoot.py shrink FILE.png ...                 fewer colours
"""

import sys
import time

from PIL import Image

SETTLE = 5.0  # [s] until the page has got map, coverage and robot
HALF = 'const input = document.querySelector("#slider input"); input.value = 420; input.oninput()'
COLOURS, GIF_COLOURS = 128, 64
FRAMES, GIF_WIDTH, PERIOD = 24, 480, 250  # most frames of a GIF; its width [pixels]; time for which each is shown [ms]


def shoot(kind, url, path, size):
    """Save what Chromium shows of an address."""
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    width, height = (int(side) for side in size.split('x'))
    options = Options()
    for argument in ('--headless=new', '--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage', '--hide-scrollbars'):
        options.add_argument(argument)
    driver = webdriver.Chrome(service=Service('/usr/bin/chromedriver'), options=options)
    try:
        driver.execute_cdp_cmd('Emulation.setDeviceMetricsOverride', {
            'width': width, 'height': height, 'deviceScaleFactor': 1, 'mobile': False})
        driver.get(url)
        if kind == 'report':
            driver.execute_script(HALF)
        else:
            time.sleep(SETTLE)
        driver.save_screenshot(path)
    finally:
        driver.quit()


def animate(frames, path):
    """Save pictures as an animation."""
    chosen = frames[::-(-len(frames) // FRAMES)] + frames[-1:]
    pictures = [Image.open(frame).convert('RGB') for frame in chosen]
    height = round(GIF_WIDTH * pictures[0].height / pictures[0].width)
    small = [picture.resize((GIF_WIDTH, height), Image.BOX) for picture in pictures]
    samples = Image.new('RGB', (GIF_WIDTH, 3 * height))
    for row, picture in enumerate((small[0], small[len(small) // 2], small[-1])):
        samples.paste(picture, (0, row * height))
    palette = samples.quantize(GIF_COLOURS, Image.MEDIANCUT, kmeans=4)
    first, *rest = [picture.quantize(palette=palette, dither=0) for picture in small]
    first.save(path, save_all=True, append_images=rest, duration=[PERIOD] * len(rest) + [10 * PERIOD], loop=0,
               optimize=True)


def shrink(path):
    """Save a picture with fewer colours."""
    Image.open(path).convert('RGB').quantize(COLOURS, Image.MEDIANCUT, kmeans=4, dither=0).save(path, optimize=True)


def main(kind, *arguments):
    """Do what the first argument says."""
    if kind == 'gif':
        animate(list(arguments[:-1]), arguments[-1])
    elif kind == 'shrink':
        for path in arguments:
            shrink(path)
    else:
        shoot(kind, *arguments)


main(*sys.argv[1:])
