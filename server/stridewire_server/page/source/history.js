// The last frames as they came, to look back at and to keep as a file.
const MOST_FRAMES = 3600;
const MOST_BYTES = 64 << 20;

export class History {
  constructor() {
    this.clear();
  }

  clear() {
    this.frames = []; // { time, x, z, contacts, bytes }
    this.transitions = []; // { time, transition }
    this.bytes = 0;
  }

  // Keeps a frame; only what happens to the first character is kept apart.
  add(frame, bytes) {
    const [first] = frame.characters;
    const [x, , z] = frame.root;
    this.frames.push({ time: frame.timeS, x, z, contacts: frame.contacts[0], bytes });
    this.bytes += bytes.length;
    for (const { character, event } of frame.events) {
      if (event.case === "transition" && character === first) {
        this.transitions.push({ time: frame.timeS, transition: event.value });
      }
    }
    while (this.frames.length > MOST_FRAMES || this.bytes > MOST_BYTES) {
      this.bytes -= this.frames.shift().bytes.length;
    }
    while (this.transitions.length && this.transitions[0].time < this.begin) this.transitions.shift();
  }

  get begin() {
    return this.frames[0]?.time ?? 0;
  }

  get end() {
    return this.frames.at(-1)?.time ?? 0;
  }

  // Returns the index of the frame at or before a time.
  at(time) {
    let [low, high] = [0, this.frames.length - 1];
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.frames[middle].time <= time) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  // Returns the last transition at or before a time, or none.
  transitionAt(time) {
    return this.transitions.findLast((found) => found.time <= time + 1e-6);
  }
}
