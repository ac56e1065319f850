// Elements of the page. Text stays text: nothing in here reads HTML from a string.

type Child = Node | string;

export function element<K extends keyof HTMLElementTagNameMap>(
  name: K,
  options: { text?: string; class?: string; title?: string } = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(name);
  if (options.text !== undefined) made.textContent = options.text;
  if (options.class) made.className = options.class;
  if (options.title) made.title = options.title;
  made.append(...children);
  return made;
}

/** The element of the page with this id. */
export function by<T extends HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no #${id}`);
  return found as T;
}

export function option(value: string, text: string): HTMLOptionElement {
  return Object.assign(element("option", { text }), { value });
}

export function table(rows: [string, Child][]): HTMLTableElement {
  const body = element("tbody");
  for (const [name, value] of rows) body.append(element("tr", {}, element("th", { text: name }), element("td", {}, value)));
  return element("table", {}, body);
}

/** A number as a person reads it. */
export function show(value: number | undefined, digits = 2): string {
  if (value === undefined || Number.isNaN(value)) return "–";
  if (value === 0) return "0"; // also for -0
  if (Number.isInteger(value)) return value.toLocaleString("en-US");
  return value.toLocaleString("en-US", { maximumFractionDigits: Math.abs(value) < 0.1 ? 4 : digits });
}

/** A color of the page's style. */
export function styleColor(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
