// Bodies with solid limbs, drawn from the positions of joints alone: any skeleton, any number.
import {
  CapsuleGeometry,
  DynamicDrawUsage,
  Group,
  InstancedMesh,
  Matrix4,
  MeshStandardMaterial,
  SphereGeometry,
  Vector3,
} from "three";
import { MIDDLE, sideColour } from "./palette.js";

const THINNEST = 0.028;
const HEAD = 0.105;
const NECK = { across: 0.048, deep: 0.048, reach: 1 };
const CHEST = { across: 0.152, deep: 0.092, reach: 0.55 };
const TRUNK = { across: 0.128, deep: 0.086, reach: 1 };
const TIP = 0.075; // hands and toes, which end where their joint begins

// Returns how thick the bone above joint j is, and to which share of it that reaches.
function girth(plan, j, length) {
  if (plan.sides[j] === 0) {
    if (j === plan.head) return NECK;
    return plan.head !== null && j === plan.parents[plan.head] ? CHEST : TRUNK;
  }
  const radius = Math.min(Math.max(0.155 * length, THINNEST), 0.066);
  return { across: radius, deep: radius, reach: 1 };
}

export class Bodies {
  // `plan`: parents, sides, head (a joint or null); `rest`: positions (3J) at any moment.
  constructor(plan, rest, most, { ghost = false } = {}) {
    this.plan = plan;
    this.group = new Group();
    this.bones = [];
    this.left = plan.sides.findIndex((side) => side > 0);
    this.right = plan.sides.findIndex((side) => side < 0);
    for (let j = 1; j < plan.parents.length; j += 1) {
      const length = distance(rest, 3 * plan.parents[j], rest, 3 * j);
      if (length < 0.02 || this.#isHidden(j)) continue;
      const { across, deep, reach } = girth(plan, j, length);
      const tip = plan.sides[j] !== 0 && !plan.parents.includes(j) ? TIP : 0;
      this.bones.push({ joint: j, across, deep, length: reach * length + tip });
    }
    for (const bone of this.bones) {
      const material = limb(sideColour(plan.sides[bone.joint]), ghost);
      // a capsule one unit thick, scaled to its girth; its caps are as round as it is deep
      const shape = new CapsuleGeometry(1, bone.length / bone.deep, 6, 14);
      bone.mesh = this.#add(new InstancedMesh(shape, material, most), ghost);
    }
    if (plan.head !== null) {
      const shape = new SphereGeometry(HEAD, 24, 18).scale(0.82, 1.08, 0.95);
      this.head = this.#add(new InstancedMesh(shape, limb(MIDDLE, ghost), most), ghost);
    }
    this.matrix = new Matrix4();
    [this.along, this.across, this.front, this.middle] = Array.from({ length: 4 }, () => new Vector3());
  }

  // Poses body n by joint positions (3J) in the world.
  pose(n, positions) {
    const { parents } = this.plan;
    for (const bone of this.bones) {
      const [a, b] = [3 * parents[bone.joint], 3 * bone.joint];
      this.#frame(positions, a, b);
      this.middle.fromArray(positions, a).addScaledVector(this.along, bone.length / 2);
      this.matrix.makeBasis(
        this.across.multiplyScalar(bone.across),
        this.along.multiplyScalar(bone.deep),
        this.front.multiplyScalar(bone.deep),
      );
      this.matrix.setPosition(this.middle);
      bone.mesh.setMatrixAt(n, this.matrix);
    }
    if (this.head) this.#poseHead(n, positions);
  }

  // Shows the first `count` bodies.
  show(count) {
    for (const mesh of this.group.children) {
      mesh.count = count;
      mesh.instanceMatrix.needsUpdate = true;
    }
  }

  dispose() {
    for (const mesh of this.group.children) {
      mesh.geometry.dispose();
      mesh.material.dispose();
      mesh.dispose();
    }
    this.group.removeFromParent();
  }

  #poseHead(n, positions) {
    const joint = this.plan.head;
    this.#frame(positions, 3 * this.plan.parents[joint], 3 * joint);
    this.middle.fromArray(positions, 3 * joint).addScaledVector(this.along, 0.075);
    this.matrix.makeBasis(this.across, this.along, this.front).setPosition(this.middle);
    this.head.setMatrixAt(n, this.matrix);
  }

  // Sets along (from a to b), across (to the body's left) and front, at right angles.
  #frame(positions, a, b) {
    this.along.fromArray(positions, b).sub(this.middle.fromArray(positions, a));
    if (this.along.lengthSq() < 1e-12) this.along.set(0, 1, 0);
    this.along.normalize();
    if (this.left >= 0 && this.right >= 0) {
      this.across.fromArray(positions, 3 * this.left);
      this.across.sub(this.middle.fromArray(positions, 3 * this.right));
    } else this.across.set(1, 0, 0);
    this.front.crossVectors(this.across, this.along);
    if (this.front.lengthSq() < 1e-6) this.front.crossVectors(this.middle.set(0, 0, 1), this.along);
    this.front.normalize();
    this.across.crossVectors(this.along, this.front);
  }

  // The first bone of a leg or an arm lies within the trunk.
  #isHidden(j) {
    const parent = this.plan.parents[j];
    return this.plan.sides[j] !== 0 && this.plan.sides[parent] === 0 && parent === 0;
  }

  #add(mesh, ghost) {
    mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    mesh.castShadow = !ghost;
    mesh.receiveShadow = !ghost;
    mesh.frustumCulled = false;
    mesh.count = 0;
    this.group.add(mesh);
    return mesh;
  }
}

function limb(colour, ghost) {
  const look = ghost ? { transparent: true, opacity: 0.28, depthWrite: false } : {};
  return new MeshStandardMaterial({ color: colour, roughness: 0.62, metalness: 0.02, ...look });
}

function distance(p, i, q, j) {
  return Math.hypot(p[i] - q[j], p[i + 1] - q[j + 1], p[i + 2] - q[j + 2]);
}
