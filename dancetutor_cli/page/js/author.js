// The author's panel: another foot for a note, what it costs, and files to take home.

import { download, el } from "./dom.js";
import { moveNames, panelName } from "./labels.js";
import { placeOf } from "./places.js";

const LETTERS = ["L", "R", "<", ">"];

/** Who steps a row, left to right. @param {import("./app.js").App} app @param {import("./chart.js").Row} row */
function letters(app, row) {
  return row.steps.map((step) => LETTERS[app.redance.limbOf(step)] ?? "?").join("");
}

/** @param {import("./app.js").App} app */
export function authorPanel(app) {
  const { t, redance } = app;
  const about = el("div", { class: "about", role: "status" });
  const give = el("button", { type: "button", onclick: () => { if (app.chosen >= 0) app.giveOther(app.chosen); } }, t("otherFoot"));
  const list = el("ul", { class: "changes" });
  const saved = el("p", { class: "saved", role: "status" });
  const files = /** @type {[string, string, () => string][]} */ ([
    ["takeYaml", "dancetutor.yaml", () => yamlOf(app)],
    ["takeComments", "measure-comments.txt", () => commentsOf(app)],
    ["takePlay", "play.json", () => playOf(app)],
  ]).map(([label, name, make]) => el("button", {
    type: "button",
    onclick: () => {
      download(name, make());
      saved.textContent = t(`${label}Done`, { name, file: app.doc.words.file });
    },
  }, t(label)));
  const take = el("section", {}, el("p", { class: "hint" }, t("approximate")), saved, el("p", { class: "group column" }, ...files));
  const show = () => {
    const row = app.chosen >= 0 ? redance.rowOf.get(app.chosen) : undefined;
    give.disabled = !row || !redance.can(app.chosen);
    give.textContent = t(row && redance.given.has(app.chosen) ? "giveBack" : "otherFoot");
    about.replaceChildren(...(row ? describe(app, row) : [el("p", {}, t("chooseNote"))]));
    const changed = redance.changedRows();
    list.replaceChildren(...changed.map((one) => {
      const text = `${placeOf(t, one.beat)}: ${letters(app, one)}`;
      return el("li", {}, el("button", { type: "button", class: "link", onclick: () => app.goTo(one.steps[0].note) }, text),
        ` ${costText(app, one, true)}`);
    }));
    take.hidden = !changed.length; // there is nothing to take home
  };
  app.listeners.add((what) => {
    if (what !== "feet") return;
    saved.textContent = redance.changedRows().length ? t("keptHere") : "";
    show();
  });
  show();
  return el("div", {}, el("p", { class: "hint" }, t("authorHint")), about, el("p", { class: "group" }, give), list, take);
}

/**
 * A note in words: where it is, its panel and who steps it.
 * @param {import("./app.js").App} app @param {number} note
 */
export function noteText(app, note) {
  const row = app.redance.rowOf.get(note);
  const step = row?.steps.find((one) => one.note === note);
  if (!row || !step) return "";
  const who = `${panelName(app.t, app.doc.pad.names[step.column])} ${LETTERS[app.redance.limbOf(step)] ?? "?"}`;
  const moves = moveNames(app.t, row.moves);
  return `${placeOf(app.t, row.beat)}: ${who}${moves ? ` (${moves})` : ""}`;
}

/** @param {import("./app.js").App} app @param {import("./chart.js").Row} row */
function describe(app, row) {
  const { t, redance } = app;
  const who = row.steps.map((step) => `${panelName(t, app.doc.pad.names[step.column])} ${LETTERS[redance.limbOf(step)] ?? "?"}`).join(", ");
  const given = row.steps.some((step) => redance.given.has(step.note));
  const moves = moveNames(t, row.moves);
  return [
    el("p", {}, el("strong", {}, placeOf(t, row.beat)), ` ${who}`),
    el("p", {}, moves ? t(given ? "movesBefore" : "moves", { moves }) : ""),
    el("p", {}, given ? "" : `${t("rowCost", { cost: row.cost, word: t(`row-${rowWord(app, row.cost)}`) })} `, costText(app, row, given)),
  ];
}

/**
 * What the other foot costs, or costs now that it has been given the row.
 * @param {import("./app.js").App} app @param {import("./chart.js").Row} row @param {boolean} given
 */
function costText(app, row, given) {
  const flip = app.redance.flips.get(row.row);
  if (!flip || flip.extra < 0) return app.t(given ? "givenUnknown" : "noOther");
  const rows = new Set(flip.changes.map(([number]) => number)).size;
  const name = flip.extra === 0 ? "Nothing" : rows > 1 ? "Rows" : "One";
  const word = app.t(`extra-${extraWord(app, flip.extra)}`);
  return app.t(`${given ? "given" : "cost"}${name}`, { word, extra: flip.extra, rows: rows - 1 });
}

