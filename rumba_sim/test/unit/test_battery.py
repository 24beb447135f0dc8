"""The battery against closed forms."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pytest import approx

from rumba_sim.model.settings.battery import CELLS, Battery, BatteryConfig

CONFIG = BatteryConfig(capacity=2.0, resistance=0.25, charge_current=1.0, trickle_current=0.05, taper_start=0.8)


def test_a_constant_load_takes_its_charge():
    battery = Battery(CONFIG)
    for _ in range(36000):
        battery.step(0.1, load=0.7)
    assert battery.charge == approx(2.0 - 0.7)
    assert battery.current == -0.7
    assert battery.state_of_charge == approx(0.65)


def test_an_empty_battery_gives_no_current_and_stays_empty():
    battery = Battery(CONFIG, state_of_charge=0.01)
    for _ in range(1000):
        battery.step(1.0, load=1.0)
    assert (battery.charge, battery.current, battery.percentage) == (0.0, 0.0, 0)


def test_drain_multiplies_the_change_of_charge_in_both_directions():
    slow, fast = Battery(CONFIG, 0.5), Battery(BatteryConfig(**{**vars(CONFIG), 'drain': 10.0}), 0.5)
    for on_dock in (False, True):
        for _ in range(100):
            slow.step(1.0, load=0.7, on_dock=on_dock)
        for _ in range(100):
            fast.step(0.1, load=0.7, on_dock=on_dock)
        assert fast.charge == approx(slow.charge)


def test_a_drain_of_zero_keeps_the_charge():
    battery = Battery(BatteryConfig(drain=0.0), 0.5)
    battery.step(1e6, load=1.0)
    assert battery.state_of_charge == 0.5


def test_below_the_taper_the_charger_gives_its_full_current_at_any_load():
    battery = Battery(CONFIG, 0.2)
    battery.step(360.0, load=0.5, on_dock=True)
    assert battery.current == 1.0
    assert battery.charge == approx(0.4 + 0.1)


def test_the_charger_tapers_in_proportion_to_what_is_missing_and_ends_at_full():
    battery = Battery(CONFIG, 0.9)
    battery.step(1.0, load=0.0, on_dock=True)
    assert battery.current == approx(0.5)
    battery = Battery(CONFIG, 0.999)
    battery.step(1.0, load=0.0, on_dock=True)
    assert battery.current == 0.05
    for _ in range(300):
        battery.step(1.0, load=0.0, on_dock=True)
    assert (battery.charge, battery.current) == (2.0, 0.0)


def test_the_default_battery_charges_in_about_three_hours_and_cleans_for_sixty_to_a_hundred_minutes():
    battery = Battery(BatteryConfig(), 0.0)
    seconds = 0
    while battery.state_of_charge < 1.0:
        battery.step(1.0, load=0.0, on_dock=True)
        seconds += 1
    assert 2.7 < seconds / 3600.0 < 3.5
    wheels = 1.0
    minutes = 0
    while battery.percentage > 0:
        battery.step(60.0, load=battery.config.idle_current + battery.config.brush_current + wheels)
        minutes += 1
    assert 60 <= minutes <= 100


@pytest.mark.parametrize('percentage', range(101))
def test_a_percentage_survives_the_conversion_to_charge_and_back(percentage):
    assert Battery(BatteryConfig(), percentage / 100.0).percentage == percentage


def test_only_an_empty_battery_shows_zero_percent():
    assert Battery(BatteryConfig(), 0.0001).percentage == 1


def test_voltage_is_the_rest_voltage_less_the_loss_inside():
    battery = Battery(CONFIG, 0.1)
    assert battery.voltage == approx(14.4)
    battery.step(0.0, load=2.0)
    assert battery.voltage == approx(14.4 - 2.0 * 0.25)
    battery.step(0.0, load=0.0, on_dock=True)
    assert battery.voltage == approx(14.4 + 1.0 * 0.25)
    assert Battery(CONFIG, 1.0).voltage == approx(CELLS * 1.47)
    assert Battery(CONFIG, 0.0).voltage == approx(CELLS * 1.0)
    assert Battery(CONFIG, 0.7).voltage == approx(CELLS * (1.27 + 1.34) / 2.0)


@given(st.floats(0.0, 1.0), st.lists(st.tuples(st.floats(0.0, 1e4), st.floats(0.0, 20.0), st.booleans())))
def test_charge_and_current_stay_in_their_ranges_in_any_sequence_of_steps(state_of_charge, steps):
    battery = Battery(CONFIG, state_of_charge)
    for dt, load, on_dock in steps:
        before = battery.charge
        battery.step(dt, load, on_dock)
        assert 0.0 <= battery.charge <= CONFIG.capacity and 0 <= battery.percentage <= 100
        assert 0.0 <= battery.current <= CONFIG.charge_current if on_dock else -load <= battery.current <= 0.0
        assert battery.charge == approx(min(max(before + battery.current * dt / 3600.0, 0.0), CONFIG.capacity))
