// A notice over the arena: what went wrong or has ended, and what the user can do.
import { by, element, show } from "./element";
import { Live } from "./live";
import type { Source } from "./source";

export class Notice {
  private readonly host = by<HTMLDivElement>("notice");
  private shown = "";

  /** Reports that a source has failed or ended, with buttons to begin again with a seed or to look back. */
  about(source: Source, now: number, lost: boolean, again: (live: Live, seed: number) => void, back: () => void): void {
    if (lost) this.show("The browser has taken the graphics away. They return by themselves, or when the page is loaded again.", { "Load the page again": () => location.reload() });
    else if (source instanceof Live && source.error) this.show(source.error, { "Begin again": () => again(source, source.seed) });
    else if (source instanceof Live && source.over && now >= source.last) {
      const begin = { "Begin again": () => again(source, source.seed), "Another seed": () => again(source, source.seed + 1) };
      this.show(`The world died out at step ${show(source.last)}.`, { "Look back": back, ...begin });
    } else this.show("");
  }

  /** Shows a text and buttons, by their labels; an empty text hides the notice. */
  show(text: string, acts: Record<string, () => void> = {}): void {
    if (text === this.shown) return;
    this.shown = text;
    this.host.hidden = text === "";
    const buttons = Object.entries(acts).map(([name, act]) => {
      const button = element("button", { text: name });
      button.onclick = act;
      return button;
    });
    this.host.replaceChildren(element("p", { text }), element("div", { class: "row" }, ...buttons));
  }
}