/**
 * What an ordinary row of the chart costs: the middle one of those that cost anything.
 * @param {import("./app.js").App} app
 */
function ordinary(app) {
  const costs = app.chart.rows.map((row) => row.cost).filter((cost) => cost > 0).sort((a, b) => a - b);
  return Math.max(1, costs[costs.length >> 1] ?? 1);
}

/** How awkward other feet are, beside an ordinary row. @param {import("./app.js").App} app @param {number} extra */
function extraWord(app, extra) {
  const rows = extra / ordinary(app);
  return rows <= 2 ? "hardly" : rows <= 12 ? "more" : rows <= 1000 ? "much" : "never";
}

/** How awkward a row is, beside an ordinary one. @param {import("./app.js").App} app @param {number} cost */
function rowWord(app, cost) {
  const rows = cost / ordinary(app);
  return rows <= 0.5 ? "easy" : rows <= 2 ? "ordinary" : rows <= 8 ? "awkward" : "very";
}

/** Lines of `feet` in dancetutor.yaml. @param {import("./app.js").App} app */
function yamlOf(app) {
  const { words } = app.doc;
  const lines = ["feet:", "  - when:", `      path: ${quoted(words.file)}`, `      steps-type: ${words.steps}`,
    `      difficulty: ${words.difficulty}`, `      meter: ${words.meter}`, "    steps:"];
  for (const row of app.redance.changedRows()) lines.push(`      ${round(row.beat)}: ${quoted(letters(app, row))}`);
  return `${lines.join("\n")}\n`;
}

/**
 * A pinned comment for each measure with a change: it goes onto the line that opens the measure.
 * @param {import("./app.js").App} app
 */
function commentsOf(app) {
  const measures = [...new Set(app.redance.changedRows().map((row) => Math.floor(row.beat / 4 + 1e-6)))];
  return measures.map((measure) => {
    const rows = app.chart.rows.filter((row) => Math.floor(row.beat / 4 + 1e-6) === measure).map((row) => letters(app, row));
    return `// measure ${measure} {dt1! ${rows.map((one) => (one.length > 1 ? `(${one})` : one)).join("")}}\n`;
  }).join("");
}

const LIMBS = ["left_foot", "right_foot", "left_hand", "right_hand"];
const PARTS = [null, "heel", "toe"];
const KINDS = ["", "tap", "lift", "hold", "roll", "roll_tap"];

/**
 * The play in the JSON of `analyze`, for --play: the author's feet, and what the solver would step then.
 * @param {import("./app.js").App} app
 */
function playOf(app) {
  const { doc, arrays, redance } = app;
  const columns = app.chart.columns;
  const [steps, limbs, parts, ticks, seconds, facing] = ["steps", "limb", "part", "tick", "second", "facing"].map((name) =>
    arrays.get(`row.${name}`),
  );
  /** @type {(number | null)[]} */
  const stands = [null, null];
  const rows = [];
  for (let row = 0; row < ticks.length; ++row) {
    const own = redance.rows.get(row);
    const here = [];
    for (let column = 0; column < columns; ++column) {
      const at = row * columns + column;
      if (!steps[at]) continue;
      const step = own?.steps.find((one) => one.column === column);
      const limb = step ? redance.limbOf(step) : limbs[at];
      if (limb === 0 || limb === 1) stands[limb] = column;
      here.push({ column, limb: LIMBS[limb] ?? null, kind: KINDS[steps[at]], part: PARTS[parts[at]] ?? null });
    }
    if (!here.length) continue;
    rows.push({
      beat: round6(ticks[row] / 48), measure: Math.floor(ticks[row] / 192), second: round6(seconds[row]), steps: here,
      feet: { left: stands[0], right: stands[1] }, facing: round6(facing[row]), moves: own ? own.moves : [],
    });
  }
  const chart = {
    index: Number(doc.words.index),
    steps_type: doc.words.steps,
    difficulty: doc.words.difficulty,
    meter: Number(doc.words.meter),
    rows,
  };
  return JSON.stringify({
    schema: 1,
    tool: "dancetutor page",
    preset: doc.words.preset,
    files: [{ path: doc.words.file, charts: [chart] }],
  });
}

/** @param {number} x */
const round6 = (x) => Math.round(x * 1e6) / 1e6;
/** @param {string} text a string of YAML in double quotes: JSON's are such */
const quoted = (text) => JSON.stringify(text);
/** @param {number} x */
const round = (x) => Math.round(x * 1000) / 1000;
