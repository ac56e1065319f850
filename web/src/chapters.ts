// The marks of the time line by name: a list of chapters, each of which leads to its moment.
import { by, option, show } from "./element";
import type { Source } from "./source";
import type { Event } from "./types";

export class Chapters {
  private readonly list = by<HTMLSelectElement>("chapters");
  private chapters: Event[] = [];

  constructor(seek: (step: number) => void) {
    this.list.onchange = () => seek(this.chapters[this.list.selectedIndex]!.step);
  }

  /** Lists what records have marks of, and selects the chapter of the moment; not while somebody chooses. */
  update(source: Source, marks: Event[], now: number): void {
    this.list.hidden = source.live || marks.length === 0; // a live world keeps its last moments alone
    if (this.list.hidden || document.activeElement === this.list) return;
    // A mark may stand before the first moment: the population has rows between two frames.
    const found = [{ step: source.first, text: "the beginning" }, ...[...marks].sort((a, b) => a.step - b.step)];
    if (JSON.stringify(found) !== JSON.stringify(this.chapters)) {
      this.chapters = found;
      this.list.replaceChildren(...found.map(({ step, text }, i) => option(String(i), `${show(step)}: ${text}`)));
    }
    this.list.selectedIndex = Math.max(found.findLastIndex(({ step }) => step <= now), 0);
  }
}
