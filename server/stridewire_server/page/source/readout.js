// Figures: frames a second, and from a control to the first frame that has it.
const KEPT = 240;

export class Readout {
  constructor(box) {
    this.box = box;
    this.clear();
  }

  clear() {
    this.arrivals = [];
    this.latencies = [];
    this.frames = 0;
    this.dropped = 0;
    this.applied = 0;
  }

  // Notes a frame that has just come.
  note(frame) {
    const now = performance.now();
    this.frames += 1;
    this.dropped += frame.dropped;
    push(this.arrivals, now);
    if (frame.appliedStep !== this.applied) {
      this.applied = frame.appliedStep;
      push(this.latencies, now - 1000 * frame.clientTimeS);
    }
  }

  get framesPerSecond() {
    const seconds = (this.arrivals.at(-1) - this.arrivals[0]) / 1000;
    return this.arrivals.length > 1 ? (this.arrivals.length - 1) / seconds : 0;
  }

  // Returns the median time from a control to its frame; milliseconds.
  get latency() {
    const sorted = [...this.latencies].sort((a, b) => a - b);
    return sorted[sorted.length >> 1] ?? 0;
  }

  show() {
    const dropped = this.dropped ? ` · ${this.dropped} skipped` : "";
    this.box.textContent =
      `${this.framesPerSecond.toFixed(0)} frames/s · ` +
      `control to frame ${this.latency.toFixed(0)} ms${dropped}`;
  }
}

function push(list, value) {
  list.push(value);
  if (list.length > KEPT) list.shift();
}
