// Files side by side: the same moment of each, with a bar to scrub.
import { Bodies } from "./body.js";
import { byId, element } from "./elements.js";
import { Input } from "./input.js";

const APART = 1.6;

export class Files {
  constructor(stage, about) {
    this.stage = stage;
    this.time = 0;
    this.playing = true;
    new Input(stage.renderer.domElement, stage.look, byId("stick"));
    this.subjects = about.files;
    this.seconds = Math.max(...about.files.map(({ seconds }) => seconds));
    stage.look.distance = 4 + 0.9 * about.files.length;
    stage.look.yaw = Math.PI + 0.35;
    this.#build();
    about.files.forEach((subject, i) => this.#load(subject, i));
  }

  draw(dt) {
    if (this.playing && this.subjects.every(({ bodies }) => bodies)) {
      this.time = (this.time + dt * this.speed) % Math.max(this.seconds, 1e-3);
      this.bar.value = this.time;
    }
    this.told.value = `${this.time.toFixed(2)} s of ${this.seconds.toFixed(2)} s`;
    const places = this.subjects.filter(({ bodies }) => bodies).map((subject) => this.#show(subject));
    if (places.length) {
      const middle = (k) => places.reduce((sum, place) => sum + place[k], 0) / places.length;
      this.stage.follow(middle(0), middle(2), dt);
    }
  }

  get speed() {
    return Number(this.pace.value);
  }

  // Shows a subject where it is in its own world, moved beside the others; returns its first joint.
  #show(subject) {
    const frame = Math.min(Math.round(this.time * subject.frameRate), subject.frames - 1);
    const joints = subject.parents.length;
    const positions = subject.positions.slice(3 * joints * frame, 3 * joints * (frame + 1));
    for (let j = 0; j < joints; j += 1) {
      positions[3 * j] += subject.aside[0];
      positions[3 * j + 2] += subject.aside[1];
    }
    subject.bodies.pose(0, positions);
    subject.bodies.show(1);
    return positions;
  }

  async #load(subject, i) {
    const data = await (await fetch(subject.url)).arrayBuffer();
    subject.positions = new Float32Array(data);
    const [x, , z] = subject.positions;
    // all begin on one line, in the order of the command, read from left to right on the screen
    subject.aside = [(i - (this.subjects.length - 1) / 2) * APART - x, -z];
    subject.bodies = new Bodies(subject, subject.positions.slice(0, 3 * subject.parents.length), 1);
    this.stage.scene.add(subject.bodies.group);
  }

  #build() {
    document.body.classList.add("files");
    byId("origin").textContent = this.subjects.map(({ name }) => name).join("  ·  ");
    this.bar = element("input", { type: "range", min: 0, max: this.seconds, step: 0.001, ariaLabel: "time" });
    this.bar.value = 0;
    this.bar.addEventListener("input", () => {
      this.playing = false;
      this.time = Number(this.bar.value);
      button.textContent = "play";
    });
    const button = element("button", {}, "pause");
    button.addEventListener("click", () => {
      this.playing = !this.playing;
      button.textContent = this.playing ? "pause" : "play";
    });
    this.told = element("output", {});
    const paces = [0.25, 0.5, 1].map((pace) =>
      element("option", { value: pace, selected: pace === 1 }, `× ${pace}`),
    );
    this.pace = element("select", { ariaLabel: "speed" }, ...paces);
    byId("scrub").replaceChildren(button, this.bar, this.pace, this.told);
  }
}
