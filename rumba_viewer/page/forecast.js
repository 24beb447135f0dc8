// How long a mission has taken, and an estimate of how long it still takes: as scene/forecast.py, which says why.

const IDLE = 0, STRANDED = 7, CLEANING = 2, TO_DOCK = [3, 4], CHARGING = 5;  // of rumba_msg/MissionStatus
const TARGET = 0.99;  // share of the floor
const BEGINNING = 50, ENOUGH = 20, GAP = 60;  // [s]
const REST = 0.05, SLOW = 3;
const AIMLESS = ['wander', 'bounce', 'spiral', 'wall_follow'];
const FULL = 0.95, LEAST = 0.12;  // charge
const CHARGE_TIME = 1.3 * 1.69 / 1.25;  // of the default battery, in times of cleaning

export class Forecast {
  constructor() {
    this.last = null;
    this.isActive = false;
    this.begin();
  }

  begin() {
    Object.assign(this, {elapsed: 0, cleaned: 0, used: 0, cleaningTime: 0, charged: 0, chargingTime: 0, share: NaN,
      state: IDLE, strategy: ''});
  }

  // Take what is known at one moment: figures of the floor, the charge [0..1] and the mission.
  add(cleaning, share, {state, strategy}) {
    const {last} = this, isActive = state !== IDLE && state !== STRANDED;
    this.last = cleaning;
    if (!last || cleaning.time < last.time || cleaning.distance < last.distance) this.begin();  // another world
    const step = last ? cleaning.time - last.time : 0;
    if (isActive && !this.isActive) this.begin();
    else if (last && this.isActive && step > 0 && step <= GAP)
      this.count(step, cleaning.cleaned_area - last.cleaned_area, share - this.share);
    Object.assign(this, {isActive, state, share, strategy});
  }

  count(time, area, charge) {
    this.elapsed += time;
    if (this.state === CLEANING && area >= 0 && charge <= 0) {
      this.cleaningTime += time;
      this.cleaned += area;
      this.used -= charge;
    } else if (this.state === CHARGING && charge >= 0) {
      this.chargingTime += time;
      this.charged += charge;
    }
  }

  // How long the mission still takes [s], with all charging; null: unknown, or there is no cleaning.
  get left() {
    const {last, cleaned, cleaningTime} = this;
    if (AIMLESS.includes(this.strategy) || !this.isActive || !last || cleaningTime < BEGINNING || cleaned <= 0) return null;
    const still = Math.max(TARGET * last.reachable_area - last.cleaned_area, 0);
    const weighted = still + (SLOW - 1) * Math.min(still, REST * last.reachable_area);
    const work = weighted / cleaned * cleaningTime;
    let time = work, need = work * this.used / cleaningTime;
    if (this.state === CHARGING) {
      time += Math.max(FULL - this.share, 0) * this.timeToCharge;
      need -= FULL - LEAST;
    } else if (TO_DOCK.includes(this.state) && still > 0) {
      time += (FULL - this.share) * this.timeToCharge;
      need -= FULL - LEAST;
    } else need -= this.share - LEAST;
    if (need > 0) time += Math.ceil(need / (FULL - LEAST)) * (FULL - LEAST) * this.timeToCharge;
    return Number.isFinite(time) ? time : null;
  }

  // Time for the whole charge [s].
  get timeToCharge() {
    if (this.chargingTime >= ENOUGH && this.charged > 0) return this.chargingTime / this.charged;
    return this.used > 0 ? this.cleaningTime / this.used * CHARGE_TIME : 0;
  }
}

// An estimate of a time [s] in words.
export function about(seconds) {
  if (seconds < 60) return 'less than 1 min';
  const minutes = Math.ceil(seconds / 60);
  return minutes < 120 ? `about ${minutes} min` : `about ${(minutes / 60).toFixed(1)} h`;
}
