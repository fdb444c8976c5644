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
 * A number that is given, not a text, gets the language's decimal sign; "{count|press|presses}" is the word for one, or for more.
 * @param {string} text @param {Record<string, string | number>} values @param {string} [decimal]
 */
export function fillIn(text, values, decimal = ".") {
  const shown = (/** @type {string | number} */ value) => (typeof value === "number" ? String(value).replace(".", decimal) : value);
  const numbered = text.replace(/\{(\w+)\|([^|}]*)\|([^}]*)\}/g, (_, name, one, more) => (Number(values[name]) === 1 ? one : more));
  return numbered.replace(/\{(\w+)\}/g, (whole, name) => (name in values ? shown(values[name]) : whole));
}
