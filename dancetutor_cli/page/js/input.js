// What presses panels: keys, and dance mats or controllers by the Gamepad API; and which key or button is which panel.

/** Keys by number of panels, left to right; by where they are on the keyboard. */
const KEYS = {
  3: ["KeyS", "KeyD", "KeyF"],
  4: ["KeyD", "KeyF", "KeyJ", "KeyK"],
  5: ["KeyZ", "KeyQ", "KeyS", "KeyE", "KeyC"],
  6: ["KeyS", "KeyD", "KeyF", "KeyJ", "KeyK", "KeyL"],
  8: ["KeyA", "KeyS", "KeyD", "KeyF", "KeyJ", "KeyK", "KeyL", "Semicolon"],
  10: ["KeyZ", "KeyQ", "KeyS", "KeyE", "KeyC", "KeyB", "KeyT", "KeyH", "KeyU", "Comma"],
};
/** Keys that are panels too, by number of panels: what players of the games on a computer know. */
const ARROWS = { 4: ["ArrowLeft", "ArrowDown", "ArrowUp", "ArrowRight"] };
const CROSS = { left: 14, down: 13, up: 12, right: 15 }; // buttons of the standard mapping

/** Numbers of buttons from which on both ends of a mat's axes count as such: many mats call their arrows axes. */
const AXES = 64;
const ENDS = { left: AXES, right: AXES + 1, up: AXES + 2, down: AXES + 3 };
/** What else a mat's buttons do, and which do so unless others were chosen: as controllers number them. */
export const CONTROLS = /** @type {const} */ (["start", "select"]);
const OWN = [9, 8];
const EVERY = 4; // ms between two looks at the pads
const PUSHED = 0.5; // of an axis' way

const SIGNS = ["↑", "↗", "→", "↘", "↓", "↙", "←", "↖"]; // clockwise

const LONGEST = 0.5; // seconds that a press may be old; a browser that counts otherwise is not believed

/** @typedef {{column: number, device: "keys" | "pad" | "touch", ago: number}} Press ago: seconds since it happened */

export class Input {
  /**
   * @param {string[]} panels their names @param {import("./settings.js").Settings} settings
   * @param {(number | null)[]} [ways] where their arrows point, degrees
   */
  constructor(panels, settings, ways = []) {
    this.ways = ways;
    /** whether there are no keys to speak of: a phone, until one is pressed */
    this.keyless = typeof matchMedia === "function" && matchMedia("(pointer: coarse)").matches;
    this.touched = this.keyless; // whether lanes are named by arrows: on a phone, and after a mat's press
    this.panels = panels;
    this.settings = settings;
    /** @type {Map<string, boolean[]>} buttons that are down, by pad */
    this.down = new Map();
    /** @type {Map<string, number[]>} where the axes of each pad rest: what has only been at an end so far is no panel */
    this.rests = new Map();
    /** @type {boolean[]} panels that are down */
    this.held = panels.map(() => false);
    this.changed = false; // a panel went down or up since the last picture
    /** @type {(press: Press) => void} */
    this.onPress = () => {};
    /** @type {(name: "start" | "select") => void} a button that is no panel but does something */
    this.onControl = () => {};
    /** @type {((name: string) => void) | null} gets the next key or button instead: a panel is being assigned */
    this.learning = null;
  }

  /** Key of each panel. */
  get keys() {
    const own = this.settings.keys[this.panels.length];
    if (own && own.length === this.panels.length) return own;
    return /** @type {Record<number, string[]>} */ (KEYS)[this.panels.length] ?? this.panels.map((_, k) => `Digit${(k + 1) % 10}`);
  }

  /** Keys that are panels besides. */
  get arrows() {
    return /** @type {Record<number, string[]>} */ (ARROWS)[this.panels.length] ?? [];
  }

  /** What each panel is called above its lane: by its keys; by its arrow where there are none. @returns {string[][]} */
  names() {
    return this.called(this.touched);
  }

  /**
   * All that presses each panel: keys, or arrows on a phone; then buttons (B) and axes (A) of the mats, as the browser
   * numbers them.
   */
  listed() {
    const pads = this.pads();
    return this.called(this.keyless).map((names, column) => [...names, ...new Set(pads.flatMap((pad) => this.buttonNames(pad, column)))]);
  }

