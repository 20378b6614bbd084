// The stream: messages of the contract over a WebSocket, each acknowledged as it comes.
import { create, fromBinary, toBinary } from "@bufbuild/protobuf";
import {
  AnimateRequestSchema,
  AnimateResponseSchema,
  Detail,
  Pacing,
} from "./made/stridewire/v1/animation_pb.js";

export class Stream {
  // `heard(kind, message, bytes)` is called for each message, `ended(code, reason)` at the end.
  constructor(url, heard, ended) {
    this.heard = heard;
    this.ended = ended;
    this.step = 0;
    this.socket = new WebSocket(url);
    this.socket.binaryType = "arraybuffer";
    this.socket.onmessage = (event) => this.#take(new Uint8Array(event.data));
    this.socket.onclose = (event) => this.ended(event.code, event.reason);
  }

  open(library, characters) {
    const message = {
      library,
      pacing: Pacing.SERVER,
      rateHz: 60,
      detail: Detail.INSIDE,
      characters,
    };
    const say = () => this.#say("open", message);
    if (this.socket.readyState === WebSocket.OPEN) say();
    else this.socket.onopen = say;
  }

  // Tells what the characters are to do, and that a frame has been taken.
  control(lastFrame, characters, velocityXz, facingYaw) {
    this.step += 1;
    this.#say("step", {
      step: this.step,
      lastFrame,
      clientTimeS: performance.now() / 1000,
      characters,
      velocityXz,
      facingYaw,
    });
  }

  edit(change) {
    this.#say("edit", change);
  }

  close() {
    this.ended = () => {};
    this.heard = () => {};
    this.socket.close();
  }

  #say(kind, value) {
    if (this.socket.readyState !== WebSocket.OPEN) return;
    const message = create(AnimateRequestSchema, { message: { case: kind, value } });
    this.socket.send(toBinary(AnimateRequestSchema, message));
  }

  #take(bytes) {
    const { message } = fromBinary(AnimateResponseSchema, bytes);
    this.heard(message.case, message.value, bytes);
  }
}

// Returns the frame that bytes hold.
export function frameOf(bytes) {
  return fromBinary(AnimateResponseSchema, bytes).message.value;
}
