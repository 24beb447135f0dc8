"""The loads, and what the battery gives and takes."""

from rumba_sim.model.kernel import Record


def load(robot: Record, k: Record) -> float:
    """Sum of the loads [A]: electronics, wheels at their speed, brushes."""
    wheels = 0.5 * (abs(robot.left_speed) + abs(robot.right_speed))
    current = k.idle_current
    if wheels > 0.0:
        current += k.wheel_current_slow + (k.wheel_current - k.wheel_current_slow) * wheels / k.wheel_speed
    if not robot.brushes_up:
        current += k.brush_current
    return current


def battery_current(charge: float, k: Record, load: float, on_dock: bool) -> float:
    """Current into the battery [A], negative while it discharges; the charger tapers as the battery fills."""
    if not on_dock:
        return -load if charge > 0.0 else 0.0
    if charge >= k.capacity:
        return 0.0
    taper = (1.0 - charge / k.capacity) / (1.0 - k.taper_start)
    return max(k.trickle_current, k.charge_current * min(1.0, taper))


def charge_after(charge: float, k: Record, current: float, dt: float) -> float:
    """Charge [Ah] after a current [A] flowed for dt [s]."""
    return min(max(charge + current * k.drain * dt / 3600.0, 0.0), k.capacity)
