// Elements of the page. Text only ever becomes text: nothing here reads markup.

/**
 * An element with attributes and children; `on...` are listeners, `class` and the rest attributes.
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} tag
 * @param {Record<string, any>} [about]
 * @param {...(Node | string | null)} children
 * @returns {HTMLElementTagNameMap[K]}
 */
export function el(tag, about = {}, ...children) {
  const out = document.createElement(tag);
  for (const [name, value] of Object.entries(about)) {
    if (name.startsWith("on")) out.addEventListener(name.slice(2), value);
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
 * A file made in the page, for the user's downloads.
 * @param {string} name @param {string} text
 */
export function download(name, text) {
  const link = el("a", { href: URL.createObjectURL(new Blob([text], { type: "text/plain" })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
