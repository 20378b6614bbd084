// Stridewire's messages without a protobuf library, by the layout that the server tells.
//
//   const layout = await (await fetch("layout.json")).json();
//   const session = new Session(new WebSocket("ws://127.0.0.1:8080/v1/animate"), layout);
//   const opened = await session.open({ characters: [{ id: 1 }], pacing: "PACING_SERVER" });
//   session.onframe = (frame) => draw(frame.root, frame.hips, frame.rotations);
//   session.send({ step: { velocity_xz: [0, 1.3] } });

const BYTES = { float32: 4, float64: 8 };
const text = { write: new TextEncoder(), read: new TextDecoder() };

export class Session {
  constructor(socket, layout) {
    Object.assign(this, { socket, layout, step: 0, onframe: () => {}, onerror: console.error });
    socket.binaryType = "arraybuffer";
    socket.onmessage = ({ data }) => this.#receive(decode(layout, layout.receive, new DataView(data)));
    socket.onclose = ({ code, reason }) => this.onerror(`closed: ${code} ${reason}`);
  }

  // Sends Open; resolves to Opened.
  open(spec) {
    return new Promise((resolve) => {
      this.opened = resolve;
      if (this.socket.readyState === 1) this.send({ open: spec });
      else this.socket.onopen = () => this.send({ open: spec });
    });
  }

  // Sends an AnimateRequest; a step is numbered and acknowledges the newest frame.
  send(request) {
    if (request.step) request.step = { step: ++this.step, last_frame: this.last ?? 0, ...request.step };
    this.socket.send(Uint8Array.from(encode(this.layout, this.layout.send, request)));
  }

  #receive({ opened, frame, error }) {
    if (opened) this.opened(opened);
    if (error) this.onerror(error);
    if (!frame) return;
    this.last = frame.frame;
    this.send({ step: { ack_only: true } }); // or with the next controls, if they come soon
    this.onframe(frame);
  }
}

// Returns the bytes of a message given as an object with the names of the contract.
export function encode(layout, name, message) {
  const out = [];
  for (const [key, value] of Object.entries(message)) {
    const field = layout.messages[name][key];
    if (!field) throw new Error(`${name} has no field ${key}`);
    if (field.repeated === "packed") {
      writeVarint(out, field.tag);
      const numbers = [...value].flatMap((number) => scalar(layout, field, number));
      writeVarint(out, numbers.length);
      out.push(...numbers);
      continue;
    }
    for (const one of field.repeated ? value : [value]) {
      writeVarint(out, field.tag);
      out.push(...scalar(layout, field, one));
    }
  }
  return out;
}

function scalar(layout, { type, of }, value) {
  const out = [];
  if (type in BYTES) {
    const view = new DataView(new ArrayBuffer(BYTES[type]));
    type === "float32" ? view.setFloat32(0, value, true) : view.setFloat64(0, value, true);
    return [...new Uint8Array(view.buffer)];
  }
  if (type === "string" || type === "bytes" || type === "message") {
    const bytes = type === "message" ? encode(layout, of, value)
      : type === "string" ? text.write.encode(value) : value;
    writeVarint(out, bytes.length);
    return [...out, ...bytes];
  }
  writeVarint(out, type === "enum" && typeof value === "string" ? layout.enums[of][value] : Number(value));
  return out;
}

function writeVarint(out, value) {
  for (; value > 127; value = Math.floor(value / 128)) out.push((value % 128) | 128);
  out.push(value);
}

// Returns a message as an object; blocks of numbers are typed arrays. Absent fields are absent.
export function decode(layout, name, view) {
  const fields = Object.entries(layout.messages[name]);
  const byTag = new Map(fields.map(([key, field]) => [field.tag, { key, ...field }]));
  const message = {};
  for (let at = 0; at < view.byteLength; ) {
    let tag, length;
    [tag, at] = readVarint(view, at);
    const wire = tag & 7;
    if (wire === 2) [length, at] = readVarint(view, at);
    else length = { 1: 8, 5: 4 }[wire] ?? readVarint(view, at)[1] - at;
    const field = byTag.get(tag);
    const part = new DataView(view.buffer, view.byteOffset + at, length);
    at += length;
    if (!field) continue; // of a later version
    const value = field.repeated === "packed" ? numbers(field, part) : read(layout, field, part);
    if (field.repeated && field.repeated !== "packed") (message[field.key] ??= []).push(value);
    else message[field.key] = value;
  }
  return message;
}

function numbers({ type }, view) {
  if (type === "float32") return new Float32Array(view.buffer.slice(view.byteOffset, view.byteOffset + view.byteLength));
  const out = [];
  for (let at = 0; at < view.byteLength; ) {
    if (type === "float64") out.push(view.getFloat64(at, true)), (at += 8);
    else {
      const [value, next] = readVarint(view, at);
      out.push(value), (at = next);
    }
  }
  return out;
}

function read(layout, { type, of }, view) {
  if (type === "message") return decode(layout, of, view);
  const bytes = new Uint8Array(view.buffer, view.byteOffset, view.byteLength);
  if (type === "string") return text.read.decode(bytes);
  if (type === "bytes") return bytes;
  if (type === "float32") return view.getFloat32(0, true);
  if (type === "float64") return view.getFloat64(0, true);
  const [value] = readVarint(view, 0);
  return type === "bool" ? value === 1 : value;
}

function readVarint(view, at) {
  let value = 0;
  for (let factor = 1; ; factor *= 128) {
    const byte = view.getUint8(at++);
    value += (byte & 127) * factor;
    if (byte < 128) return [value, at];
  }
}
