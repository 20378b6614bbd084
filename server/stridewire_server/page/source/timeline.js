// The timeline: transitions as marks, contacts of both feet as bars, and a cursor to drag.
import { LEFT, MIDDLE, REASONS, RIGHT } from "./palette.js";

const SPAN_S = 15;
const GUTTER = 16;
const FEET = [
  { mask: 3, colour: LEFT, name: "L" },
  { mask: 12, colour: RIGHT, name: "R" },
];

export class Timeline {
  // `scrubbed(time)` is called while the cursor is dragged.
  constructor(canvas, history, scrubbed) {
    this.canvas = canvas;
    this.history = history;
    const drag = (event) => {
      if (event.buttons === 0) return;
      const x = event.clientX - canvas.getBoundingClientRect().left;
      const share = (x - GUTTER) / (canvas.clientWidth - GUTTER);
      const time = this.#window.begin + share * SPAN_S;
      scrubbed(Math.min(Math.max(time, history.begin), history.end));
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.held = { ...this.#window };
      drag(event);
    });
    canvas.addEventListener("pointermove", drag);
    canvas.addEventListener("pointerup", () => (this.held = null));
  }

  // Draws what was until now; `cursor` is the time looked at, or null for the present.
  draw(cursor) {
    this.cursor = cursor;
    const pen = this.#begin();
    const { begin } = this.#window;
    const x = (time) => Math.max(GUTTER, this.#x(time, begin));
    this.#seconds(pen, begin, x);
    FEET.forEach((foot, i) => this.#contacts(pen, foot, 42 + 11 * i, x));
    for (const { time, transition } of this.history.transitions) {
      if (time >= begin) mark(pen, REASONS[transition.reason], x(time), 20);
    }
    if (cursor !== null) this.#line(pen, x(cursor), "#101418", 2);
  }

  #x(time, begin) {
    return GUTTER + ((time - begin) / SPAN_S) * (this.canvas.clientWidth - GUTTER);
  }

  get #window() {
    if (this.held) return this.held;
    const end = Math.max(this.history.end, SPAN_S);
    if (this.cursor != null && this.cursor < end - SPAN_S) return { begin: this.cursor - SPAN_S / 4 };
    return { begin: end - SPAN_S };
  }

  #begin() {
    const { canvas } = this;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    const ratio = Math.min(devicePixelRatio, 2);
    const [wide, high] = [Math.round(ratio * width), Math.round(ratio * height)];
    if (canvas.width !== wide || canvas.height !== high) [canvas.width, canvas.height] = [wide, high];
    const pen = canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.font = "11px system-ui, sans-serif";
    return pen;
  }

  #seconds(pen, begin, x) {
    pen.fillStyle = "#69737f";
    for (let second = Math.max(0, Math.ceil(begin)); second < begin + SPAN_S; second += 1) {
      this.#line(pen, x(second), second % 5 ? "#e1e5ea" : "#c3cad3", 1);
      if (second % 5 === 0) pen.fillText(`${second} s`, x(second) + 4, 76);
    }
  }

  #contacts(pen, { mask, colour, name }, y, x) {
    const { frames } = this.history;
    pen.fillStyle = colour;
    const first = this.history.at(this.#window.begin);
    for (let i = first, since = null; i < frames.length; i += 1) {
      const planted = (frames[i].contacts & mask) !== 0;
      if (planted && since === null) since = frames[i].time;
      if (since !== null && (!planted || i === frames.length - 1)) {
        pen.fillRect(x(since), y, Math.max(x(frames[i].time) - x(since), 1), 7);
        since = null;
      }
    }
    pen.fillStyle = MIDDLE;
    pen.fillText(name, 3, y + 8);
  }

  #line(pen, x, colour, width) {
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.beginPath();
    pen.moveTo(x, 4);
    pen.lineTo(x, 64);
    pen.stroke();
  }
}

// Draws the mark of a reason.
export function mark(pen, { colour, shape }, x, y, r = 5.5) {
  pen.fillStyle = colour;
  pen.beginPath();
  if (shape === "circle") pen.arc(x, y, r, 0, 2 * Math.PI);
  else if (shape === "square") pen.rect(x - r + 1, y - r + 1, 2 * r - 2, 2 * r - 2);
  else if (shape === "cross") {
    pen.rect(x - r, y - 2, 2 * r, 4);
    pen.rect(x - 2, y - r, 4, 2 * r);
  } else {
    const points = { up: [0, -r, r, r, -r, r], down: [0, r, r, -r, -r, -r] }[shape] ?? [0, -r, r, 0, 0, r, -r, 0];
    for (let i = 0; i < points.length; i += 2) pen.lineTo(x + points[i], y + points[i + 1]);
  }
  pen.fill();
}
