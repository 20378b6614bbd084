// Driving a character: frames come, are drawn and kept; controls go.
import { Bodies } from "./body.js";
import { Crowd } from "./crowd.js";
import { showDetails } from "./details.js";
import { byId } from "./elements.js";
import { History } from "./history.js";
import { Input } from "./input.js";
import { Kinematics, sidesOf } from "./kinematics.js";
import { Panel } from "./panel.js";
import { Readout } from "./readout.js";
import { convert, save } from "./recording.js";
import { Timeline } from "./timeline.js";
import { Ways } from "./ways.js";
import { Stream, frameOf } from "./wire.js";

const PLAYER = 0;
const MOST = 64;
const FEET = ["LeftFoot", "LeftToe", "RightFoot", "RightToe"];
const FIELDS = { footLock: "foot_lock" };
const SAVED_S = 10;

export class Live {
  constructor(stage, about) {
    this.stage = stage;
    this.history = new History();
    this.readout = new Readout(byId("readout"));
    this.ways = new Ways();
    this.crowd = new Crowd();
    this.cursor = null;
    this.recordedFrom = null;
    stage.scene.add(this.ways.group);
    this.input = new Input(stage.renderer.domElement, stage.look, byId("stick"));
    this.panel = new Panel(about, (names) => this.#changed(names));
    this.timeline = new Timeline(byId("timeline"), this.history, (time) => this.#lookAt(time));
    byId("present").addEventListener("click", () => this.#lookAt(null));
    byId("record").addEventListener("click", () => this.#record());
    for (const format of ["bvh", "glb"]) {
      byId(format).addEventListener("click", () => this.#save(format));
    }
    this.#open();
  }

  // Draws the newest frame, or the one that is looked at.
  draw(dt) {
    const shown = this.cursor === null ? this.newest : this.#past();
    if (shown && this.bodies) this.#show(shown, dt);
    this.timeline.draw(this.cursor);
    showDetails(byId("details"), this.history.transitionAt(this.cursor ?? Infinity));
    this.readout.show();
  }

  #open() {
    this.stream?.close();
    this.history.clear();
    this.readout.clear();
    this.#lookAt(null);
    this.newest = null;
    const { name, synthetic, credit } = this.panel.library;
    byId("origin").textContent = `${name}: ${synthetic ? "generated, not captured" : credit || "captured"}`;
    this.stream = new Stream(
      `ws://${location.host}/v1/animate`,
      (kind, message, bytes) => this.#heard(kind, message, bytes),
      (code, reason) => this.#say(`The stream ended: ${reason || code}. Reload the page to go on.`),
    );
    this.stream.open(name, [{ id: PLAYER, ...this.panel.spec }]);
    if (this.panel.view.crowd) this.stream.edit(this.crowd.arrive(0, 0, this.panel.spec));
  }

  #heard(kind, message, bytes) {
    if (kind === "opened") this.#opened(message, bytes);
    else if (kind === "frame") this.#frame(message, bytes);
    else if (kind === "error") {
      for (const { field } of message.violations) this.panel.takeBack(field);
      this.#say(message.violations.map(({ field, description }) => `${field}: ${description}`).join("\n"));
    } else this.#say(message.message);
  }

  #opened(opened, bytes) {
    const { skeleton } = opened;
    this.openedBytes = bytes;
    this.kinematics = new Kinematics(skeleton);
    this.feet = FEET.map((name) => skeleton.joints.indexOf(name));
    const head = skeleton.joints.indexOf("Head");
    const plan = { parents: skeleton.parents, sides: sidesOf(skeleton.joints), head: head < 0 ? null : head };
    const joints = skeleton.parents.length;
    const still = Float32Array.from({ length: 4 * joints }, (_, i) => (i % 4 ? 0 : 1));
    const rest = this.kinematics.positions([0, 0, 0, 1, 0, 0, 0], skeleton.offsets, still, 0);
    for (const old of [this.bodies, this.ghosts]) old?.dispose();
    this.bodies = new Bodies(plan, rest, MOST);
    this.ghosts = new Bodies(plan, rest, 1, { ghost: true });
    this.stage.scene.add(this.bodies.group, this.ghosts.group);
  }

  #frame(frame, bytes) {
    this.newest = frame;
    this.history.add(frame, bytes);
    this.readout.note(frame);
    const { velocity, facing } = this.input.wish();
    const others = frame.characters.length > 1 ? this.crowd.velocities(frame.timeS, frame) : [];
    const present = frame.characters.length - 1 === others.length / 2 ? others : [];
    const characters = present.length ? [...frame.characters] : [PLAYER];
    const facings = [facing, ...Array(present.length / 2).fill(NaN)];
    this.stream.control(frame.frame, characters, [...velocity, ...present], facings);
  }

  #show(frame, dt) {
    const { view } = this.panel;
    const count = Math.min(frame.characters.length, MOST);
    for (let n = count - 1; n >= 0; n -= 1) {
      this.positions = this.kinematics.positions(frame.root, frame.hips, frame.rotations, n, this.positions);
      this.bodies.pose(n, this.positions);
    }
    this.bodies.show(count);
    this.drawn = { frame: frame.frame, root: [...frame.root.slice(0, 7)], hips: [...this.positions.slice(0, 3)] };
    const feet = this.feet.flatMap((joint) => [...this.positions.slice(3 * joint, 3 * joint + 3)]);
    this.#showGhost(frame, view.ghost);
    this.ways.group.visible = view.ways || view.contacts;
    this.ways.show(frame, 0, feet);
    this.ways.choose(view);
    const until = this.cursor === null ? this.history.frames.length : this.history.at(this.cursor);
    this.ways.trail(this.history.frames.slice(Math.max(0, until - 180), until).map(({ x, z }) => [x, z]));
    this.stage.follow(frame.root[0], frame.root[2], dt);
  }

