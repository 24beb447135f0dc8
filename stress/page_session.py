"""What the page does with operations, without a socket and without ROS: a program that tries many of a seed.

It prints how many it tried; or, with exit code 1, what went wrong: an error of the page's own, an answer that is no
JSON, or an operation that takes too much CPU time.
"""

import contextlib
import json
import random
import sys
import time

from rumba_viewer.page.allow_list import AllowList, Rights
from rumba_viewer.page.messages.conversion import to_text
from rumba_viewer.page.messages.errors import Hostile, Refusal
from rumba_viewer.page.messages.filling import Filler, serialised
from rumba_viewer.page.protocol import Session
from rumba_viewer.page.ros import Ros
from stress import page_inputs

SLOWEST = 0.1  # [s] of CPU time for one operation
SHOWN = 300  # characters of an operation
OF_A_CLIENT = 100  # operations before the next one comes
FAILED = 1


class _Sink(Ros):
    """Does with messages what the page does, and sends them nowhere."""

    def __init__(self):
        self._filler, self._kinds = Filler(page_inputs.find, lambda: (1, 2)), {}

    def subscribe(self, client, topic, reason, demand):
        pass

    def unsubscribe(self, client, topic, reason):
        pass

    def kind(self, topic):
        return self._kinds.get(topic, '')

    def advertise(self, client, topic, kind, latch):
        kind = kind or self._kinds.get(topic, 'nothing/Such')
        if page_inputs.find(kind) is None:
            raise Refusal(f'the type {kind} is not installed here')
        self._kinds[topic] = kind

    def unadvertise(self, client, topic):
        pass

    def publish(self, client, topic, values):
        kind = page_inputs.find(self._kinds[topic])
        data = serialised(self._filler.fill(kind(), values))
        json.loads(to_text(kind().deserialize(data)), parse_constant=_no_constant)

    def call(self, client, service, values, done, timeout):
        done(True, {})

    def serve(self, client, service, kind, ask, tell):
        ask('1', {})

    def unserve(self, client, service):
        pass

    def answer(self, client, service, request, worked, values):
        pass

    def leave(self, client):
        pass


def _no_constant(name):
    raise ValueError(f'{name} is no JSON')


def main():
    """Try as many operations of a seed as the arguments say."""
    seed, number = map(int, sys.argv[1:])
    chance, replies = random.Random(seed), []
    kinds = [*page_inputs.types(), *20 * [page_inputs.EVERYTHING._type]]
    allowed = AllowList(**{what: ['/hostile/*'] for what in ('read', 'write', 'call', 'serve', 'get', 'set')})
    for count in range(number):
        if count % OF_A_CLIENT == 0:
            session = Session(_Sink(), allowed, Rights(everything=chance.random() < 0.9), '/', None, replies.append)
            session.receive(json.dumps({'op': 'advertise', 'topic': '/hostile/a', 'type': kinds[-1]}))
        text = page_inputs.operation(chance, kinds)
        trouble = _tried(session, text, replies)
        if trouble:
            print(f'{trouble}: {text[:SHOWN]!r}')
            sys.exit(FAILED)
    print(number)


def _tried(session, text, replies):
    """What goes wrong with an operation; empty if nothing does."""
    begin = time.thread_time()
    try:
        with contextlib.suppress(Hostile):
            session.receive(text)
        json.dumps(replies, allow_nan=False).encode()
    except Exception as error:
        return f'{type(error).__name__}: {error}'
    replies.clear()
    seconds = time.thread_time() - begin
    return f'{seconds:.3f} s of CPU time' if seconds > SLOWEST else ''


if __name__ == '__main__':
    main()
