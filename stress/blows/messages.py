"""Blows that are correct on the wire, and nonsense by their content: on topics, services and actions."""

import contextlib
import io
import time

import genpy
import roslib.message

from stress import goals, wire, world
from stress.values import hostile, mutated

POOL = 150  # messages that are made, and as many mutations of them
MESSAGES = 6000
CALLS = 300
GOALS = 25
BATCH = 50  # messages in one packet
GRACE = 5.0  # [s] for a subscriber to connect
SECONDS = 4.0  # of calls, at most
ANSWERS_WITHIN = 2.0  # [s], if at all
ENDS_WITHIN = 30.0  # [s] for all goals
FORGETS = ('/reset', '/set_parameters')  # services after which the world is another one


def topic(ground, chance, blow):
    """NaN, infinite, huge and odd values on a topic."""
    entry = chance.choice([entry for entry in ground.topics() if entry[2]])
    blow.say(f'odd {entry[1]._type} on {entry[0]}')
    send(ground, entry[:3], chance, blow)


def send(ground, entry, chance, blow):
    """Send odd messages to a topic, given by its name, the class of its messages and its subscribers."""
    name, kind, subscribers = entry
    pool = _pool(kind, chance)
    with ground.publishers.publish(ground.uri, name, kind, len(subscribers), GRACE) as connections:
        for _, connection in connections:
            connection.settimeout(wire.PATIENCE)
            with contextlib.suppress(OSError):
                connection.sendall(wire.greeting(kind))
        for _ in range(MESSAGES // BATCH):
            data = b''.join(chance.choice(pool) for _ in range(BATCH))
            for _, connection in connections:
                with contextlib.suppress(OSError):
                    connection.sendall(data)
                    blow.inputs += BATCH
        time.sleep(0.05)


def _pool(kind, chance):
    """Frames of odd messages; some are mutations of others that are still messages."""
    pool = [wire.serialized(hostile(kind, chance)) for _ in range(POOL)]
    mutations = [mutated(chance.choice(pool), chance) for _ in range(POOL)]
    with contextlib.redirect_stderr(io.StringIO()):  # on which genpy says that texts are no UTF-8
        pool += [data for data in mutations if _is_message(kind, data)]
    return [wire.frame(data) for data in pool]


def _is_message(kind, data):
    """Whether bytes are a message of a class."""
    try:
        return wire.serialized(kind().deserialize(data)) == data
    except (genpy.MessageException, UnicodeDecodeError, MemoryError):
        return False


def service(ground, chance, blow):
    """Requests full of nonsense to a service, and bytes that are no request."""
    name, uri = chance.choice(ground.services())
    kind = roslib.message.get_service_class(_type_of(name, uri))
    blow.say(f'odd requests to {name}')
    with _kept_tuning(ground, name):
        end = time.monotonic() + SECONDS
        while blow.inputs < CALLS and time.monotonic() < end:
            with contextlib.suppress(wire.WireError), wire.Service(uri, name, kind) as connection:
                while blow.inputs < CALLS and time.monotonic() < end:
                    blow.inputs += 1
                    data = wire.serialized(hostile(kind._request_class, chance))
                    if chance.random() < 0.3:
                        data = mutated(data, chance)
                    connection.call_with_bytes(data, ANSWERS_WITHIN)
    if name.endswith(FORGETS):
        ground.memory = None


def _type_of(name, uri):
    """The type of a service, as the node tells."""
    with wire.connect(*wire.address(uri)) as connection:
        connection.sendall(wire.header(callerid=wire.CALLER, service=name, md5sum='*', probe='1'))
        return wire.read_header(connection)['type']


@contextlib.contextmanager
def _kept_tuning(ground, name):
    """Restore what reconfigure changes."""
    if not name.endswith('/set_parameters'):
        yield
        return
    before = world.tune(ground)
    yield
    world.tune(ground, **before)


def action(ground, chance, blow):
    """Goals full of nonsense, of which each must end."""
    name = chance.choice(sorted(goals.ACTIONS))
    blow.say(f'{GOALS} odd goals of {name}', inputs=GOALS)
    with goals.client(ground, name) as client:
        for _ in range(GOALS):
            goal = hostile(goals.kind(name, 'Goal'), chance)
            client.send(**{field: getattr(goal, field) for field in goal.__slots__})
        goals.cancel_all(ground)
        client.await_results(ENDS_WITHIN)
