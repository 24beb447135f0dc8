"""What the page costs: the node beside a simulator, with real websocket clients that listen to what a browser does.

The clients run in a process of their own. Each subscribes to what rumba_viewer/page/robot.js and scene.js subscribe to.
With a number of seconds, as in `python3 bench/page.py 3600`, it measures for so long, to see whether the memory grows.
"""

import asyncio
import contextlib
import json
import socket
import statistics
import subprocess
import sys
import time

from common import figures, ros_session
from common.ports import free_port
from tornado.httpclient import AsyncHTTPClient
from tornado.websocket import websocket_connect

SHARED = ({'topic': '/map', 'compression': 'png'}, {'topic': '/simulator/state'},
          {'topic': '/simulator/obstacles', 'throttle_rate': 200})
OWN = {'ground_truth': 100, 'battery_status': 500, 'battery_state': 1000, 'dock_status': 500, 'cleaning_status': 1000,
       'mission_status': 0, 'plan': 500, 'scan': 200, 'coverage': 500}  # [ms] of a robot
FILES = ('', 'style.css', 'app.js', 'driving.js', 'floor.js', 'link.js', 'robot.js', 'scene.js')
CASES = ((30, 1, 5.0, 80.0), (100, 10, 40.0, None))  # clients, robots, share of a core [%] and memory [MB] at most
FIRST_PICTURE = 1.0  # [s] from opening to all that is needed for it, at most
SECONDS, WARM, RUNS = 8.0, 4.0, 3


def main():
    """Measure and print; with the argument `clients`, be the clients."""
    if sys.argv[1:2] == ['clients']:
        asyncio.run(listen(*map(int, sys.argv[2:])))
        return
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else SECONDS
    figures.heading('The page: the map apartment, poses at 10 Hz, laser and coverage shown')
    with ros_session.master():
        for case in CASES:
            beside(seconds, *case)


def beside(seconds, clients, robots, share, memory):
    """The share of a core that the node uses while clients listen: the median, and its memory."""
    port = free_port()
    with ros_session.simulator(map='apartment', robots=robots), ros_session.process(
            ['rosrun', 'rumba_viewer', 'page', f'_port:={port}']) as page, contextlib.ExitStack() as until_the_end:
        ros_session.wait_until(lambda: is_served(port))
        figures.row(f'{clients} clients, {robots} robots: first picture after [s]', asyncio.run(first_picture(port)),
                    below=FIRST_PICTURE)
        crowd = until_the_end.enter_context(ros_session.process(
            [sys.executable, __file__, 'clients', str(port), str(clients), str(robots)], stdout=subprocess.PIPE))
        crowd.stdout.readline()
        time.sleep(WARM)
        first, shares = figures.resident_megabytes(page.pid), []
        for _ in range(RUNS):
            begin, before = time.monotonic(), figures.cpu_seconds(page.pid)
            time.sleep(seconds)
            shares.append(100.0 * (figures.cpu_seconds(page.pid) - before) / (time.monotonic() - begin))
        figures.row('  share of a core [%]', statistics.median(shares), below=share)
        last = figures.resident_megabytes(page.pid)
        figures.row('  resident memory [MB]', last, below=memory)
        figures.row(f'  growth in {RUNS * seconds:.0f} s [MB]', last - first)
        figures.row('  poses that a client got in a second', float(crowd.stdout.readline()))


def is_served(port):
    """Whether the page answers."""
    with socket.socket() as probe:
        return not probe.connect_ex(('127.0.0.1', port))


async def client(port, robot):
    """A client that listens to what a browser shows of a robot."""
    connection = await websocket_connect(f'ws://127.0.0.1:{port}/')
    own = [{'topic': f'/{robot}/{topic}', 'throttle_rate': rate, 'newest': True,
            'compression': 'png' if topic == 'coverage' else 'none'} for topic, rate in OWN.items()]
    for operation in (*SHARED, *own):
        await connection.write_message(json.dumps({'op': 'subscribe', **operation}))
    return connection


async def first_picture(port):
    """Seconds from opening the page to the first map, coverage and pose [s]; nobody listened before."""
    begin = time.monotonic()
    for name in FILES:
        await AsyncHTTPClient().fetch(f'http://127.0.0.1:{port}/{name}')
    connection = await client(port, 'rumba')
    pictures, has_pose = 0, False
    while pictures < 2 or not has_pose:
        text = await connection.read_message()
        pictures += '"op": "png"' in text or '"op":"png"' in text
        has_pose = has_pose or '/ground_truth' in text
    connection.close()
    return time.monotonic() - begin


async def listen(port, clients, robots):
    """Be many clients; print a line when all are connected, and every second how many poses each got in a second."""
    connections = [await client(port, 'rumba' + (str(number % robots + 1) if number % robots else ''))
                   for number in range(clients)]
    poses = [0]

    async def read(connection):
        while True:
            text = await connection.read_message()
            poses[0] += '/ground_truth' in text[:80]
    readers = [asyncio.ensure_future(read(one)) for one in connections]
    print('connected', flush=True)
    await asyncio.sleep(WARM)  # what came while the others connected does not count
    while not any(reader.done() for reader in readers):
        begin, poses[0] = time.monotonic(), 0
        await asyncio.sleep(5.0)
        print(poses[0] / clients / (time.monotonic() - begin), flush=True)


if __name__ == '__main__':
    main()
