// A start that fails: a sentence in place of the page, and buttons that forget what is stored. Nothing of the page's data
// can be counted on here, its labels neither.

import { el } from "./dom.js";
import { forget } from "./settings.js";

const WORDS = {
  en: {
    title: "The page could not be opened",
    old: "This browser is too old to unpack it (it has no DecompressionStream). Chrome 80, Firefox 113, Safari 16.4 and newer ones can.",
    why: "Something went wrong: {why}",
    maybe: "If the page worked before, what it has stored in this browser may be the reason.",
    settings: "Forget the settings and try again",
    all: "Forget everything: also what was ticked off, and feet that were given",
  },
  de: {
    title: "Die Seite ließ sich nicht öffnen",
    old: "Dieser Browser ist zu alt, um sie zu entpacken (er hat keinen DecompressionStream). Chrome 80, Firefox 113, Safari 16.4 und neuere können es.",
    why: "Etwas ging schief: {why}",
    maybe: "Wenn die Seite schon einmal lief, liegt es vielleicht an dem, was sie in diesem Browser gespeichert hat.",
    settings: "Einstellungen vergessen und noch einmal",
    all: "Alles vergessen: auch Abgehaktes und vergebene Füße",
  },
};

/** @param {unknown} error what ended the start */
export function failed(error) {
  const t = (navigator.language ?? "en").startsWith("de") ? WORDS.de : WORDS.en;
  const old = !("DecompressionStream" in window);
  const why = String(error instanceof Error ? error.message : error).slice(0, 300);
  const again = (/** @type {boolean} */ all) => { forget(all); location.reload(); };
  const buttons = [el("button", { type: "button", onclick: () => again(false) }, t.settings),
    el("button", { type: "button", onclick: () => again(true) }, t.all)];
  document.getElementById("app")?.replaceChildren(el("main", { class: "failed", role: "alert" }, el("h1", {}, t.title),
    ...(old ? [el("p", {}, t.old)] : [el("p", {}, t.why.replace("{why}", () => why)), el("p", {}, t.maybe), el("p", { class: "group" }, ...buttons)])));
}
