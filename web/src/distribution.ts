// The distribution of genes among the living at each row of the series, computed from the births and deaths of all lives.
import type { Lives } from "./lives";
import { columnOf, type Series } from "./series";
import type { Source } from "./source";
import type { Life, Species } from "./types";

export const PARTS = 40; // with equal numbers of agents; their limits are the quantiles
const WORK_MS = 25; // between two pictures

/** The limits of the parts, ascending; undefined if some of the living are not known. */
export type Quantiles = Float64Array | undefined;

/** A quantile of sorted values, with linear interpolation. */
function quantile(sorted: Float64Array, share: number): number {
  const at = share * (sorted.length - 1);
  const below = Math.floor(at);
  return sorted[below]! + (at - below) * (sorted[Math.min(below + 1, sorted.length - 1)]! - sorted[below]!);
}

/** The quantiles of some genes of one species, over the rows processed so far. */
class Course {
  readonly quantiles: Quantiles[][]; // [gene][row]
  rows = 0;
  readonly size: number; // lives known at the start
  readonly rewinds: number;
  private readonly living = new Map<number, Life>();
  private births: Life[] = [];
  private deaths: Life[] = [];
  private queued = 0; // rows that the queues of births and deaths cover
  private done = -1; // step

  constructor(
    private readonly species: number,
    private readonly genes: number[],
    lives: Lives,
  ) {
    [this.size, this.rewinds] = [lives.size, lives.rewinds];
    this.quantiles = genes.map(() => []);
  }

  advance(lives: Lives, series: Series, alive: number[]): void {
    const { step } = series;
    if (this.rows < step.length && this.queued !== step.length) this.queue(lives, step.length);
    const end = performance.now() + WORK_MS;
    while (this.rows < step.length && performance.now() < end) this.add(step[this.rows]!, alive[this.rows]!);
  }

  private queue(lives: Lives, rows: number): void {
    const { species, done } = this;
    const since = [...lives.all()].filter((life) => life.species === species && (life.birth > done || life.death > done));
    // In descending order, since they are taken from the end.
    this.births = since.filter((life) => life.birth > done).sort((a, b) => b.birth - a.birth);
    this.deaths = since.filter((life) => life.death > done).sort((a, b) => b.death - a.death);
    this.queued = rows;
  }

  private add(step: number, alive: number): void {
    const { births, deaths, living } = this;
    for (let life = births[births.length - 1]; life && life.birth <= step; life = births[births.length - 1]) living.set(life.id, births.pop()!);
    for (let life = deaths[deaths.length - 1]; life && life.death <= step; life = deaths[deaths.length - 1]) living.delete(deaths.pop()!.id);
    const known = living.size > 0 && living.size === alive;
    this.genes.forEach((gene, i) => {
      if (!known) return void this.quantiles[i]!.push(undefined);
      const sorted = Float64Array.from(living.values(), (life) => life.genome[gene]!).sort();
      this.quantiles[i]!.push(Float64Array.from({ length: PARTS + 1 }, (_, k) => quantile(sorted, k / PARTS)));
    });
    this.done = step;
    this.rows++;
  }
}

/** The distributions of a species. The old ones are shown while new ones are computed from lives that have become known. */
export class Distributions {
  private shown: Course | undefined;
  private made: Course | undefined;
  private readonly genes: number[];

  constructor(
    private readonly source: Source,
    private readonly species: Species,
  ) {
    this.genes = species.genes.filter((g) => source.layout.genes[g]!.role === "reward");
  }

  /** Works for a moment; returns whether the distributions have changed. */
  advance(): boolean {
    const { source, species } = this;
    const { layout, lives, series } = source;
    if (!source.loaded) return false;
    const gone = (each: Course | undefined) => each && (each.rewinds !== lives.rewinds || each.rows > series.step.length);
    if (gone(this.shown) || gone(this.made)) this.shown = this.made = undefined;
    const stale = !this.shown || (!source.live && this.shown.size !== lives.size);
    if (!this.made && stale) this.made = new Course(layout.species.indexOf(species), this.genes, lives);
    const course = this.made ?? this.shown!;
    const before = course.rows;
    course.advance(lives, series, series.get(columnOf(layout, species, "alive")));
    if (course === this.made && course.rows === series.step.length) [this.shown, this.made] = [course, undefined];
    return course.rows !== before;
  }

  /** The quantiles of a gene of the layout, row by row. */
  of(gene: number): Quantiles[] {
    return (this.shown ?? this.made)?.quantiles[this.genes.indexOf(gene)] ?? [];
  }
}
