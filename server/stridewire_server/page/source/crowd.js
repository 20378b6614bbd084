// A crowd around the player: each walks for a while, then somewhere else.
const AMOUNT = 63;
const RADIUS = 9;

export class Crowd {
  // `seed` makes the same crowd again.
  constructor(seed = 1) {
    this.seed = seed;
    this.members = [];
  }

  // Returns an Edit that adds the crowd around a place, with the settings of `spec`.
  arrive(x, z, spec) {
    this.members = Array.from({ length: AMOUNT }, (_, i) => ({ id: i + 1, until: 0, wish: [0, 0] }));
    const add = this.members.map(({ id }, i) => {
      const angle = 2.4 * i; // the golden angle: even, and never in rows
      const radius = 1.6 + RADIUS * Math.sqrt((i + 0.5) / AMOUNT);
      const position = { x: x + radius * Math.sin(angle), y: 0, z: z + radius * Math.cos(angle) };
      return { ...spec, id, root: { position, yaw: 2 * Math.PI * this.#random() } };
    });
    return { add };
  }

  // Returns an Edit that removes the crowd.
  leave() {
    const remove = this.members.map(({ id }) => id);
    this.members = [];
    return { remove };
  }

  // Returns the velocities [x, z, x, z …] of all at a time; those far from (x, z) come back.
  velocities(time, frame) {
    return this.members.flatMap((member, i) => {
      if (time > member.until) this.#decide(member, time, frame, i + 1);
      return member.wish;
    });
  }

  #decide(member, time, frame, n) {
    member.until = time + 2 + 4 * this.#random();
    const [dx, dz] = [frame.root[0] - frame.root[7 * n], frame.root[2] - frame.root[7 * n + 2]];
    const far = Math.hypot(dx, dz) > 1.3 * RADIUS;
    const angle = far ? Math.atan2(dx, dz) : 2 * Math.PI * this.#random();
    const speed = this.#random() < 0.2 && !far ? 0 : 0.9 + 0.7 * this.#random();
    member.wish = [speed * Math.sin(angle), speed * Math.cos(angle)];
  }

  #random() {
    this.seed = (1664525 * this.seed + 1013904223) >>> 0;
    return this.seed / 2 ** 32;
  }
}
