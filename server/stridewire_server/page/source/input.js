// What the player wants: keyboard, mouse, gamepad and touch become a velocity and a facing.
const SPEED = { slow: 0.8, walk: 1.4, run: 3.6 };
const KEYS = {
  KeyW: [0, 1],
  ArrowUp: [0, 1],
  KeyS: [0, -1],
  ArrowDown: [0, -1],
  KeyA: [1, 0],
  ArrowLeft: [1, 0],
  KeyD: [-1, 0],
  ArrowRight: [-1, 0],
};
const DEAD_ZONE = 0.15;

export class Input {
  // `look`: yaw, pitch and distance of the camera, changed here; `stick`: the touch element.
  constructor(canvas, look, stick) {
    this.look = look;
    this.held = new Set();
    this.strafing = false;
    this.touch = [0, 0];
    this.#keyboard();
    this.#mouse(canvas);
    this.#stick(stick);
  }

  // Returns the desired velocity [x, z] in the world and the facing, NaN for along the way.
  wish() {
    const pad = gamepad();
    let [left, ahead] = [pad.left + this.touch[0], pad.ahead + this.touch[1]];
    for (const code of this.held) {
      const way = KEYS[code];
      if (way) [left, ahead] = [left + way[0], ahead + way[1]];
    }
    this.look.yaw += pad.turn;
    const size = Math.min(Math.hypot(left, ahead), 1);
    const strafing = this.strafing || this.held.has("KeyF") || pad.strafing;
    const facing = strafing ? this.look.yaw : NaN;
    if (size < 1e-3) return { velocity: [0, 0], facing };
    const speed = size * this.#speed(pad);
    const angle = this.look.yaw + Math.atan2(left, ahead);
    return { velocity: [speed * Math.sin(angle), speed * Math.cos(angle)], facing };
  }

  #speed(pad) {
    const touchRun = Math.hypot(...this.touch) > 0.95;
    if (pad.running || touchRun || this.held.has("ShiftLeft") || this.held.has("ShiftRight")) {
      return SPEED.run;
    }
    return this.held.has("KeyC") ? SPEED.slow : SPEED.walk;
  }

  #keyboard() {
    addEventListener("keydown", (event) => {
      if (typing(event)) return;
      this.held.add(event.code);
      if (event.code in KEYS && !event.ctrlKey) event.preventDefault();
    });
    addEventListener("keyup", (event) => this.held.delete(event.code));
    addEventListener("blur", () => this.held.clear());
  }

  #mouse(canvas) {
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.strafing = event.button === 2;
    });
    canvas.addEventListener("pointerup", () => (this.strafing = false));
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons === 0) return;
      this.look.yaw -= 0.006 * event.movementX;
      this.look.pitch = clamp(this.look.pitch + 0.005 * event.movementY, -0.05, 1.35);
    });
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.look.distance = clamp(this.look.distance * Math.exp(0.0012 * event.deltaY), 1.6, 18);
      },
      { passive: false },
    );
  }

  #stick(stick) {
    const knob = stick.firstElementChild;
    const place = (x, y) => {
      this.touch = [-x, -y];
      knob.style.transform = `translate(${34 * x}px, ${34 * y}px)`;
    };
    stick.addEventListener("pointerdown", (event) => stick.setPointerCapture(event.pointerId));
    stick.addEventListener("pointermove", (event) => {
      if (event.buttons === 0) return;
      const box = stick.getBoundingClientRect();
      const x = (2 * (event.clientX - box.left)) / box.width - 1;
      const y = (2 * (event.clientY - box.top)) / box.height - 1;
      const size = Math.max(Math.hypot(x, y), 1);
      place(x / size, y / size);
    });
    for (const kind of ["pointerup", "pointercancel"]) stick.addEventListener(kind, () => place(0, 0));
  }
}

function gamepad() {
  const pad = [...(navigator.getGamepads?.() ?? [])].find((found) => found?.connected);
  if (!pad) return { left: 0, ahead: 0, turn: 0, running: false, strafing: false };
  const axis = (i) => (Math.abs(pad.axes[i] ?? 0) > DEAD_ZONE ? pad.axes[i] : 0);
  const pressed = (i) => (pad.buttons[i]?.value ?? 0) > 0.3;
  return {
    left: -axis(0),
    ahead: -axis(1),
    turn: -0.035 * axis(2),
    running: pressed(7) || pressed(0),
    strafing: pressed(6),
  };
}

function typing(event) {
  return event.target instanceof Element && event.target.matches("input[type=text], select, textarea");
}

function clamp(value, least, most) {
  return Math.min(Math.max(value, least), most);
}