  // The ghost is the clip's own pose, where the stitched body stands.
  #showGhost(frame, on) {
    if (on) {
      const raw = this.kinematics.positions(frame.root, frame.sampledHips, frame.sampledRotations, 0);
      this.ghosts.pose(0, raw);
    }
    this.ghosts.show(on ? 1 : 0);
  }

  #past() {
    const kept = this.history.frames[this.history.at(this.cursor)];
    if (this.pastBytes !== kept.bytes) [this.pastBytes, this.past] = [kept.bytes, frameOf(kept.bytes)];
    return this.past;
  }

  #lookAt(time) {
    this.cursor = time;
    byId("present").hidden = time === null;
  }

  #changed(names) {
    if (names.includes("library")) {
      this.#open();
      return;
    }
    if (names.includes("crowd")) {
      const [x, , z] = this.newest?.root ?? [0, 0, 0];
      const { crowd } = this.panel.view;
      this.stream.edit(crowd ? this.crowd.arrive(x, z, this.panel.spec) : this.crowd.leave());
    }
    const paths = names.filter((name) => name in this.panel.spec).map((name) => FIELDS[name] ?? name);
    if (!paths.length) return;
    const ids = this.newest ? [...this.newest.characters] : [PLAYER];
    const update = ids.map((id) => ({ spec: { ...this.panel.spec, id }, mask: { paths } }));
    this.stream.edit({ update });
  }

  #record() {
    const button = byId("record");
    if (this.recordedFrom === null) {
      this.recordedFrom = this.history.end;
      this.recordedTo = null;
      button.textContent = "stop recording";
    } else {
      this.recorded = { from: this.recordedFrom, to: this.history.end };
      this.recordedFrom = null;
      button.textContent = "record";
      this.#say(`${(this.recorded.to - this.recorded.from).toFixed(1)} s recorded: save them as BVH or GLB.`);
    }
  }

  // Saves what was recorded last, else the last ten seconds.
  async #save(format) {
    const { from, to } = this.recorded ?? { from: this.history.end - SAVED_S, to: this.history.end };
    const frames = this.history.frames.filter(({ time }) => time >= from && time <= to);
    try {
      save(await convert(format, this.openedBytes, frames.map(({ bytes }) => bytes)), `stridewire.${format}`);
    } catch (error) {
      this.#say(`Could not be saved: ${error.message}`);
    }
  }

  #say(text) {
    const box = byId("message");
    box.textContent = text;
    box.hidden = false;
    clearTimeout(this.hiding);
    this.hiding = setTimeout(() => (box.hidden = true), 8000);
  }
}
