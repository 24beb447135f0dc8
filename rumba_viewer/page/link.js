// The connection to the server, in rosbridge's protocol; it connects again by itself.

const AGAIN = [500, 1000, 2000, 4000];  // [ms] before the next attempt
const PATIENCE = 15000;  // [ms] for the answer of a service

export class Link {
  // `onChange` is called when the connection comes and goes; `onStatus` with each line that the server tells.
  constructor(address, onChange, onStatus) {
    this.address = address;
    this.onChange = onChange;
    this.onStatus = onStatus;
    this.isOpen = false;
    this.topics = new Map();  // name -> {options, act}
    this.calls = new Map();  // id -> {done, timer}
    this.advertised = new Set();
    this.attempts = 0;
    this.number = 0;
    this.connect();
  }

  connect() {
    const socket = this.socket = new WebSocket(this.address());
    socket.onopen = () => {
      this.isOpen = true;
      this.advertised.clear();
      for (const [topic, {options}] of this.topics) this.send({op: 'subscribe', topic, ...options});
      this.onChange(true);
    };
    socket.onmessage = event => this.receive(JSON.parse(event.data));
    socket.onclose = () => {
      if (socket !== this.socket) return;
      const wasOpen = this.isOpen;
      this.isOpen = false;
      for (const {fail} of [...this.calls.values()]) fail('the connection is lost');
      if (wasOpen) this.onChange(false);
      this.again = setTimeout(() => this.connect(), AGAIN[Math.min(this.attempts++, AGAIN.length - 1)]);
    };
  }

  // Connect again, for example with another token.
  restart() {
    clearTimeout(this.again);
    const old = this.socket;
    this.socket = null;
    this.isOpen = false;
    old.close();
    this.connect();
  }

  send(operation) {
    if (this.isOpen) this.socket.send(JSON.stringify(operation));
    return this.isOpen;
  }

  async receive(operation) {
    if (operation.op === 'png') operation = JSON.parse(await unpacked(operation.data));
    if (operation.op === 'publish') {
      this.attempts = 0;
      this.topics.get(operation.topic)?.act(operation.msg);
    } else if (operation.op === 'service_response') {
      this.calls.get(operation.id)?.finish(operation);
    } else if (operation.op === 'status') {
      this.onStatus(operation.msg);
    }
  }

  subscribe(topic, options, act) {
    if (this.topics.has(topic)) return;
    this.topics.set(topic, {options, act});
    this.send({op: 'subscribe', topic, ...options});
  }

  unsubscribe(topic) {
    if (this.topics.delete(topic)) this.send({op: 'unsubscribe', topic});
  }

  publish(topic, type, msg) {
    if (!this.advertised.has(topic) && this.send({op: 'advertise', topic, type})) this.advertised.add(topic);
    return this.send({op: 'publish', topic, msg});
  }

  // The answer of a service; fails with a line that says why.
  call(service, args = {}) {
    const id = `call${++this.number}`;
    return new Promise((resolve, reject) => {
      const end = act => value => {
        clearTimeout(timer);
        this.calls.delete(id);
        act(value);
      };
      const fail = end(line => reject(new Error(line)));
      const finish = end(({result, values}) => result ? resolve(values) : reject(new Error(values)));
      const timer = setTimeout(() => fail(`${service} does not answer`), PATIENCE);
      this.calls.set(id, {finish, fail});
      if (!this.send({op: 'call_service', id, service, args})) fail('not connected');
    });
  }
}

// The text in a picture of rosbridge's compression. Not by a canvas: browsers that guard privacy alter what it returns.
async function unpacked(base64) {
  const bytes = Uint8Array.from(atob(base64), char => char.charCodeAt(0));
  const view = new DataView(bytes.buffer);
  let width = 0, data = null;
  for (let at = 8; at < bytes.length;) {
    const length = view.getUint32(at), kind = String.fromCharCode(...bytes.subarray(at + 4, at + 8));
    if (kind === 'IHDR') width = view.getUint32(at + 8);
    if (kind === 'IDAT') data = bytes.subarray(at + 8, at + 8 + length);
    at += length + 12;
  }
  const stream = new Blob([data]).stream().pipeThrough(new DecompressionStream('deflate'));
  const rows = new Uint8Array(await new Response(stream).arrayBuffer()), row = 3 * width + 1;
  const text = new Uint8Array(rows.length - rows.length / row);
  for (let start = 0, to = 0; start < rows.length; start += row, to += row - 1)
    text.set(rows.subarray(start + 1, start + row), to);  // the first byte of a row is its filter: none
  return new TextDecoder().decode(text);
}
