// Measures of a world over time, as columns, in the order of steps.
import type { Layout, Species } from "./types";

/** The name of a species' column; the only species of a world uses the columns of the world. */
export function columnOf(layout: Layout, species: Species, name: string): string {
  return layout.species.length > 1 ? `${species.name}.${name}` : name;
}

export class Series {
  readonly step: number[] = [];
  private readonly columns = new Map<string, number[]>();

  /** Adds a row if its step is after the last one. */
  add(step: number, row: Record<string, number>): void {
    if (this.step.length > 0 && step <= this.step[this.step.length - 1]!) return;
    for (const [name, value] of Object.entries(row)) {
      let column = this.columns.get(name);
      if (!column) this.columns.set(name, (column = new Array<number>(this.step.length).fill(NaN)));
      column.push(value);
    }
    this.step.push(step);
  }

  /** Forgets the rows after a step. */
  rewind(step: number): void {
    const kept = this.step.findLastIndex((each) => each <= step) + 1;
    this.step.length = kept;
    for (const column of this.columns.values()) column.length = Math.min(column.length, kept);
  }

  get(name: string): number[] {
    return this.columns.get(name) ?? [];
  }
}
