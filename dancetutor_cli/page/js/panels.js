// The panels beside the picture: passages, findings, saved loops, and what is set.

import { el } from "./dom.js";
import { findingFigures, findingWords } from "./labels.js";
import { placeOf, stretch } from "./places.js";
import { missedOf, passedFull, scoreShare, whereOf } from "./record.js";
import { recordPart } from "./results.js";
import { musicText, scoreText } from "./status_text.js";

const TAGS = 2; // of a passage that stand out

/** The hardest passages; a click loops one. @param {import("./app.js").App} app */
export function passagesPanel(app) {
  const { t, doc } = app;
  const list = el("ol", { class: "cards" });
  const buttons = doc.passages.map((passage, k) => {
    const button = el(
      "button",
      { type: "button", class: "card", "aria-pressed": "false", onclick: () => void app.loopPassage(k) },
      el(
        "strong",
        {},
        el("span", { class: "number", title: `--section hardest:${passage.number}` }, `${k + 1}`),
        el("span", {}, stretch(t, passage.from, passage.to)),
      ),
      el("span", { class: "figure" }, t("rate", { rate: Math.round(10 * passage.rate) / 10 })),
      el(
        "span",
        { class: "tags" },
        ...tagsOf(app, passage).flatMap((tag, n) => [el("span", n < TAGS ? {} : { class: "rest" }, tag), " "]),
      ),
      passage.again.length
        ? el(
            "span",
            { class: "text" },
            t("again", { where: passage.again.map((/** @type {[number, number]} */ one) => stretch(t, ...one)).join("; ") }),
          )
        : null,
      el("span", { class: "kept-best" }),
      el("span", { class: "hits" }),
    );
    list.append(el("li", {}, button));
    return button;
  });
  app.listeners.add((what) => {
    if (what === "frame") return;
    buttons.forEach((/** @type {HTMLButtonElement} */ button, /** @type {number} */ k) => {
      button.setAttribute("aria-pressed", String(k === app.passage));
      const { start, end } = doc.passages[k];
      const tally = app.practice.judge.tally(start, end);
      const any = tally.hit + tally.early + tally.late + tally.miss + tally.wrong > 0;
      const where = whereOf(app.chart.beatAt(start), app.chart.beatAt(end));
      const { best: { [where]: clean }, plays: { [where]: play } } = app.record;
      const full = passedFull(app.record, where);
      button.classList.toggle("passed-full", full);
      const lasting = [
        full ? `✓ ${t("passedFull")}` : "",
        play ? t("bestAt", { percent: play[0], rate: play[1] }) : "",
        clean && !full ? t("bestRate", { rate: clean }) : "",
      ];
      /** @type {HTMLElement} */ (button.querySelector(".kept-best")).textContent = lasting.filter(Boolean).join(" · ");
      /** @type {HTMLElement} */ (button.querySelector(".hits")).textContent =
        any && app.practice.along ? t("thisTime", { counts: scoreText(app, tally) }) : "";
    });
  });
  const empty = doc.passages.length ? null : el("p", {}, t("noPassages"));
  return el(
    "div",
    {},
    resumePart(app),
    startPart(app),
    el("h3", {}, t("passagesTitle")),
    el("p", { class: "hint" }, doc.passages.length ? t("passagesHint") : ""),
    empty,
    list,
    loopsPart(app),
  );
}

/**
 * Whose a passage is, and what feet do in it, the most important first.
 * @param {import("./app.js").App} app @param {import("./doc.js").Passage} passage
 */
function tagsOf({ t }, { player, tags }) {
  return [...(player ? [`P${player}`] : []), ...tags.map((/** @type {[string, number]} */ [name, count]) => t(`tag-${name}`, { count }))];
}

/** How it went the last time, and a click to go on with what was missed. @param {import("./app.js").App} app */
function resumePart(app) {
  const { t, record, practice, language } = app;
  const last = record.days[record.days.length - 1];
  const box = el("section", { class: "resume", hidden: !last });
  if (!last) return box;
  const [missed] = missedOf(record, app.chart.rows);
  const day = new Date(`${last.day}T12:00`).toLocaleDateString(language, { day: "numeric", month: "short" });
  const where = missed ? stretch(t, missed.from / 4, missed.to / 4) : "";
  box.append(
    el(
      "p",
      {},
      el("strong", {}, t("lastTime", { day })),
      ` · ${[t("lastScore", { percent: Math.round(100 * scoreShare(last)) }), where ? t("lastMissed", { where }) : t("nothingMissed")].join(" · ")}`,
    ),
  );
  if (missed)
    box.append(
      el(
        "button",
        { type: "button", id: "go-on", class: "main", onclick: () => void practice.coach.start(missed) },
        t("goOn", { where }),
      ),
    );
  app.listeners.add((what) => {
    if (what === "clock" && app.played) box.hidden = true;
  }); // from then on there is something newer
  return box;
}

