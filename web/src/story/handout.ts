// The tables of the printed handout: what happened in each scene, as numbers.
import { element } from "../element";

/** What happened in a scene: a sentence and, below it, a table, unless it has no rows. */
export interface Numbers {
  caption: string;
  head: string[];
  rows: string[][];
}

/** Puts the numbers below the words of a scene, in place of earlier ones. Only print shows them. */
export function fillIn(section: HTMLElement, { caption, head, rows }: Numbers): void {
  const line = (cells: string[], name: "th" | "td") => element("tr", {}, ...cells.map((text, i) => element(i === 0 ? "th" : name, { text })));
  const table = element("table", {}, element("thead", {}, line(head, "th")), element("tbody", {}, ...rows.map((row) => line(row, "td"))));
  section.querySelector(".numbers")?.remove();
  section.querySelector(".words")!.append(element("div", { class: "numbers" }, element("p", { text: caption }), ...(rows.length > 0 ? [table] : [])));
}
