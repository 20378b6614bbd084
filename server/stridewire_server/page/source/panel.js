// The switches: what the player can change about the character and about the view.
import { byId, element } from "./elements.js";

const WEIGHT_STEPS = [0, 0.25, 0.5, 1, 2, 4];

export class Panel {
  // `about`: what the server says; `changed(names)`: called with the settings that changed.
  constructor(about, changed) {
    this.about = about;
    this.changed = changed;
    this.settings = {
      library: about.libraries[0].name,
      stitcher: "",
      footLock: true,
      filter: "",
      weights: {},
      responsiveness: undefined,
    };
    this.before = {};
    this.view = { ghost: false, ways: true, contacts: true, crowd: false };
    this.#build();
  }

  get library() {
    return this.about.libraries.find(({ name }) => name === this.settings.library);
  }

  // Returns the settings as a CharacterSpec has them.
  get spec() {
    const { library, ...spec } = this.settings;
    return spec;
  }

  // Takes back the setting that a field of an Error names: what was refused does not hold.
  takeBack(field) {
    const [, name] = /\.spec\.(\w+)/.exec(field) ?? [];
    const setting = name?.replace(/_(\w)/, (_, letter) => letter.toUpperCase());
    if (setting && setting in this.before) this.settings[setting] = this.before[setting];
  }

  #build() {
    const { libraries, stitchers } = this.about;
    const set = (name) => (value) => this.#set(name, value);
    const look = (name) => (value) => {
      this.view[name] = value;
      this.changed([name]);
    };
    byId("switches").replaceChildren(
      choice("library", libraries.map(({ name }) => name), this.settings.library, set("library")),
      choice("stitcher", ["", ...stitchers], "", set("stitcher"), "the server's"),
      tick("foot lock", true, set("footLock")),
      tick("raw ghost", false, look("ghost")),
      tick("ways ahead", true, look("ways")),
      tick("contacts", true, look("contacts")),
      tick("crowd of 64", false, look("crowd")),
      slide("responsiveness", 0, 1, 0.05, 0.5, set("responsiveness"), (v) => v.toFixed(2)),
    );
    this.#buildLibrary();
  }

  #buildLibrary() {
    const { tags, channels } = this.library;
    this.settings.filter = "";
    this.settings.weights = {};
    const filter = element("input", {
      type: "text",
      placeholder: "all, or: walk | run",
      ariaLabel: "filter",
      list: "tags",
      onchange: ({ target }) => {
        target.blur(); // keys drive the character again
        this.#set("filter", target.value);
      },
    });
    const known = element("datalist", { id: "tags" }, ...tags.map((tag) => element("option", { value: tag })));
    const weights = Object.entries(channels).map(([name, weight]) =>
      slide(name, 0, WEIGHT_STEPS.length - 1, 1, 3, (value) => {
        this.#set("weights", { ...this.settings.weights, [name]: WEIGHT_STEPS[value] * weight });
      }, (value) => `× ${WEIGHT_STEPS[value]}`),
    );
    byId("library").replaceChildren(
      element("label", {}, "filter", filter, known),
      element("details", {}, element("summary", {}, "weights of the search"), ...weights),
    );
  }

  #set(name, value) {
    this.before = { ...this.settings };
    this.settings[name] = value;
    if (name === "library") this.#buildLibrary();
    this.changed([name]);
  }
}

function choice(label, values, chosen, set, empty = "") {
  const options = values.map((value) =>
    element("option", { value, selected: value === chosen }, value || empty),
  );
  const choose = ({ target }) => {
    target.blur();
    set(target.value);
  };
  const select = element("select", { onchange: choose }, ...options);
  return element("label", {}, label, select);
}

function tick(label, on, set) {
  const box = element("input", { type: "checkbox", checked: on });
  box.addEventListener("change", () => set(box.checked));
  return element("label", { className: "tick" }, box, label);
}

function slide(label, min, max, step, value, set, tell) {
  const told = element("output", {}, tell(value));
  const range = element("input", { type: "range", min, max, step, ariaLabel: label });
  range.value = value;
  range.addEventListener("change", () => set(Number(range.value)));
  range.addEventListener("input", () => (told.value = tell(Number(range.value))));
  return element("label", {}, element("span", {}, label, told), range);
}
