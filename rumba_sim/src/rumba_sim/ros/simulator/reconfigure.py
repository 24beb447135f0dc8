"""dynamic_reconfigure for settings: unit, range and meaning come from the settings themselves."""

from typing import Any, Callable, Dict, List, Mapping

from dynamic_reconfigure.encoding import Config
from dynamic_reconfigure.server import Server

from rumba_sim.model.common.config import leaves

TYPES = {bool: 'bool', int: 'int', float: 'double', str: 'str'}
UNLIMITED = 1e9


class Description:
    """A class of settings, described as the server of dynamic_reconfigure needs it, instead of a generated module.

    A path such as `battery/drain` becomes the name `battery_drain`.
    """

    def __init__(self, settings: Any, paths: List[str]) -> None:
        """Describe the settings at these paths; their present values become the defaults."""
        fields = {path: field for path, field in leaves(type(settings)) if path in paths}
        values = {path: value_at(settings, path) for path in paths}
        self.defaults = Config({_name(path): values[path] for path in paths})
        self.min = Config({_name(path): _limit(fields[path], 'low') for path in paths})
        self.max = Config({_name(path): _limit(fields[path], 'high') for path in paths})
        self.config_description = {
            'name': 'Default', 'type': '', 'state': True, 'id': 0, 'parent': 0, 'groups': [],
            'parameters': [{
                'name': _name(path), 'type': TYPES[type(values[path])], 'default': values[path],
                'min': self.min[_name(path)], 'max': self.max[_name(path)], 'level': 0, 'edit_method': '',
                'description': _text(fields[path])} for path in paths]}


def serve(settings: Any, paths: List[str], namespace: str, apply: Callable[[Dict[str, Any]], Any]) -> Server:
    """Offer settings to rqt_reconfigure and dynparam.

    Args:
        settings: a frozen dataclass with fields made by `setting` and `section`.
        paths: of the settings that can be changed, for example `battery/drain`.
        namespace: name below the node's name for the parameters of the server.
        apply: called with a nested mapping of all these settings; returns the settings that are then in force.
    """
    def callback(config: Config, _: int) -> Config:
        in_force = apply(nested({path: config[_name(path)] for path in paths}))
        config.update({_name(path): value_at(in_force, path) for path in paths})
        return config
    return Server(Description(settings, paths), callback, namespace)


def nested(flat: Mapping[str, Any]) -> Dict[str, Any]:
    """{'battery/drain': 2} as {'battery': {'drain': 2}}."""
    result: Dict[str, Any] = {}
    for path, value in flat.items():
        *sections, name = path.split('/')
        place = result
        for part in sections:
            place = place.setdefault(part, {})
        place[name] = value
    return result


def value_at(settings: Any, path: str) -> Any:
    """The value at a path such as `battery/drain`."""
    for name in path.split('/'):
        settings = getattr(settings, name)
    return settings


def _name(path: str) -> str:
    return path.replace('/', '_')


def _limit(field: Any, end: str) -> Any:
    limit = field.metadata[end]
    if type(field.default) in (bool, str):
        return {bool: end == 'high', str: ''}[type(field.default)]
    return type(field.default)((-UNLIMITED if end == 'low' else UNLIMITED) if limit is None else limit)


def _text(field: Any) -> str:
    unit = field.metadata['unit']
    return f'{field.metadata["doc"]} [{unit}]' if unit else str(field.metadata['doc'])
