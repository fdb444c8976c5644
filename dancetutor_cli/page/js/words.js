// The page's labels in the language of its reader.

/** @typedef {(name: string, values?: Record<string, string | number>) => string} Translate */

/**
 * @param {Record<string, Record<string, string>>} languages @param {string} wanted "" for the browser's
 * @returns {{language: string, t: Translate}}
 */
export function speak(languages, wanted) {
  const asked = wanted ? [wanted] : [...(navigator.languages ?? []), "en"];
  const language = asked.map((one) => one.slice(0, 2).toLowerCase()).find((one) => one in languages) ?? "en";
  const labels = { ...languages.en, ...languages[language] };
  return {
    language,
    t: (name, values = {}) => fillIn(labels[name] ?? name, values, labels.decimal),
  };
}

/**
 * Numbers, not texts, get the language's decimal sign.
 * @param {string} text @param {Record<string, string | number>} values @param {string} [decimal]
 */
export function fillIn(text, values, decimal = ".") {
  const said = (/** @type {string | number} */ value) => (typeof value === "number" ? String(value).replace(".", decimal) : value);
  return text.replace(/\{(\w+)\}/g, (whole, name) => (name in values ? said(values[name]) : whole));
}
