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
    t: (name, values = {}) => fillIn(labels[name] ?? name, values),
  };
}

/** @param {string} text @param {Record<string, string | number>} values */
export function fillIn(text, values) {
  return text.replace(/\{(\w+)\}/g, (whole, name) => (name in values ? String(values[name]) : whole));
}
