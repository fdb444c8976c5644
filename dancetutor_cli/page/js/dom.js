// Elements of the page. Text only ever becomes text: nothing here reads markup.

/**
 * An element with attributes and children; `on...` are listeners, `class` and the rest attributes.
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} tag
 * @param {Record<string, string | number | boolean | null | undefined | ((event: never) => void)>} [about]
 * @param {...(Node | string | null)} children
 * @returns {HTMLElementTagNameMap[K]}
 */
export function el(tag, about = {}, ...children) {
  const out = document.createElement(tag);
  for (const [name, value] of Object.entries(about)) {
    if (typeof value === "function") out.addEventListener(name.slice(2), /** @type {EventListener} */ (value));
    else if (name.startsWith("aria-")) out.setAttribute(name, String(value)); // a state: "true" or "false"
    else if (value === true) out.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) out.setAttribute(name, String(value));
  }
  out.append(...children.filter((child) => child !== null));
  return out;
}

/**
 * A button that is on or off.
 * @param {string} text @param {boolean} on @param {(on: boolean) => void} change @param {string} [hint] its key
 */
export function toggle(text, on, change, hint) {
  const button = el("button", { type: "button", class: "toggle", "aria-pressed": on, title: hint ? `${text} (${hint})` : text }, text);
  button.addEventListener("click", () => {
    const now = button.getAttribute("aria-pressed") !== "true";
    button.setAttribute("aria-pressed", String(now));
    change(now);
  });
  return button;
}

/**
 * Bars side by side, one colour for each series; readers get the words.
 * @param {number[][]} series of equal length @param {string[]} colours @param {string} about
 * @param {number} [most] height of the highest bar
 * @param {string} [look] its class
 */
export function bars(series, colours, about, most = Math.max(1, ...series.flat()), look = "") {
  return el(
    "div",
    { class: `bars ${look}`.trim(), role: "img", "aria-label": about },
    ...series[0].map((_, k) =>
      el(
        "div",
        { class: "bin" },
        ...series.map((values, s) => {
          const bar = el("div");
          bar.style.height = `${Math.min(100, (100 * values[k]) / most)}%`;
          bar.style.background = colours[s];
          return bar;
        }),
      ),
    ),
  );
}

/**
 * A file made in the page, for the user's downloads.
 * @param {string} name @param {string} text
 */
export function download(name, text) {
  const link = el("a", { href: URL.createObjectURL(new Blob([text], { type: "text/plain" })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
