// Makes and finds elements of the page. Text stays text: nothing here parses HTML from a string.

type Child = Node | string;

export function element<K extends keyof HTMLElementTagNameMap>(
  name: K,
  options: { text?: string; class?: string; title?: string } = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const node = document.createElement(name);
  if (options.text !== undefined) node.textContent = options.text;
  if (options.class) node.className = options.class;
  if (options.title) node.title = options.title;
  node.append(...children);
  return node;
}

/** The element with this id. Throws if the page has none. */
export function by<T extends HTMLElement>(id: string): T {
  const node = document.getElementById(id);
  if (!node) throw new Error(`the page has no #${id}`);
  return node as T;
}

export function option(value: string, text: string): HTMLOptionElement {
  return Object.assign(element("option", { text }), { value });
}

export function table(rows: [string, Child][]): HTMLTableElement {
  const body = element("tbody");
  for (const [name, value] of rows) body.append(element("tr", {}, element("th", { text: name }), element("td", {}, value)));
  return element("table", {}, body);
}

/** Formats a number for reading, with as few digits as it needs. */
export function show(value: number | undefined, digits = 2): string {
  if (value === undefined || Number.isNaN(value)) return "–";
  return readable(value, 0, Math.abs(value) < 0.1 ? 4 : digits);
}

/** Formats a number for a table, where all have the same number of decimals. */
export const fixed = (value: number, decimals = 2): string => readable(value, decimals, decimals);

/** Formats a number like `fixed`, with a plus sign if it is positive. */
export const signed = (value: number, decimals = 2): string => readable(value, decimals, decimals, "+");

/** Formats by their least and most decimals; to make one takes fifty times as long as to use it. */
const formats = new Map<string, Intl.NumberFormat>();

/** The one place that writes numbers for readers: with a true minus sign, and no sign for what is rounded to 0. */
function readable(value: number, minimumFractionDigits: number, maximumFractionDigits: number, plus = ""): string {
  const key = `${minimumFractionDigits} ${maximumFractionDigits}`;
  let format = formats.get(key);
  if (!format) formats.set(key, (format = new Intl.NumberFormat("en-US", { minimumFractionDigits, maximumFractionDigits })));
  const text = format.format(Math.abs(value));
  const sign = /^[0.]+$/.test(text) ? "" : value < 0 ? "−" : plus;
  return sign + text;
}

/** Marks a canvas as an image and gives it an initial label, which is replaced by a description once it is drawn. */
export function picture(canvas: HTMLCanvasElement, name: string): void {
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", name);
}

/** A color of the page's style. */
export function styleColor(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** A count with its noun: "1 agent", "2,000 agents". */
export const counted = (count: number, what: string): string => `${show(count)} ${what}${count === 1 ? "" : "s"}`;

/** Clears a canvas and fits it to its size on the page; returns its context, scaled to CSS pixels. */
export function surface(canvas: HTMLCanvasElement): CanvasRenderingContext2D {
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = [Math.max(canvas.clientWidth, 1) * ratio, Math.max(canvas.clientHeight, 1) * ratio];
  if (canvas.width !== Math.round(width)) canvas.width = Math.round(width);
  if (canvas.height !== Math.round(height)) canvas.height = Math.round(height);
  const pen = canvas.getContext("2d")!;
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, canvas.width, canvas.height);
  pen.font = "12px system-ui, sans-serif";
  return pen;
}