  /** @param {Gamepad} pad @param {number} column */
  buttonNames(pad, column) {
    const own = this.settings.pads[this.padName(pad)];
    const end = own || pad.mapping === "standard" ? undefined : ENDS[/** @type {keyof typeof ENDS} */ (this.panels[column])];
    return [this.buttons(pad)[column], end].flatMap((number) =>
      typeof number !== "number" ? [] : [number < AXES ? `B${number}` : `A${(number - AXES) >> 1}${number % 2 ? "+" : "−"}`],
    );
  }

  /** @param {boolean} arrows @returns {string[][]} */
  called(arrows) {
    if (arrows && this.ways.length) return this.ways.map((way) => [way === null ? "■" : SIGNS[Math.round(way / 45) & 7]]);
    return this.panels.map((_, k) => [this.keys, this.arrows].filter((one) => one[k]).map((one) => keyName(one[k])));
  }

  /** The panel of a key, -1 for none; shifted arrows still go from measure to measure. @param {string} code */
  columnOf(code) {
    const own = this.keys.indexOf(code);
    return own >= 0 ? own : this.arrows.indexOf(code);
  }

  /** Button of each panel on a pad. @param {Gamepad} pad @returns {(number | null)[]} */
  buttons(pad) {
    const own = this.settings.pads[this.padName(pad)];
    if (own && own.length === this.panels.length) return own;
    const cross = this.panels.map((name) => CROSS[/** @type {keyof typeof CROSS} */ (name)]);
    if (pad.mapping === "standard" && cross.every((button) => button !== undefined)) return cross;
    return this.panels.map((_, k) => k);
  }

  /** @param {Gamepad} pad */
  padName(pad) {
    return `${pad.id.slice(0, 120)}/${this.panels.length}`;
  }

  /** The panel of a button, -1 for none. @param {Gamepad} pad @param {number} number */
  panelOf(pad, number) {
    const column = this.buttons(pad).indexOf(number);
    if (column >= 0 || number < AXES || this.settings.pads[this.padName(pad)]) return column;
    return this.panels.findIndex((name) => ENDS[/** @type {keyof typeof ENDS} */ (name)] === number);
  }

  /** Buttons of a pad that do what `CONTROLS` names. @param {string} name the pad's @returns {(number | null)[]} */
  controls(name) {
    const own = this.settings.controls[name];
    return own && own.length === CONTROLS.length ? own : OWN;
  }

  /** Which buttons of a pad are down, by number. @param {Gamepad} pad */
  pressed(pad) {
    const name = this.padName(pad);
    const out = pad.buttons.map((button) => button.pressed || button.value > PUSHED);
    if (pad.mapping === "standard") return out; // its sticks are no panels
    const rests = this.rests.get(name) ?? [...pad.axes];
    this.rests.set(name, rests);
    pad.axes.forEach((value, k) => {
      if (Math.abs(value) < PUSHED) rests[k] = value; // a mat may be stepped on as it is seen first
      const counts = Math.abs(rests[k] ?? 0) < PUSHED && Math.abs(value) <= 1;
      out[AXES + 2 * k] = counts && value < -PUSHED;
      out[AXES + 2 * k + 1] = counts && value > PUSHED;
    });
    return out;
  }

  /** The pads that are plugged in. @returns {Gamepad[]} */
  pads() {
    const found = navigator.getGamepads ? navigator.getGamepads() : [];
    return /** @type {Gamepad[]} */ ([...found].filter((pad) => pad !== null && pad.connected));
  }

  /**
   * A key goes down; true if it is a panel's.
   * @param {KeyboardEvent} event
   */
  key(event) {
    if (this.learning) {
      this.learning(event.code);
      return true;
    }
    const column = this.columnOf(event.code);
    if (column < 0) return false;
    this.touched = this.keyless = false;
    if (!event.repeat) this.press(column, "keys", event.timeStamp);
    return true;
  }

  /** @param {KeyboardEvent} event */
  keyUp(event) {
    const column = this.columnOf(event.code);
    if (column >= 0) this.release(column);
  }

