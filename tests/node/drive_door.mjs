// Drives a character through the WebSocket door with the code of examples/browser.
//
//   node --experimental-websocket drive_door.mjs HOST:PORT STEPS
//
// Prints one JSON object: names, and of the last frame rotations and where the joints are.
import { joints } from "../../examples/browser/kinematics.js";
import { Session } from "../../examples/browser/stridewire.js";

const [address, steps] = process.argv.slice(2);
const layout = await (await fetch(`http://${address}/v1/layout.json`)).json();
const session = new Session(new WebSocket(`ws://${address}/v1/animate`), layout);
const fail = (error) => (console.error(JSON.stringify(error)), process.exit(1));
session.onerror = fail;
setTimeout(() => fail("no frames came in 30 s"), 30_000).unref();
const { skeleton } = await session.open({ characters: [{ id: 1, stitcher: "spring" }], seed: 7 });
session.onframe = (frame) => {
  if (frame.applied_step < 2 * steps - 1) return step();
  const places = joints(frame, skeleton);
  console.log(
    JSON.stringify({
      names: skeleton.joints,
      frame: frame.frame,
      time_s: frame.time_s,
      root: [...frame.root],
      rotations: [...frame.rotations],
      places,
    }),
  );
  process.exit(0);
};
const step = () => session.send({ step: { dt_s: 1 / 60, velocity_xz: [0.3, 1.3] } });
step();
