// Driving by keys, buttons and touch.

const PERIOD = 100;  // [ms] between two commands
const SPEED = 0.3, TURN = 1.5;  // [m/s], [rad/s]
const KEYS = {ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowLeft: [0, 1], ArrowRight: [0, -1],  // and those of teleop_key
  u: [1, 1], i: [1, 0], o: [1, -1], j: [0, 1], l: [0, -1], m: [-1, 1], ',': [-1, 0], '.': [-1, -1]};

export class Driving {
  // `send` gets the velocity [m/s], [rad/s] of each command.
  constructor(buttons, send) {
    this.send = send;
    this.held = new Map();  // what is held -> [v, w]
    this.timer = null;
    for (const button of buttons) this.watch(button, [Number(button.dataset.v), Number(button.dataset.w)]);
    addEventListener('keydown', event => this.onKey(event, true));
    addEventListener('keyup', event => this.onKey(event, false));
    addEventListener('blur', () => this.stop());
    document.addEventListener('visibilitychange', () => document.hidden && this.stop());
  }

  watch(button, direction) {
    const hold = () => { button.classList.add('held'); this.hold(button, direction); };
    const release = () => { button.classList.remove('held'); this.release(button); };
    button.addEventListener('pointerdown', event => {
      if (event.button === 0 && !button.disabled) { button.setPointerCapture(event.pointerId); hold(); }
    });
    for (const name of ['pointerup', 'pointercancel', 'lostpointercapture', 'blur']) button.addEventListener(name, release);
    button.addEventListener('keydown', event => {
      if ((event.key === ' ' || event.key === 'Enter') && !event.repeat) hold();
    });
    button.addEventListener('keyup', event => { if (event.key === ' ' || event.key === 'Enter') release(); });
    button.addEventListener('contextmenu', event => event.preventDefault());
  }

  onKey(event, isDown) {
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key, direction = KEYS[key];
    if (!direction) return;
    if (!isDown) return this.release(key);
    if (event.ctrlKey || event.altKey || event.metaKey || event.target.closest('input, select')) return;
    event.preventDefault();  // the page must not scroll
    if (!event.repeat) this.hold(key, direction);
  }

  hold(what, direction) {
    this.held.set(what, direction);
    this.timer ??= setInterval(() => this.command(), PERIOD);
    this.command();
  }

  release(what) {
    if (!this.held.delete(what)) return;
    if (!this.held.size) {
      clearInterval(this.timer);
      this.timer = null;
    }
    this.command();
  }

  stop() {
    for (const what of [...this.held.keys()]) this.release(what);
  }

  command() {
    const total = part => [...this.held.values()].reduce((sum, direction) => sum + direction[part], 0);
    const clamp = value => Math.max(-1, Math.min(1, value)), v = clamp(total(0)), w = clamp(total(1));
    this.send(SPEED * v, TURN * (v < 0 ? -w : w));
  }
}
