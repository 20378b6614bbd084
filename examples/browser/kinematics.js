// Forward kinematics: from a frame's local rotations to where joints are. Quaternions are w, x, y, z.
const multiply = ([a, b, c, d], [e, f, g, h]) => [
  a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g,
  a * g - b * h + c * e + d * f, a * h + b * g - c * f + d * e,
];
const rotate = (q, v) => multiply(multiply(q, [0, ...v]), [q[0], -q[1], -q[2], -q[3]]).slice(1);
const add = (a, b) => a.map((value, i) => value + b[i]);

// Where the joints of the first character are, metres.
export function joints({ root, hips, rotations }, skeleton) {
  const turned = [], places = [];
  for (const [j, parent] of skeleton.parents.entries()) {
    const above = j ? turned[parent] : root.slice(3, 7);
    const from = j ? places[parent] : [...root.slice(0, 3)];
    const step = j ? skeleton.offsets.slice(3 * j, 3 * j + 3) : hips.slice(0, 3);
    places.push(add(from, rotate(above, step)));
    turned.push(multiply(above, [...rotations.slice(4 * j, 4 * j + 4)]));
  }
  return places;
}
