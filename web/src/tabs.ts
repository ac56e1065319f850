// A row of tabs and their panels, following ARIA: arrow keys move between tabs, and the Tab key moves on to the panel.
import { by } from "./element";

export class Tabs {
  constructor(
    private readonly panels: string[],
    private readonly changed: (name: string) => void,
  ) {
    for (const [i, name] of panels.entries()) {
      const tab = by(`tab-${name}`);
      tab.setAttribute("aria-controls", name);
      const panel = by(name);
      panel.setAttribute("role", "tabpanel");
      panel.setAttribute("aria-labelledby", tab.id);
      panel.tabIndex = 0; // so that it can be scrolled from the keyboard
      tab.onclick = () => this.open(name);
      tab.addEventListener("keydown", (event) => {
        const to = { ArrowLeft: i - 1, ArrowRight: i + 1, Home: 0, End: panels.length - 1 }[event.key];
        if (to === undefined) return;
        event.preventDefault();
        const next = panels[(to + panels.length) % panels.length]!;
        this.open(next);
        by(`tab-${next}`).focus();
      });
    }
    this.open(panels.find((name) => !by(name).hidden)!);
  }

  open(name: string): void {
    for (const other of this.panels) {
      by(other).hidden = other !== name;
      const tab = by(`tab-${other}`);
      tab.setAttribute("aria-selected", String(other === name));
      tab.tabIndex = other === name ? 0 : -1;
    }
    this.changed(name);
  }
}
