// The picked agents: those living agents that match the filter and are inside the rectangle of the scatter plot, if any.
import { brush } from "./brush";
import { type Filter, parseFilter } from "./filter";
import { type Measure, measures } from "./measure";
import type { Source } from "./source";
import type { Frame } from "./types";

export class Selection {
  measures: Measure[] = [];
  text = "";
  problem = ""; // what is wrong with the filter
  private filter: Filter | undefined;
  private source!: Source;

  constructor(changed: () => void) {
    brush.changed = changed;
  }

  /** Switches to another source, whose agents may have other measures. */
  open(source: Source): void {
    this.source = source;
    this.measures = measures(source);
    brush.clear();
    this.write(this.text);
  }

  get active(): boolean {
    return this.filter !== undefined || brush.active;
  }

  /** Sets the text of the filter; an empty or invalid filter matches all agents. */
  write(text: string): void {
    this.text = text;
    const filter = text.trim() === "" ? undefined : parseFilter(text, this.measures);
    this.problem = typeof filter === "string" ? filter : "";
    this.filter = typeof filter === "string" ? undefined : filter;
  }

  /** The indices of the picked agents in a frame: all of them if nothing is selected. */
  of(frame: Frame): number[] {
    const all = Array.from(frame.id, (_, i) => i);
    if (!this.active) return all;
    return all.filter((i) => {
      const life = this.source.lives.get(frame.id[i]!);
      if (brush.active && !brush.holds(life)) return false;
      return this.filter?.((measure) => measure.value(life, frame, i)) ?? this.filter === undefined;
    });
  }
}
