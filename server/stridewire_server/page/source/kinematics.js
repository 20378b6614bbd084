// Forward kinematics: where the joints of a character are. Quaternions are w, x, y, z.

// Writes the product of unit quaternions a[i…] * b[j…] to out[k…].
export function multiply(a, i, b, j, out, k) {
  const [aw, ax, ay, az] = [a[i], a[i + 1], a[i + 2], a[i + 3]];
  const [bw, bx, by, bz] = [b[j], b[j + 1], b[j + 2], b[j + 3]];
  out[k] = aw * bw - ax * bx - ay * by - az * bz;
  out[k + 1] = aw * bx + ax * bw + ay * bz - az * by;
  out[k + 2] = aw * by - ax * bz + ay * bw + az * bx;
  out[k + 3] = aw * bz + ax * by - ay * bx + az * bw;
}

// Writes p[k…] + q[i…] rotating v[j…] to out[m…].
export function moved(p, k, q, i, v, j, out, m) {
  const [w, x, y, z] = [q[i], q[i + 1], q[i + 2], q[i + 3]];
  const [vx, vy, vz] = [v[j], v[j + 1], v[j + 2]];
  const tx = 2 * (y * vz - z * vy);
  const ty = 2 * (z * vx - x * vz);
  const tz = 2 * (x * vy - y * vx);
  out[m] = p[k] + vx + w * tx + y * tz - z * ty;
  out[m + 1] = p[k + 1] + vy + w * ty + z * tx - x * tz;
  out[m + 2] = p[k + 2] + vz + w * tz + x * ty - y * tx;
}

export class Kinematics {
  // `skeleton`: parents (J), offsets (3J) of the joints from their parents at rest.
  constructor(skeleton) {
    this.parents = skeleton.parents;
    this.offsets = skeleton.offsets;
    this.turns = new Float32Array(4 * this.parents.length);
  }

  // Returns positions (3J) in the world of row `n` of blocks root (7N), hips (3N), rotations (4JN).
  positions(root, hips, rotations, n, out = new Float32Array(3 * this.parents.length)) {
    const joints = this.parents.length;
    multiply(root, 7 * n + 3, rotations, 4 * joints * n, this.turns, 0);
    moved(root, 7 * n, root, 7 * n + 3, hips, 3 * n, out, 0);
    for (let j = 1; j < joints; j += 1) {
      const parent = this.parents[j];
      moved(out, 3 * parent, this.turns, 4 * parent, this.offsets, 3 * j, out, 3 * j);
      multiply(this.turns, 4 * parent, rotations, 4 * (joints * n + j), this.turns, 4 * j);
    }
    return out;
  }
}

// Returns 1 for joints of the left, -1 for those of the right, 0 for the middle.
export function sidesOf(names) {
  return names.map((name) => (/^left/i.test(name) ? 1 : /^right/i.test(name) ? -1 : 0));
}