  /** A panel is let go. @param {number} column */
  release(column) {
    this.held[column] = false;
    this.changed = true;
  }

  /** Every panel is let go. */
  releaseAll() {
    this.held.forEach((is, column) => { if (is) this.release(column); });
  }

  /**
   * Look at the pads apart from drawing, so that a short press between two pictures is not lost.
   * @returns what `clearInterval` takes
   */
  watch() {
    return setInterval(() => this.poll(), EVERY);
  }

  /** Look at the pads. */
  poll() {
    const pads = this.pads();
    for (const name of this.down.keys()) {
      if (pads.some((pad) => this.padName(pad) === name)) continue;
      this.down.delete(name); // pulled out: nothing of it is held any more
      this.rests.delete(name);
      this.releaseAll();
    }
    for (const pad of pads) {
      const name = this.padName(pad);
      const before = this.down.get(name) ?? [];
      const now = this.pressed(pad);
      now.forEach((is, number) => {
        if (is === Boolean(before[number])) return;
        if (is && this.learning) return this.learning(`${name}#${number}`);
        const column = this.panelOf(pad, number);
        if (column >= 0 && is) this.press(column, "pad", pad.timestamp);
        else if (column >= 0) this.release(column);
        else if (is) this.control(name, number);
      });
      if (!this.down.has(name)) this.touched = true; // a mat has arrows on it
      this.down.set(name, now);
    }
  }

  /** A button that is no panel. @param {string} name the pad's @param {number} number */
  control(name, number) {
    const which = CONTROLS[this.controls(name).indexOf(number)];
    if (!which) return;
    this.changed = true;
    this.onControl(which);
  }

  /**
   * Give Start or Select another button of a mat; keys have no such.
   * @param {number} which of `CONTROLS` @param {string} name as `learning` got it
   */
  assignControl(which, name) {
    const pad = /^(.*)#(\d+)$/.exec(name);
    if (!pad) return;
    const buttons = [...this.controls(pad[1])];
    buttons[which] = Number(pad[2]);
    this.settings.controls[pad[1]] = buttons;
  }

  /** @param {number} column @param {Press["device"]} device @param {number} at milliseconds of the page's clock */
  press(column, device, at) {
    const ago = (performance.now() - at) / 1000;
    this.held[column] = true;
    this.changed = true;
    if (device === "pad") this.touched = true; // its panels have arrows on them, and no letters
    this.onPress({ column, device, ago: ago > 0 && ago < LONGEST ? ago : 0 });
  }

  /** Keys of so many panels, and buttons of every mat, are as at first. */
  forget() {
    const { keys, pads, controls } = this.settings;
    delete keys[this.panels.length];
    for (const name of Object.keys(pads)) if (name.endsWith(`/${this.panels.length}`)) delete pads[name];
    for (const name of Object.keys(controls)) if (name.endsWith(`/${this.panels.length}`)) delete controls[name];
  }

  /**
   * Give a panel the key or button that was learnt.
   * @param {number} column @param {string} name as `learning` got it
   */
  assign(column, name) {
    const pad = /^(.*)#(\d+)$/.exec(name);
    if (pad) {
      const plugged = this.pads().find((one) => this.padName(one) === pad[1]);
      const buttons = [...(this.settings.pads[pad[1]] ?? (plugged ? this.buttons(plugged) : this.panels.map(() => null)))];
      const was = buttons.indexOf(Number(pad[2]));
      if (was >= 0) buttons[was] = buttons[column] ?? null;
      buttons[column] = Number(pad[2]);
      this.settings.pads[pad[1]] = buttons;
      return;
    }
    const keys = [...this.keys];
    const was = keys.indexOf(name);
    if (was >= 0) keys[was] = keys[column];
    keys[column] = name;
    this.settings.keys[this.panels.length] = keys;
  }
}

/** A key's name for people. @param {string} code */
export function keyName(code) {
  const names = { Semicolon: ";", Comma: ",", Period: ".", Slash: "/", ArrowLeft: "←", ArrowRight: "→", ArrowUp: "↑", ArrowDown: "↓" };
  return names[/** @type {keyof typeof names} */ (code)] ?? code.replace(/^(Key|Digit)/, "");
}
