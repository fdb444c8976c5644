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
  es: {
    title: "No se pudo abrir la página",
    old: "Este navegador es demasiado antiguo para descomprimirla (no tiene DecompressionStream). Chrome 80, Firefox 113, Safari 16.4 y posteriores pueden.",
    why: "Algo salió mal: {why}",
    maybe: "Si la página funcionaba antes, la causa puede ser lo que guardó en este navegador.",
    settings: "Olvidar los ajustes e intentarlo de nuevo",
    all: "Olvidar todo: también lo marcado y los pies asignados",
  },
  ja: {
    title: "ページを開けませんでした",
    old: "このブラウザーは古いため、ページを展開できません (DecompressionStream がありません)。Chrome 80、Firefox 113、Safari 16.4 以降で開けます。",
    why: "問題が起きました: {why}",
    maybe: "前に開けたページなら、このブラウザーに保存された内容が原因かもしれません。",
    settings: "設定を消してもう一度開く",
    all: "すべて消す (チェックと変えた足も)",
  },
  ko: {
    title: "페이지를 열 수 없습니다",
    old: "이 브라우저는 오래되어 페이지를 풀 수 없습니다 (DecompressionStream이 없습니다). Chrome 80, Firefox 113, Safari 16.4 이상에서 열 수 있습니다.",
    why: "문제가 생겼습니다: {why}",
    maybe: "전에 열리던 페이지라면 이 브라우저에 저장된 내용이 원인일 수 있습니다.",
    settings: "설정을 지우고 다시 열기",
    all: "모두 지우기 (표시와 바꾼 발도)",
  },
};

/** @param {unknown} error what ended the start */
export function showStartError(error) {
  const t = WORDS[/** @type {keyof typeof WORDS} */ ((navigator.language ?? "").slice(0, 2))] ?? WORDS.en;
  const old = !("DecompressionStream" in window);
  const why = String(error instanceof Error ? error.message : error).slice(0, 300);
  const again = (/** @type {boolean} */ all) => {
    forget(all);
    location.reload();
  };
  const buttons = [
    el("button", { type: "button", onclick: () => again(false) }, t.settings),
    el("button", { type: "button", onclick: () => again(true) }, t.all),
  ];
  document.getElementById("app")?.replaceChildren(
    el(
      "main",
      { class: "failed", role: "alert" },
      el("h1", {}, t.title),
      ...(old
        ? [el("p", {}, t.old)]
        : [
            el(
              "p",
              {},
              t.why.replace("{why}", () => why),
            ),
            el("p", {}, t.maybe),
            el("p", { class: "group" }, ...buttons),
          ]),
    ),
  );
}
