// Begins the page: what there is to see decides whether a character is driven or files are shown.
import { byId } from "./elements.js";
import { Files } from "./files.js";
import { Live } from "./live.js";
import { Stage } from "./stage.js";

const about = await (await fetch("/page/about.json")).json();
byId("version").textContent = about.version;
const stage = new Stage(byId("view"));
const play = about.files.length ? new Files(stage, about) : new Live(stage, about);
byId("more").addEventListener("click", () => document.body.classList.toggle("open"));

let last = performance.now();
function draw(now) {
  const dt = Math.min(Math.max(now - last, 0) / 1000, 0.25);
  last = now;
  play.draw(dt);
  stage.draw(dt);
  requestAnimationFrame(draw);
}
requestAnimationFrame(draw);

// for the console and for tests: what is shown, and how it came
window.stridewire = { stage, play };