/** The four ways to begin. @param {import("./app.js").App} app */
function startPart(app) {
  const { t, practice } = app;
  const watch = () => {
    practice.setAlong(false);
    void app.begin();
  };
  const step = (/** @type {boolean} */ wait) => {
    practice.setWait(wait);
    void app.beginAlong();
  };
  const ways = /** @type {[string, string, string, () => void][]} */ ([
    ["watch", "▶", t("watch"), watch], ["step", "✥", t("along"), () => step(false)], ["waits", "◷", t("wait"), () => step(true)],
    ["coached", "↻", t("coach"), () => void practice.coach.start()],
  ]);
  const buttons = ways.map(([name, sign, text, run]) =>
    el(
      "button",
      { type: "button", class: `way ${name}`, title: name === "coached" ? t("coachHint") : "", onclick: run },
      el("span", { class: "icon", "aria-hidden": "true" }, sign),
      el("strong", {}, text),
      el("span", { class: "text" }, t(`way-${name}`)),
    ),
  );
  const show = () => {
    const mode = practice.coach.on ? "coached" : practice.wait ? "waits" : practice.along ? "step" : "watch";
    buttons.forEach((button, k) => button.setAttribute("aria-pressed", String(ways[k][0] === mode)));
  };
  app.listeners.add((what) => { if (what !== "frame") show(); });
  show();
  return el("div", { class: "ways", role: "group", "aria-label": t("waysTitle") }, ...buttons);
}

/**
 * What the linter found, in the words of players; its own message, which is English, is the tooltip. Can be ticked off.
 * @param {import("./app.js").App} app
 */
export function findingsPanel(app) {
  const { t, doc } = app;
  if (!doc.findings.length) return el("p", {}, t("noFindings"));
  const list = el("ul", { class: "cards" });
  for (const one of doc.findings) {
    const [name, about] = findingWords(t, one);
    const key = `${one.rule}@${one.beat ?? ""}`;
    const box = el("input", {
      type: "checkbox",
      "aria-label": t("tickOff", { rule: one.rule, place: one.beat === null ? "" : placeOf(t, one.beat) }),
    });
    box.checked = app.notes.ticked.includes(key);
    const go = el(
      "button",
      {
        type: "button",
        class: "card",
        title: `${one.rule} ${one.name.replaceAll("-", " ")}: ${one.message}`,
        disabled: one.second === null,
        onclick: () => {
          app.transport.pause();
          app.seek(one.second ?? 0);
        },
      },
      el(
        "strong",
        {},
        el("span", { class: "sign-of" }, SIGNS[/** @type {keyof typeof SIGNS} */ (one.severity)] ?? ""),
        about
          ? el("span", { class: "says" }, `${about} ${findingFigures(t, one)}`.trim())
          : el("span", { class: "says", lang: "en" }, one.message),
      ),
      el(
        "span",
        { class: "figure" },
        [one.beat === null ? "" : placeOf(t, one.beat), `${name}\u00a0·\u00a0${one.rule}`].filter(Boolean).join(" · "),
      ),
    );
    const item = el("li", { class: `finding ${one.severity}` }, box, go);
    const show = () => item.classList.toggle("done", box.checked);
    box.addEventListener("change", () => { app.tick(key, box.checked); show(); });
    show();
    list.append(item);
  }
  return el("div", {}, el("p", { class: "hint" }, t("findingsHint")), list);
}

const SIGNS = { error: "■", warning: "▲", info: "●" };

/**
 * Music, cameras of this visit, language.
 * @param {import("./app.js").App} app @param {(file: File) => Promise<void>} load
 */
