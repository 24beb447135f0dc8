"""A client of the page that wants little: how long its calls take, and how many messages of the odometry it gets.

A process of its own, so that it waits for nobody but the page. It begins when it is started, and prints a line of JSON
when its input ends.
"""

import json
import sys
import threading
import time

from common import websockets

PERIOD = 0.02  # [s] between two calls
ODOMETRY = '/rumba/odom'


def main():
    """Measure until the input ends: arguments are the port, and what follows the `/` of the address."""
    is_over = threading.Event()
    threading.Thread(target=lambda: (sys.stdin.read(), is_over.set()), daemon=True).start()
    times, heard = [], 0
    with websockets.Client(int(sys.argv[1]), *sys.argv[2:]) as client:
        client.send(op='subscribe', topic=ODOMETRY)
        print('ready', flush=True)
        begin = time.monotonic()
        while not is_over.is_set():
            sent = time.monotonic()
            client.send(op='call_service', service='/rosapi/get_time', id=str(len(times)))
            while True:
                operation = client.receive()
                if operation.get('op') == 'service_response':
                    break
                heard += operation.get('topic') == ODOMETRY
            times.append(time.monotonic() - sent)
            time.sleep(PERIOD)
    times.sort()
    print(json.dumps({'calls': len(times), 'median': times[len(times) // 2], 'most': times[99 * len(times) // 100],
                      'worst': times[-1], 'odometry': heard / (time.monotonic() - begin)}))


if __name__ == '__main__':
    main()
