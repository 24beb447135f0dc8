"""Contrasts of the floor's colours."""

import itertools

import pytest

from rumba_sim.model.maps.floor_colours import DARK, LIGHT, ROBOTS, contrast

LEAST = 3.0


def of(colours, name):
    """The colours of a thing: one, or two in turns."""
    second = {'out_of_reach': 'stripe', 'cliff': 'drop'}.get(name)
    return [getattr(colours, each) for each in (name, second) if each]


def test_contrast_is_that_of_wcag():
    assert contrast('#000000', '#ffffff') == contrast('#ffffff', '#000000') == pytest.approx(21.0)
    assert contrast('#767676', '#ffffff') == pytest.approx(4.54, abs=0.005)  # the usual example


@pytest.mark.parametrize('colours', [LIGHT, DARK], ids=['light', 'dark'])
@pytest.mark.parametrize('one, other', itertools.combinations(
    ['wall', 'to_sweep', 'swept', 'out_of_reach', 'cliff'], 2))
def test_states_of_the_floor_can_be_told_apart(colours, one, other):
    if {one, other} == {'out_of_reach', 'cliff'}:
        pairs = [(colours.cliff, colours.out_of_reach)]  # stripes beside stripes: the bright one is the cliff
    else:
        pairs = list(itertools.product(of(colours, one), of(colours, other)))
    assert max(itertools.starmap(contrast, pairs)) >= LEAST


@pytest.mark.parametrize('colours', [LIGHT, DARK], ids=['light', 'dark'])
def test_what_is_drawn_over_the_floor_can_be_seen_there(colours):
    for over in (*colours.lines, colours.carpet, colours.obstacle):
        for floor in (colours.swept, colours.to_sweep):
            assert contrast(over, floor) >= LEAST, (over, floor)
    assert contrast('#ffffff', colours.to_sweep) >= LEAST and contrast(colours.dock, colours.swept) >= LEAST
    assert len(colours.lines) == len(ROBOTS)
