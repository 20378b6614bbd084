// A character on a canvas, driven by WASD or the arrows; shift runs.
import { joints } from "./kinematics.js";
import { Session } from "./stridewire.js";

const KEYS = { w: [0, 1], s: [0, -1], a: [1, 0], d: [-1, 0] };
const ARROWS = { ArrowUp: "w", ArrowDown: "s", ArrowLeft: "a", ArrowRight: "d" };
const held = new Set();
const named = (key) => ARROWS[key] ?? key.toLowerCase();
addEventListener("keydown", ({ key }) => (held.add(named(key)), steer()));
addEventListener("keyup", ({ key }) => (held.delete(named(key)), steer()));

const layout = await (await fetch("layout.json")).json();
const session = new Session(new WebSocket("ws://127.0.0.1:8080/v1/animate"), layout);
const { skeleton } = await session.open({ characters: [{ id: 1 }], pacing: "PACING_SERVER" });
const pen = document.querySelector("canvas").getContext("2d");
session.onframe = draw;

function steer() {
  const speed = held.has("shift") ? 3.2 : 1.4;
  const [x, z] = [...held].map((key) => KEYS[key] ?? [0, 0]).reduce(([a, b], [c, d]) => [a + c, b + d], [0, 0]);
  const length = Math.hypot(x, z) || 1;
  session.send({ step: { velocity_xz: [(speed * x) / length, (speed * z) / length] } });
}

function draw(frame) {
  const { width, height } = pen.canvas;
  const places = joints(frame, skeleton);
  const [x0, , z0] = frame.root;
  const seen = ([x, y, z]) => [
    width / 2 - 200 * (x - x0 + 0.4 * (z - z0)), 0.85 * height - 200 * (y + 0.25 * (z - z0)),
  ];
  pen.clearRect(0, 0, width, height);
  pen.lineWidth = 10;
  pen.lineCap = "round";
  for (const [j, name] of skeleton.joints.entries()) {
    if (!j) continue;
    pen.strokeStyle = name.startsWith("Left") ? "#1f6fd0" : name.startsWith("Right") ? "#d9581a" : "#343a42";
    pen.beginPath();
    pen.moveTo(...seen(places[skeleton.parents[j]]));
    pen.lineTo(...seen(places[j]));
    pen.stroke();
  }
}
