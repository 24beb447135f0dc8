"""Which nodes stand on the trial ground together."""

from typing import Any, NamedTuple, Tuple

from common.ports import free_port

from stress.member import Role

SPEED = 10.0  # times real time
MAP = 'studio'
PAGE_PORT = free_port()


class Scenario(NamedTuple):
    """Nodes that share a master; they start in this order."""

    name: str
    roles: Tuple[Role, ...]
    robots: Tuple[str, ...] = ()
    parameters: Tuple[Tuple[str, Any], ...] = ()  # on the master, before the first node starts

    @property
    def world(self):
        """The node in which the robots are; None if there is none."""
        return next((role for role in self.roles if role.is_world), None)


CLEANER = Role('/cleaner', 'rumba_cleaning', 'cleaner', '/rumba/go_to/goal', pulse='goals')
LISTENER = Role('/battery_status_listener', 'rumba_sim', 'battery_status_listener', '/rumba/battery_status', talks=True)

SIMULATOR = Role('/simulator', 'rumba_sim', 'simulator', '/simulator/tuning/parameter_updates',
                 (f'_map:={MAP}', f'_speed:={SPEED:g}'), is_world=True)
PAGE = Role('/page', 'rumba_viewer', 'page', arguments=(f'_port:={PAGE_PORT}',), pulse='page')
FLAT = Scenario('flat', (
    SIMULATOR,
    CLEANER,
    Role('/viewer', 'rumba_viewer', 'viewer', '/rumba/go_to/goal', ('_laser:=true', '_folder:=.'),
         pulse='picture'),
    LISTENER), ('rumba',))
TURTLE = Scenario('turtle', (
    # As the original, it does not notice a new master.
    Role('/turtlesim', 'turtlesim', 'turtlesim_node', '/turtle1/pose', ('_gui:=false', f'_speed:={SPEED:g}'),
         registers_again=False),
    Role('/turtlesim_body', 'rumba_sim', 'turtlesim_body', '/simulator/state', is_world=True),
    CLEANER,
    Role('/lesson/battery_status_publisher', 'rumba_sim', 'battery_status_publisher', '/lesson/rumba/battery_status',
         pulse='charge'),
    LISTENER._replace(name='/lesson/battery_status_listener', ready='/lesson/rumba/battery_status')),
    ('rumba',), (('/use_sim_time', True),))
LOCALISED = Scenario('localised', (
    SIMULATOR._replace(arguments=(*SIMULATOR.arguments, '_localisation:=mcl')),
    Role('/localiser', 'rumba_localisation', 'localiser', '/rumba/initialpose', pulse='pose'),
    CLEANER._replace(arguments=('_laser:=true',)),
    PAGE), ('rumba',))
MAPPED = Scenario('mapped', (
    SIMULATOR._replace(arguments=(*SIMULATOR.arguments, '_localisation:=slam')),
    Role('/mapper', 'rumba_localisation', 'mapper', '/rumba/dock_status', pulse='pose'),
    CLEANER._replace(arguments=('_mapping:=true', '_strategy:=explore_and_clean')),
    PAGE), ('rumba',))
# Its clients may send more than by default, so that more can be tried.
BROWSED = Scenario('browsed', (
    SIMULATOR,
    PAGE._replace(arguments=(*PAGE.arguments, '_rate:=10000', '_bandwidth:=100000000', '_elements:=1000000',
                             '_share:=0.5', '_read:=/hostile/*', '_write:=/hostile/*', '_serve:=/hostile/*',
                             '_get:=/hostile/*', '_set:=/hostile/*'))), ('rumba',))
# Here fresh nodes get what no running node would read.
CRADLE = Scenario('cradle', ())
SCENARIOS = {scenario.name: scenario for scenario in (FLAT, TURTLE, LOCALISED, MAPPED, BROWSED, CRADLE)}