export function settingsPanel(app, load) {
  const { t, settings, doc } = app;
  const file = el("input", {
    type: "file",
    accept: "audio/*,.ogg,.mp3,.wav,.flac,.opus",
    id: "music-file",
    hidden: true,
    "aria-label": t("musicFile"),
  });
  file.addEventListener("change", () => {
    if (file.files?.[0]) void load(file.files[0]);
    file.value = ""; // the same file may be chosen again
  });
  const choose = el("button", { type: "button", id: "choose-music", onclick: () => file.click() }, t("chooseMusic"));
  const language = el("select", { id: "language" }, el("option", { value: "" }, t("languageOfBrowser")),
    ...Object.keys(doc.languages).map((name) => el("option", { value: name }, doc.languages[name].language ?? name)));
  language.value = settings.language;
  language.addEventListener("change", () => app.setLanguage(language.value));
  const slider = (
    /** @type {"volume" | "speed" | "leadBeats" | "latency" | "sight"} */ name,
    /** @type {number} */ min,
    /** @type {number} */ max,
    /** @type {number} */ step,
  ) => {
    const input = el("input", { type: "range", id: name, min, max, step, value: settings[name] });
    const shown = el("output", { for: name });
    const show = () => {
      input.value = String(settings[name]);
      shown.textContent =
        name === "latency" || name === "sight"
          ? `${Math.round(1000 * settings[name])} ms`
          : t("number", { number: Math.round(100 * settings[name]) / 100 });
    };
    input.addEventListener("input", () => {
      app.set(name, Number(input.value));
      show();
    });
    let before = settings[name];
    input.addEventListener("pointerdown", () => { before = settings[name]; }, { capture: true });
    input.addEventListener("pointercancel", () => { app.set(name, before); show(); }); // the finger scrolled the panel
    app.listeners.add((what) => { if (what === "settings") show(); });
    show();
    return el("p", { class: "field" }, el("label", { for: name }, t(`setting-${name}`)), input, shown);
  };
  const music = el("p", { class: "hint", id: "music-state", role: "status" });
  const tell = () => { music.textContent = musicText(app); };
  app.listeners.add((what) => { if (what === "music") tell(); });
  tell();
  return el(
    "div",
    {},
    el("p", { class: "field whole" }, el("span", {}, t("musicFile")), choose),
    file,
    music,
    slider("volume", 0, 1, 0.05),
    slider("speed", 0.3, 4, 0.05),
    slider("leadBeats", 1, 16, 1),
    slider("latency", -0.2, 0.4, 0.005),
    slider("sight", -0.2, 0.4, 0.005),
    el("p", { class: "field whole" }, el("label", { for: "language" }, t("languageLabel")), language),
    el("p", { class: "hint" }, t("storedHint")), recordPart(app));
}

// Loops that were kept under a name: a list, and a field to keep the one that there is.

/** @param {import("./app.js").App} app */
function loopsPart(app) {
  const { t, chart } = app;
  const name = el("input", {
    type: "text",
    id: "loop-name",
    maxlength: 60,
    autocomplete: "off",
    "aria-label": t("loopName"),
    placeholder: t("loopName"),
  });
  const keep = el("button", { type: "submit", id: "loop-keep" }, t("loopKeep"));
  const form = el("form", { class: "group", onsubmit: (/** @type {Event} */ event) => {
    event.preventDefault();
    const { loop } = app.transport;
    if (!loop) return;
    const called = name.value.trim() || stretch(t, chart.beatAt(loop.a) / 4, chart.beatAt(loop.b) / 4);
    saveLoop(app, called);
    name.value = "";
    hint.textContent = t("loopKept", { name: called });
    list.lastElementChild?.scrollIntoView({ block: "nearest" });
  } }, name, keep);
  const list = el("ul", { class: "cards loops" });
  const hint = el("p", { class: "hint", role: "status" });
  const show = () => {
    form.hidden = keep.disabled = !app.transport.loop; // there is nothing to keep
    hint.textContent = app.transport.loop ? "" : t("loopFirst");
    list.replaceChildren(
      ...app.record.loops.map((loop) =>
        el(
          "li",
          { class: "kept" },
          el(
            "button",
            { type: "button", class: "card", onclick: () => void app.loopBeats(loop.from, loop.to, loop.rate / 100) },
            el("strong", {}, loop.name),
            el("span", { class: "figure" }, t("atSpeed", { rate: loop.rate })),
            el("span", { class: "text" }, stretch(t, loop.from / 4, loop.to / 4)),
          ),
          el(
            "button",
            {
              type: "button",
              class: "sign",
              "aria-label": t("loopDrop", { name: loop.name }),
              title: t("loopDrop", { name: loop.name }),
              onclick: () => dropLoop(app, loop),
            },
            "✕",
          ),
        ),
      ),
    );
  };
  app.listeners.add((what) => { if (what === "loop" || what === "record") show(); });
  show();
  return el("section", {}, el("h3", {}, t("loopsTitle")), form, hint, list);
}

/** Keep the loop that there is under a name. @param {import("./app.js").App} app @param {string} name */
function saveLoop(app, name) {
  const { transport: { loop }, chart, practice, record } = app;
  if (!loop) return;
  const round = (/** @type {number} */ beat) => Math.round(1000 * beat) / 1000;
  const [from, to] = [loop.a, loop.b].map((second) => round(chart.beatAt(second)));
  record.loops = [...record.loops, { name: name.slice(0, 60), from, to, rate: Math.round(100 * practice.chosenRate) }].slice(-50);
  app.saveRecord();
}

/** @param {import("./app.js").App} app @param {import("./record.js").SavedLoop} loop */
function dropLoop(app, loop) {
  app.record.loops = app.record.loops.filter((one) => one !== loop);
  app.saveRecord();
}
