// How far drift alone takes the mean of a gene: neutral markers of the same species, which mutate like it, show it.
import { columnOf } from "./series";
import type { Source } from "./source";
import type { Species } from "./types";

const RANGE = 1.96; // standard deviations of the neutral genes' means that the band shows on each side

/** Limits at each row of the series; null where they are not known. */
export interface Band {
  low: (number | null)[];
  high: (number | null)[];
}

/** The band of a gene of a species, or why there is none. */
export function drift(source: Source, species: Species, gene: number): Band | string {
  const { layout, series } = source;
  const neutral = species.genes.flatMap((g, i) => (layout.genes[g]!.role === "neutral" ? [{ name: layout.genes[g]!.name, start: species.starts[i]! }] : []));
  if (neutral.length < 2) return "No band: drift needs two neutral genes or more.";
  if (!species.drifts[gene]) return "No band: the neutral genes mutate by another law.";
  const columns = neutral.map(({ name, start }) => ({ start, values: series.get(columnOf(layout, species, `${name}_mean`)) }));
  const start = species.starts[gene]!;
  const band: Band = { low: [], high: [] };
  for (let i = 0; i < series.step.length; i++) {
    const strayed = columns.map((each) => each.values[i]! - each.start).filter(Number.isFinite);
    const limit = strayed.length > 1 ? RANGE * Math.sqrt(strayed.reduce((sum, each) => sum + each * each, 0) / strayed.length) : null;
    band.high.push(limit === null ? null : start + limit);
    band.low.push(limit === null ? null : start - limit);
  }
  return band;
}
