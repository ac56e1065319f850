// The marks of the time line as a list of chapters, each of which leads to its moment.
import { by, option, show } from "./element";
import type { Source } from "./source";
import type { Event } from "./types";

export class Chapters {
  private readonly list = by<HTMLSelectElement>("chapters");
  private chapters: Event[] = [];

  constructor(seek: (step: number) => void) {
    this.list.onchange = () => seek(this.chapters[this.list.selectedIndex]!.step);
  }

  /** Lists the marks of a recording and selects the current chapter, except while the user is choosing one. */
  update(source: Source, marks: Event[], now: number): void {
    this.list.hidden = source.live || marks.length === 0; // a live world keeps only its last moments
    if (this.list.hidden || document.activeElement === this.list) return;
    // A mark may precede the first moment, because the population has rows between two frames.
    const chapters = [{ step: source.first, text: "the beginning" }, ...[...marks].sort((a, b) => a.step - b.step)];
    if (JSON.stringify(chapters) !== JSON.stringify(this.chapters)) {
      this.chapters = chapters;
      this.list.replaceChildren(...chapters.map(({ step, text }, i) => option(String(i), `${show(step)}: ${text}`)));
    }
    this.list.selectedIndex = Math.max(chapters.findLastIndex(({ step }) => step <= now), 0);
  }
}
