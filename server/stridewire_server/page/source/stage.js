// The stage: ground, light and a camera that follows.
import {
  CanvasTexture,
  Color,
  DirectionalLight,
  Fog,
  HemisphereLight,
  Mesh,
  MeshStandardMaterial,
  PCFShadowMap,
  PerspectiveCamera,
  PlaneGeometry,
  RepeatWrapping,
  SRGBColorSpace,
  Scene,
  Vector3,
  WebGLRenderer,
} from "three";
import { FINE_GRID, GRID, GROUND, SKY } from "./palette.js";

const HALF = 40;
const TILE_M = 5;
const TILE_PIXELS = 1024;
const FOLLOW_S = 0.12;
const SLOW_S = 1 / 24;
// What is given up, one after the other, where drawing is slow: sharpness, shadows, size.
const QUALITIES = [
  { ratio: 2, shadows: true },
  { ratio: 1, shadows: true },
  { ratio: 1, shadows: false },
  { ratio: 0.6, shadows: false },
];

export class Stage {
  constructor(canvas) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.scene = new Scene();
    this.scene.background = new Color(SKY);
    this.scene.fog = new Fog(SKY, 9, 34);
    this.camera = new PerspectiveCamera(42, 1, 0.3, 90);
    this.target = new Vector3(0, 0.95, 0);
    this.look = { yaw: 0.5, pitch: 0.36, distance: 4.8 };
    this.#light();
    this.#ground();
    // `#quality=2` in the address chooses one for good
    const chosen = /quality=([0-3])/.exec(location.hash);
    this.pinned = chosen !== null;
    this.choose(Number(chosen?.[1] ?? 0));
    new ResizeObserver(() => this.#fit()).observe(canvas);
    this.#fit();
  }

  // Moves the camera's target towards a place (x, z), within about FOLLOW_S.
  follow(x, z, dt) {
    const share = 1 - Math.exp(-dt / FOLLOW_S);
    this.target.x += share * (x - this.target.x);
    this.target.z += share * (z - this.target.z);
  }

  draw(dt) {
    this.#keepUp(dt);
    const { yaw, pitch, distance } = this.look;
    const [x, z] = [Math.sin(yaw) * Math.cos(pitch), Math.cos(yaw) * Math.cos(pitch)];
    this.camera.position.set(
      this.target.x - distance * x,
      this.target.y + distance * Math.sin(pitch),
      this.target.z - distance * z,
    );
    this.camera.lookAt(this.target);
    // the floor goes along by whole tiles, so that its lines stay where the world has them
    const step = (value) => TILE_M * Math.round(value / TILE_M);
    this.floor.position.set(step(this.target.x), 0, step(this.target.z));
    this.sun.position.set(this.target.x + 3.5, 8, this.target.z - 2.5);
    this.sun.target.position.set(this.target.x, 0, this.target.z);
    this.renderer.render(this.scene, this.camera);
  }

  // Lowers the quality where frames are drawn slowly for a second or so.
  #keepUp(dt) {
    this.pace += 0.05 * (dt - this.pace);
    if (!this.pinned && this.pace > SLOW_S && this.quality < QUALITIES.length - 1) this.choose(this.quality + 1);
  }

  // Draws with a quality of the list from here on.
  choose(quality) {
    this.quality = quality;
    this.pace = 0;
    const { ratio, shadows } = QUALITIES[quality];
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, ratio));
    this.sun.castShadow = shadows;
  }

  #light() {
    this.scene.add(new HemisphereLight("#ffffff", "#c4ccd6", 1.75));
    this.sun = new DirectionalLight("#fff4e2", 1.7);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.radius = 4;
    this.sun.shadow.bias = -0.0004;
    Object.assign(this.sun.shadow.camera, { left: -8, right: 8, top: 8, bottom: -8, far: 24 });
    this.scene.add(this.sun, this.sun.target);
  }

  #ground() {
    const look = new MeshStandardMaterial({ map: tile(), roughness: 1 });
    // discs and lines lie on it, so it stays a little behind
    Object.assign(look, { polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 4 });
    this.floor = new Mesh(new PlaneGeometry(4 * HALF, 4 * HALF), look);
    this.floor.rotation.x = -Math.PI / 2;
    this.floor.receiveShadow = true;
    this.scene.add(this.floor);
  }

  #fit() {
    const { clientWidth: width, clientHeight: height } = this.renderer.domElement;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.fov = width < height ? 58 : 42;
    // the target lies in the middle of what panel and timeline leave free
    const [right, bottom] = [covered("aside", "offsetWidth", width), covered("footer", "offsetHeight", height)];
    this.camera.setViewOffset(width, height, right / 2, bottom / 2, width, height);
    this.camera.updateProjectionMatrix();
  }
}

// Returns how much of the view an element at its edge takes, at most a third.
function covered(name, size, whole) {
  return Math.min(document.querySelector(name)?.[size] ?? 0, whole / 3);
}

// A tile of five metres by five: a thin line each metre, a stronger one at its edge.
function tile() {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = TILE_PIXELS;
  const pen = canvas.getContext("2d");
  pen.fillStyle = GROUND;
  pen.fillRect(0, 0, TILE_PIXELS, TILE_PIXELS);
  for (let i = 0; i <= TILE_M; i += 1) {
    const edge = i % TILE_M === 0;
    const at = Math.round((i / TILE_M) * TILE_PIXELS) - (edge ? 4 : 1);
    pen.fillStyle = edge ? GRID : FINE_GRID;
    pen.fillRect(at, 0, edge ? 8 : 3, TILE_PIXELS);
    pen.fillRect(0, at, TILE_PIXELS, edge ? 8 : 3);
  }
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.repeat.set((4 * HALF) / TILE_M, (4 * HALF) / TILE_M);
  texture.anisotropy = 8;
  return texture;
}
