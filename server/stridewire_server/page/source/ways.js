// What lies on the ground: the ways ahead, the way behind, planted and locked feet, the control.
import {
  BufferGeometry,
  CircleGeometry,
  DynamicDrawUsage,
  Float32BufferAttribute,
  Group,
  Line,
  LineBasicMaterial,
  Mesh,
  MeshBasicMaterial,
  RingGeometry,
  SphereGeometry,
  ConeGeometry,
} from "three";
import { CAPTURED, MIDDLE, PLANTED, PREDICTED } from "./palette.js";

const AHEAD = 11; // the place now, and ten tenths of a second
const BEHIND = 180;

export class Ways {
  constructor() {
    this.group = new Group();
    this.predicted = this.#way(PREDICTED, AHEAD, new SphereGeometry(0.032, 12, 8), 0.03);
    this.captured = this.#way(CAPTURED, AHEAD, new RingGeometry(0.022, 0.042, 20).rotateX(-Math.PI / 2), 0.012);
    this.behind = this.#line(MIDDLE, BEHIND, 0.45);
    this.simulated = this.#flat(new RingGeometry(0.15, 0.185, 40), PREDICTED, 0.9);
    this.heading = this.#flat(new ConeGeometry(0.07, 0.16, 3), MIDDLE, 0.75);
    this.planted = Array.from({ length: 4 }, (_, i) =>
      this.#flat(new CircleGeometry(i % 2 ? 0.055 : 0.04, 28), PLANTED, 0.85),
    );
    this.locked = [0, 1].map(() => this.#flat(new RingGeometry(0.075, 0.092, 36), PLANTED, 1));
  }

  // Shows what a frame tells of row n; `feet` are positions of left foot, left toe, right foot, right toe.
  show(frame, n, feet) {
    const [x, z] = [frame.root[7 * n], frame.root[7 * n + 2]];
    const sim = frame.simulatedRoot.slice(4 * n, 4 * n + 4);
    this.#lead(this.predicted, frame.predicted, n, frame.aheadS.length, sim[0], sim[2]);
    this.#lead(this.captured, frame.captured, n, frame.aheadS.length, x, z);
    this.simulated.position.set(sim[0], 0.008, sim[2]);
    const [w, , y] = frame.root.slice(7 * n + 3, 7 * n + 7);
    const yaw = 2 * Math.atan2(y, w);
    this.heading.position.set(x + 0.42 * Math.sin(yaw), 0.01, z + 0.42 * Math.cos(yaw));
    this.heading.rotation.set(Math.PI / 2, 0, -yaw, "XYZ");
    this.heading.scale.set(1, 1, 0.05);
    this.planted.forEach((disc, i) => {
      disc.visible = Boolean((frame.contacts[n] >> i) & 1);
      disc.position.set(feet[3 * i], 0.006, feet[3 * i + 2]);
    });
    this.locked.forEach((ring, i) => {
      const at = 6 * n + 3 * i;
      ring.visible = Number.isFinite(frame.footTargets[at]);
      if (ring.visible) ring.position.set(frame.footTargets[at], 0.009, frame.footTargets[at + 2]);
    });
  }

  // Shows the parts that were chosen.
  choose({ ways, contacts }) {
    const lines = [this.predicted, this.captured].flatMap(({ line, marks }) => [line, ...marks]);
    for (const part of [...lines, this.behind, this.simulated, this.heading]) part.visible = ways;
    if (!contacts) for (const part of [...this.planted, ...this.locked]) part.visible = false;
  }

  // Draws the way behind through places (x, z), the oldest first.
  trail(places) {
    const kept = places.slice(-BEHIND);
    const points = this.behind.geometry.attributes.position;
    kept.forEach(([x, z], i) => points.setXYZ(i, x, 0.005, z));
    points.needsUpdate = true;
    this.behind.geometry.setDrawRange(0, kept.length);
  }

  #lead(way, block, n, times, x, z) {
    const points = way.line.geometry.attributes.position;
    points.setXYZ(0, x, way.height, z);
    for (let k = 0; k < Math.min(times, AHEAD - 1); k += 1) {
      const at = 3 * (times * n + k);
      points.setXYZ(k + 1, block[at], way.height, block[at + 1]);
      way.marks[k].position.set(block[at], way.height, block[at + 1]);
    }
    points.needsUpdate = true;
  }

  #way(colour, count, shape, height) {
    const line = this.#line(colour, count, 0.9);
    const look = new MeshBasicMaterial({ color: colour });
    const marks = Array.from({ length: count - 1 }, () => new Mesh(shape, look));
    this.group.add(...marks);
    return { line, marks, height };
  }

  #line(colour, count, opacity) {
    const shape = new BufferGeometry();
    const points = new Float32BufferAttribute(new Float32Array(3 * count), 3);
    shape.setAttribute("position", points.setUsage(DynamicDrawUsage));
    const line = new Line(shape, new LineBasicMaterial({ color: colour, transparent: true, opacity }));
    line.frustumCulled = false;
    this.group.add(line);
    return line;
  }

  #flat(shape, colour, opacity) {
    if (!(shape instanceof ConeGeometry)) shape.rotateX(-Math.PI / 2);
    const look = new MeshBasicMaterial({ color: colour, transparent: true, opacity, depthWrite: false });
    const mesh = new Mesh(shape, look);
    this.group.add(mesh);
    return mesh;
  }
}
