"""All kinds of blows, in one table."""

from stress.blows import files, messages, network, pages, processes, repeated, resources, robots, tools
from stress.blows.blow import Blow, Kind  # noqa: F401

WORLDS = ('flat', 'localised', 'mapped')  # of the simulator
NODES = (*WORLDS, 'turtle')
PAGE = ('browsed',)
KINDS = (
    Kind('handshakes', network.handshakes, NODES),
    Kind('frames', network.frames, NODES, 3),
    Kind('xmlrpc', network.xmlrpc, NODES),
    Kind('deaf readers', network.deaf_readers, NODES, 1),
    Kind('idle connections', network.idle_connections, NODES, 1),
    Kind('topic', messages.topic, NODES, 8),
    Kind('service', messages.service, NODES, 5),
    Kind('action', messages.action, NODES, 3),
    Kind('again and again', repeated.again, NODES, 4),
    Kind('kill -9', processes.kill, NODES, 4),
    Kind('second simulator', processes.twin, WORLDS, 1),
    Kind('stop', processes.stop, NODES, 4),
    Kind('end', processes.end, NODES, 4),
    Kind('rosnode kill', processes.shutdown, NODES, 1),
    Kind('stop of the master', processes.stop_master, NODES),
    Kind('kill -9 of the master', processes.kill_master, NODES, 1),
    Kind('spawn and kill', robots.spawn_and_kill, WORLDS),
    Kind('pause and step', robots.pause_and_step, WORLDS),
    Kind('reset', robots.reset, NODES, 1),
    Kind('teleport', robots.teleport, NODES),
    Kind('speed', robots.tune_speed, WORLDS),
    Kind('full disk', resources.full_disk, NODES, 1),
    Kind('no home', resources.no_home, NODES, 1),
    Kind('mission test', tools.mission_test, NODES, 1),
    Kind('evaluate', tools.evaluate, ('cradle',), 1),
    Kind('map', files.mutated_map, ('cradle',), 3),
    Kind('settings', files.mutated_settings, ('cradle',), 3),
    Kind('arguments', files.odd_arguments, ('cradle',), 3),
    Kind('requests to the page', pages.requests, PAGE, 1),
    Kind('frames to the page', pages.frames, PAGE, 3),
    Kind('operations of the page', pages.operations, PAGE, 12),
)
