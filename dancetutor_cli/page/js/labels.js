// Words for moves and findings: in the page's language where its file has them, else as the solver and the linter say.

/**
 * @typedef {{second: number, text: string, short: string, severity: string, columns: number[]}} Label
 * short: where there is little room; columns: the row's notes
 */

/** A panel's name. @param {import("./words.js").Translate} t @param {string} name */
export function panelName(t, name) {
  const label = t(`panel-${name}`);
  return label === `panel-${name}` ? name : label;
}

/** A move's name. @param {import("./words.js").Translate} t @param {string} name */
function moveName(t, name) {
  const label = t(`move-${name}`);
  return label === `move-${name}` ? name.replaceAll("-", " ") : label;
}

/**
 * All that a row's moves are called, each once: no "crossover" beside "crossover in front".
 * @param {import("./words.js").Translate} t @param {string[]} names
 */
export function moveNames(t, names) {
  const words = [...new Set(names.map((name) => moveName(t, name)))];
  return words.filter((word) => !words.some((other) => other.startsWith(`${word} `))).join(", ");
}

/**
 * A move's or a rule's shortest name; its sign for a rule without one.
 * @param {import("./words.js").Translate} t @param {string} name
 */
function shortName(t, name) {
  const label = t(`short-${name}`);
  return label === `short-${name}` ? (/^DT/.test(name) ? name : moveName(t, name)) : label;
}

/**
 * A finding's name and what it means.
 * @param {import("./words.js").Translate} t @param {{rule: string, name: string}} finding @returns {[string, string]}
 */
export function findingWords(t, { rule, name }) {
  const label = t(`finding-${rule}`);
  const at = label.indexOf(": ");
  return at < 0 ? [name.replaceAll("-", " "), ""] : [label.slice(0, at), label.slice(at + 2)];
}

/** Figures in the linter's English messages, by the label that shows them. */
const FIGURES = /** @type {[string, RegExp][]} */ ([
  ["rows", /stay crossed for (\d+) rows/], ["sure", /only (\d+) %/], ["steps", /change in (\d+) quick steps/],
  ["way", /([\d.]+) panel widths in (\d+) ms/], ["after", /comes (\d+) ms after/], ["apart", /(\d+) rows (\d+) ms apart/],
  ["among-before", /(\w+) panels in the middle of 16ths, (\d+) ms before/],
  ["among-after", /(\w+) panels in the middle of 16ths, (\d+) ms after/],
  ["dense-before", /(\w+) panels, (\d+) ms before/], ["dense-after", /(\w+) panels, (\d+) ms after/],
  ["alternate", /two panels, then one, then two in 16ths, (\d+) ms apart/],
  ["before", /(\d+) ms before the foot/], ["lasts", /lasts ([\d.]+) s, not ([\d.]+) to ([\d.]+) s/],
  ["tempo", /([\d.]+) BPM, not ([\d.]+) to ([\d.]+)/],
]);

/** Numbers that messages write out. */
const WRITTEN = /** @type {Record<string, number>} */ ({ three: 3, four: 4 });

/**
 * The figures of a finding's English message in the page's language: "(1,5 Felder in 120 ms)"; "" where none are known.
 * @param {import("./words.js").Translate} t @param {{message: string}} finding
 */
export function findingFigures(t, { message }) {
  for (const [name, pattern] of FIGURES) {
    const found = pattern.exec(message);
    if (found)
      return `(${t(`figures-${name}`, Object.fromEntries(found.slice(1).map((text, k) => [`n${k + 1}`, WRITTEN[text] ?? Number(text)])))})`;
  }
  return "";
}

/**
 * Words beside the notes: moves where they begin, and findings.
 * @param {import("./doc.js").PageDoc} doc @param {import("./chart.js").Chart} chart
 * @param {import("./words.js").Translate} t @returns {Label[]}
 */
export function labelsOf(doc, chart, t) {
  /** @type {Label[]} */
  const out = [];
  /** @type {Map<number, Label>} by millisecond */
  const at = new Map();
  /** @type {string[]} */
  let before = [];
  for (const row of chart.rows) {
    const now = new Map(row.moves.filter((name) => doc.style.callouts[name]).map((name) => [moveName(t, name), shortName(t, name)]));
    const fresh = [...now].filter(([word]) => !before.includes(word));
    before = [...now.keys()];
    if (!fresh.length) continue;
    const label = {
      second: row.second,
      text: fresh.map(([word]) => word).join(", "),
      short: fresh[0][1],
      severity: "move",
      columns: row.steps.map((step) => step.column),
    };
    out.push(label);
    at.set(Math.round(1000 * row.second), label);
  }
  for (const one of doc.findings) {
    if (one.second === null || one.column === null) continue;
    const same = at.get(Math.round(1000 * one.second));
    if (same) same.severity = one.severity;
    else
      out.push({
        second: one.second,
        text: findingWords(t, one)[0],
        short: shortName(t, one.rule),
        severity: one.severity,
        columns: [one.column],
      });
  }
  return out.sort((a, b) => a.second - b.second);
}
