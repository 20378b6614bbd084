// Asks a Stridewire server everything once, then drives a character at 60 frames a second.
//
//   node stream.mjs [HOST:PORT] [SECONDS]
//
// Prints one JSON object: what each method answered, and how evenly frames came.
import path from "node:path";
import { fileURLToPath } from "node:url";
import grpc from "@grpc/grpc-js";
import protoLoader from "@grpc/proto-loader";

const [address = "127.0.0.1:50051", seconds = "5"] = process.argv.slice(2);
const protos = path.join(path.dirname(fileURLToPath(import.meta.url)), "../../proto");
const files = ["animation", "match", "library", "blend"].map((name) => `stridewire/v1/${name}.proto`);
const definition = protoLoader.loadSync(files, {
  includeDirs: [protos],
  keepCase: true,
  enums: String,
  defaults: true,
  oneofs: true,
});
const { stridewire } = grpc.loadPackageDefinition(definition);
const credentials = grpc.credentials.createInsecure();
const stub = (name) => new stridewire.v1[name](address, credentials);

function ask(client, method, request = {}) {
  return new Promise((resolve, reject) => {
    const deadline = Date.now() + 5000;
    client[method](request, { deadline }, (error, answer) => (error ? reject(error) : resolve(answer)));
  });
}

async function askEverything() {
  const services = ["ServerService", "LibraryService", "MatchService", "BlendService"].map(stub);
  const [server, library, match, blend] = services;
  const info = await ask(server, "GetInfo");
  const { libraries } = await ask(library, "ListLibraries");
  const details = await ask(library, "GetLibrary");
  const { clips, total } = await ask(library, "ListClips", { page_size: 5 });
  const span = { clip: clips[0].name, end_s: 0.5 };
  const clip = await ask(library, "GetClip", { span });
  const { skeleton } = await ask(library, "GetSkeleton");
  const pose = { clip: { clip: clips[0].name, time_s: 0.25 } };
  const search = await ask(match, "Search", { pose, motion: { velocity_z: 1.3 }, k: 3 });
  const pair = { start: pose, end: { clip: { ...pose.clip, time_s: 0.5 } }, weights: [0, 0.5, 1] };
  const { poses } = await ask(blend, "Blend", pair);
  const { responses } = await ask(blend, "BlendMany", { requests: [pair, pair] });
  for (const client of services) client.close();
  return {
    GetInfo: info.version,
    ListLibraries: libraries.length,
    GetLibrary: Object.keys(details.seconds_by_tag).length,
    ListClips: total,
    GetClip: clip.poses.frames,
    GetSkeleton: skeleton.joints.length,
    Search: search.matches.length,
    Blend: poses.frames,
    BlendMany: responses.length,
  };
}

// One Step every 60th of a second by the wall clock, whether or not frames come back.
function drive(durationS) {
  const client = stub("AnimationService");
  const call = client.Animate();
  const steps = Math.round(durationS * 60);
  const frames = [];
  let lastFrame = 0;
  let sent = 0;
  call.write({ open: { characters: [{ id: 1 }] } });
  return new Promise((resolve, reject) => {
    call.on("error", reject);
    call.on("end", () => (client.close(), resolve(frames)));
    call.on("data", ({ opened, frame, error }) => {
      if (error) reject(new Error(JSON.stringify(error)));
      if (opened) send(1, performance.now());
      if (!frame) return;
      lastFrame = frame.frame;
      // each Step acknowledges; when the last one has gone, frames that still come need a word of their own
      if (sent === steps) call.write({ step: { last_frame: lastFrame, ack_only: true } });
      const latencyMs = performance.now() - 1000 * frame.client_time_s;
      frames.push({ latencyMs, z: frame.root[2], joints: frame.rotations.length / 4 });
      if (frame.applied_step === steps) call.write({ close: {} }), call.end();
    });
    function send(step, begin) {
      const scheduled = begin + ((step - 1) * 1000) / 60;
      const wait = Math.max(0, scheduled - performance.now());
      setTimeout(() => {
        const client_time_s = scheduled / 1000;
        const velocity_xz = [0, 1.3];
        call.write({ step: { step, dt_s: 1 / 60, last_frame: lastFrame, client_time_s, velocity_xz } });
        sent = step;
        if (step < steps) send(step + 1, begin);
      }, wait);
    }
  });
}

const answers = await askEverything();
const frames = await drive(Number(seconds));
const latencies = frames.map((frame) => frame.latencyMs).sort((a, b) => a - b);
const at = (share) => latencies[Math.min(latencies.length - 1, Math.floor(share * latencies.length))];
console.log(
  JSON.stringify({
    answers,
    frames: frames.length,
    joints: frames[0].joints,
    walked_m: frames.at(-1).z,
    p50_ms: at(0.5),
    p99_ms: at(0.99),
  }),
);
