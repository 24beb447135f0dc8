"""Maps are found by name wherever the package is installed."""

import os

import pytest

from rumba_sim.model.common.errors import MapError
from rumba_sim.model.maps import named_maps


def test_the_maps_of_the_package_are_found_here():
    assert list(named_maps.known()) == ['apartment', 'apartment_docks', 'field', 'studio']
    assert named_maps.path('studio').endswith('/maps/studio.yaml') and os.path.isfile(named_maps.path('studio'))


@pytest.mark.parametrize('installed', range(3))
def test_maps_lie_inside_the_package_or_beside_it_or_in_share(tmp_path, monkeypatch, installed):
    package = tmp_path / 'lib' / 'python3' / 'packages' / 'rumba_sim'
    folders = (package / 'maps', package.parents[1] / 'maps', tmp_path / 'share' / 'rumba_sim' / 'maps')
    ends = [os.path.relpath(folder, named_maps.PACKAGE) for folder in named_maps.FOLDERS]
    assert ends == [os.path.relpath(folder, package) for folder in folders]
    folders[installed].mkdir(parents=True)
    (folders[installed] / 'moon.yaml').touch()
    monkeypatch.setattr(named_maps, 'FOLDERS', folders)
    assert named_maps.path('moon') == str(folders[installed] / 'moon.yaml')


def test_a_path_is_no_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for path in ('some/where', 'x.yaml', './y.yml'):
        assert named_maps.path(path) == os.path.normpath(tmp_path / path)


def test_unknown_names_and_missing_maps(monkeypatch):
    with pytest.raises(MapError, match="^there is no map 'moon': give .*, or one of apartment, apartment_docks, "):
        named_maps.path('moon')
    monkeypatch.setattr(named_maps, 'FOLDERS', ())
    with pytest.raises(MapError, match='or one of none: the maps are not installed$'):
        named_maps.path('studio')
