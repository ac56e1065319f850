// A notice over the arena: what is wrong or over, and what can be done.
import { by, element } from "./element";

export class Notice {
  private readonly host = by<HTMLDivElement>("notice");
  private shown = "";

  /** Shows a text and buttons, by their names; an empty text for none. */
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
