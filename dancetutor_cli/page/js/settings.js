// What the page remembers between visits: its own settings, and per chart what was ticked off and changed. Nothing else.

import { clamp } from "./maths.js";
import { merged, validRecord } from "./record.js";

const KEY = "dancetutor";

/** The free camera's: degrees, degrees, times nearer. */
export const FIRST_VIEW = { yaw: 30, pitch: 20, zoom: 0.9 };

export const CAMERAS = ["back", "front", "mirror", "top", "free"];
export const FEET = ["both", "left", "right"];
export const HELPS = ["all", "tricky", "none", "auto"];

const DEFAULTS = {
  language: "",
  camera: "back",
  speed: 1,
  /** "auto": where there is no music */ claps: "auto",
  metronome: false,
  countIn: true,
  leadBeats: 4,
  ramp: false,
  help: "all",
  latency: 0,
  sight: 0,
  volume: 0.9,
  ...FIRST_VIEW,
  /** @type {Record<string, string[]>} keys by number of panels */ keys: {},
  /** @type {Record<string, (number | null)[]>} buttons by pad and number of panels */ pads: {},
  /** @type {Record<string, (number | null)[]>} buttons for Start and Select by pad */ controls: {},
};

/** Lowest and highest value of settings that an old page, or a hand, may have stored otherwise. */
const LIMITS =
  /** @type {["yaw" | "pitch" | "zoom" | "speed" | "volume" | "latency" | "sight" | "leadBeats", number, number][]} */ ([
    ["yaw", -360, 360],
    ["pitch", 2, 88],
    ["zoom", 0.5, 3],
    ["speed", 0.3, 4],
    ["volume", 0, 1],
    ["latency", -0.2, 0.4],
    ["sight", -0.2, 0.4],
    ["leadBeats", 1, 16],
  ]);

/** What may be chosen among. */
const CHOICES = /** @type {["claps" | "camera" | "help", string[]][]} */ ([
  ["claps", ["auto", "on", "off"]],
  ["camera", CAMERAS],
  ["help", HELPS],
]);

/** @typedef {typeof DEFAULTS} Settings */

/** @returns {Settings} each that is stored as it may be; any other as at first, alone */
export function loadSettings() {
  const stored = read(KEY);
  const out = structuredClone(DEFAULTS);
  for (const [name, value] of Object.entries(DEFAULTS)) {
    const own = Object.hasOwn(stored, name) ? stored[name] : undefined;
    if (typeof own === typeof value && typeof own !== "object" && !(typeof own === "number" && !Number.isFinite(own)))
      Object.assign(out, { [name]: own });
  }
  for (const [name, low, high] of LIMITS) out[name] = clamp(out[name], low, high);
  out.leadBeats = Math.round(out.leadBeats);
  for (const [name, known] of CHOICES) if (!known.includes(out[name])) out[name] = DEFAULTS[name];
  if (!/^[a-z]{0,8}$/.test(out.language)) out.language = DEFAULTS.language;
  out.keys = valid(stored.keys, isKey, (panels, one) => Number(panels) === one.length && new Set(one).size === one.length);
  out.pads = valid(stored.pads, isButton);
  out.controls = valid(stored.controls, isButton);
  return out;
}

/** @param {unknown} button @returns {button is number | null} */
const isButton = (button) => button === null || (typeof button === "number" && Number.isInteger(button) && button >= 0 && button < 1000);

/** @param {unknown} code @returns {code is string} */
const isKey = (code) => typeof code === "string" && /^\w{1,40}$/.test(code);

/**
 * The lists of a table that are as they should be. @template T @param {unknown} table @param {(one: unknown) => one is T} is
 * @param {(name: string, list: T[]) => boolean} [holds] @returns {Record<string, T[]>}
 */
function valid(table, is, holds = () => true) {
  if (!table || typeof table !== "object") return {};
  return Object.fromEntries(
    Object.entries(table).filter(
      ([name, list]) => Array.isArray(list) && list.length <= 32 && list.every(is) && holds(name, list),
    ),
  );
}

/** Forget the settings. @param {boolean} all and what was ticked off and given in every chart */
export function forget(all) {
  try {
    const names = Object.keys(localStorage).filter((name) => name === KEY || (all && name.startsWith(`${KEY}:`)));
    for (const name of names) localStorage.removeItem(name);
  } catch {
    // A browser that stores nothing has nothing to forget.
  }
}

/** @param {Settings} settings */
export function saveSettings(settings) {
  write(KEY, settings);
}

/**
 * @typedef {{ticked: string[], feet: [number, number, number][], foot: string}} Notes
 * of one chart: findings ticked off, feet given, the foot that is practised
 */

/** @param {string} chart @returns {Notes} */
export function loadNotes(chart) {
  const stored = read(`${KEY}:${chart}`);
  const feet = Array.isArray(stored.feet)
    ? stored.feet.filter(
        (one) => Array.isArray(one) && one.length === 3 && one.every(Number.isInteger) && (one[2] === 0 || one[2] === 1),
      )
    : [];
  const ticked = Array.isArray(stored.ticked) ? stored.ticked.filter((one) => typeof one === "string") : [];
  const foot = FEET.find((one) => one === stored.foot) ?? FEET[0];
  return { ticked, feet: /** @type {[number, number, number][]} */ (feet), foot };
}

/** @param {string} chart @param {Notes} notes */
export function saveNotes(chart, notes) {
  write(`${KEY}:${chart}`, notes);
}

const RECORD = `${KEY}:practice:`;

/** What was practised of a chart. @param {string} chart */
export const loadRecord = (chart) => validRecord(read(RECORD + chart));

/** @param {string} chart @param {import("./record.js").PracticeRecord} record */
export const saveRecord = (chart, record) => write(RECORD + chart, record);

/**
 * The records of all charts that this browser keeps.
 * @returns {Record<string, import("./record.js").PracticeRecord>}
 */
export function allRecords() {
  try {
    const ids = Object.keys(localStorage).filter((name) => name.startsWith(RECORD)).map((name) => name.slice(RECORD.length));
    return Object.fromEntries(ids.map((id) => [id, loadRecord(id)]));
  } catch {
    return {};
  }
}

/**
 * Records of a file are added to those that are kept.
 * @param {Map<string, import("./record.js").PracticeRecord>} records
 */
export function takeRecords(records) {
  for (const [id, one] of records) saveRecord(id, merged(loadRecord(id), one));
}

/** @param {string} key @returns {Record<string, unknown>} */
function read(key) {
  try {
    const value = JSON.parse(localStorage.getItem(key) ?? "{}");
    return value && typeof value === "object" ? value : {};
  } catch {
    return {};
  }
}

/** @param {string} key @param {unknown} value */
function write(key, value) {
  try {
    localStorage.setItem(key, JSON.stringify(value));
  } catch {
    // A browser that stores nothing for pages from the disk: the settings last as long as the page.
  }
}
