"""Blows on the wire: bytes that no client of ROS sends, to servers and to those who listen."""

import contextlib
import socket
import time
import urllib.parse

from stress import wire
from stress.blows.blow import some_member
from stress.values import TEXTS, hostile, mutated, noise

CONNECTIONS = 200
REQUESTS = 200
FRAMES = 20  # on one connection, which the first broken one ends
READERS = 30
IDLE = 100
HELD = 1.0  # [s]
REGISTRATIONS = 20
ANSWERS_WITHIN = 0.5  # [s] if at all
GRACE = 5.0  # [s] to send or to connect, before the next


def tcpros_server(ground, member):
    """Where a node accepts connections to topics and services.

    Raises:
        wire.WireError: it does not tell.
    """
    return wire.address(ground.ask_master('lookupService', f'{member.name}/get_loggers'))


def handshakes(ground, chance, blow):
    """To the server of topics and services: noise, wrong lengths, wrong md5 sums, fields that are missing."""
    member = some_member(ground, chance)
    blow.say(f'{CONNECTIONS} broken connections to {member.name}')
    where, topics = tcpros_server(ground, member), ground.topics()
    for _ in range(CONNECTIONS):
        data = _handshake(chance, *chance.choice(topics)[:2], member.name)
        with wire.connect(*where, GRACE) as connection, contextlib.suppress(OSError):
            connection.sendall(data)
            if chance.random() < 0.9:  # wait, or else a connection more than it has room for takes a second
                connection.shutdown(socket.SHUT_WR)
                connection.settimeout(ANSWERS_WITHIN)
                connection.recv(64)
        blow.inputs += 1


def _handshake(chance, topic, kind, node):
    fields = {'callerid': wire.CALLER, 'topic': topic, 'type': kind._type, 'md5sum': kind._md5sum}
    choice = chance.randrange(7)
    if choice == 0:
        return noise(chance, 300)
    if choice == 1:
        fields['md5sum'] = chance.choice(('*' * 3, '0' * 32, '', 'x' * 5000))
    elif choice == 2:
        del fields[chance.choice(sorted(fields))]
    elif choice == 3:
        fields[chance.choice(sorted(fields))] = chance.choice(TEXTS)
    elif choice == 4:
        del fields['topic']
        fields.update(service=f'{node}/{chance.choice(("get_loggers", "nothing"))}', md5sum='0' * 32)
    data = wire.header(**fields)
    return mutated(data, chance) if choice >= 5 else data + noise(chance, 40)


def frames(ground, chance, blow):
    """To the subscribers of a topic: greetings and frames with wrong lengths, wrong md5 sums, and noise."""
    topic, kind, subscribers, _ = chance.choice([entry for entry in ground.topics() if entry[2]])
    blow.say(f'broken frames on {topic}, {REGISTRATIONS} times')
    for _ in range(REGISTRATIONS):
        with ground.publishers.publish(ground.uri, topic, kind, len(subscribers), GRACE) as connections:
            for _, connection in connections:
                connection.settimeout(GRACE)
                with contextlib.suppress(OSError):
                    connection.sendall(wire.greeting(kind) if chance.random() < 0.8 else noise(chance, 100))
                    for _ in range(FRAMES):
                        connection.sendall(_frame(chance, kind))
                        blow.inputs += 1


def _frame(chance, kind):
    data = wire.serialized(hostile(kind, chance))
    choice = chance.randrange(8)
    if choice < 5:
        return wire.frame(mutated(data, chance))
    if choice == 5:
        return wire.frame(data[:chance.randint(0, len(data))])
    if choice == 6:
        return wire.frame(data + noise(chance, 50))
    return wire.frame(noise(chance, 200))


def xmlrpc(ground, chance, blow):
    """To the API of a node or of the master: broken HTTP and XML, methods and arguments that are not there."""
    member = chance.choice([ground.master, *ground.members.values()])
    uri = ground.uri if member is ground.master else ground.node_uri(member.name)
    blow.say(f'{REQUESTS} broken requests to the API of {member.name}')
    where = wire.address(uri)
    for _ in range(REQUESTS):
        with wire.connect(*where, GRACE) as connection, contextlib.suppress(OSError):
            connection.sendall(_request(chance))
            if chance.random() < 0.5:
                connection.shutdown(socket.SHUT_WR)
                connection.recv(200)
        blow.inputs += 1


METHODS = ('requestTopic', 'getPid', 'paramUpdate', 'publisherUpdate', 'getBusStats', 'getBusInfo', 'getMasterUri',
           'getSubscriptions', 'registerPublisher', 'registerService', 'getParam', 'system.listMethods', '__init__', '')
VALUES = ('<int>7</int>', '<int>99999999999999999999</int>', '<string>' + 'z' * 5000 + '</string>', '<nil/>',
          '<boolean>9</boolean>', '<double>nan</double>', '<base64>!!</base64>', '<array><data></data></array>',
          '<struct></struct>', '<dateTime.iso8601>never</dateTime.iso8601>', '<unknown/>', '')


def _request(chance):
    arguments = ''.join(f'<param><value>{chance.choice(VALUES)}</value></param>' for _ in range(chance.randrange(5)))
    body = (f'<?xml version="1.0"?><methodCall><methodName>{chance.choice(METHODS)}</methodName>'
            f'<params>{arguments}</params></methodCall>').encode()
    choice = chance.randrange(6)
    if choice == 0:
        return noise(chance, 400)
    if choice == 1:
        body = mutated(body, chance)
    if choice == 2:
        body = b'<a>' * chance.choice((10, 1000)) + body
    length = chance.choice((len(body), len(body), len(body), 0, len(body) + 5, -1, 'x'))
    path = chance.choice(('/', '/RPC2', '/' + urllib.parse.quote(chance.choice(TEXTS))[:200]))
    return f'POST {path} HTTP/1.0\r\nContent-Type: text/xml\r\nContent-Length: {length}\r\n\r\n'.encode() + body


def deaf_readers(ground, chance, blow):
    """Subscribers that never read what they are sent."""
    entries = [entry for entry in ground.topics() if entry[3]]
    blow.say(f'{READERS} subscribers that do not read for {HELD:g} s')
    with contextlib.ExitStack() as stack:
        for _ in range(READERS):
            topic, kind, _, publishers = chance.choice(entries)
            stack.enter_context(ground.listen(topic, kind, ground.members[chance.choice(publishers)]))
            blow.inputs += 1
        time.sleep(HELD)


def idle_connections(ground, chance, blow):
    """Connections to the API of a node that say nothing, and are closed after a while."""
    member = some_member(ground, chance)
    blow.say(f'{IDLE} silent connections to {member.name} for {HELD:g} s')
    where = wire.address(ground.node_uri(member.name))
    with contextlib.ExitStack() as stack:
        for _ in range(IDLE):
            stack.enter_context(wire.connect(*where, GRACE))
            blow.inputs += 1
        time.sleep(HELD)
