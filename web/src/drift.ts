// The range of a gene's mean under drift only: simulates neutral genes with the same law down the pedigree of the living.
import { show } from "./element";
import { columnOf, type Series } from "./series";
import type { Lives } from "./lives";
import type { Source } from "./source";
import type { GeneLaw, Life, Species } from "./types";

const WALKS = 400; // simulated neutral genes for each law
const OUTER = 0.025; // share of them beyond each limit of the band
const MOST_LIVES = 200_000; // that are simulated: a few seconds of work
const ENOUGH = 8; // recorded neutral genes needed for a band
const RANGE = 1.96; // half width of that band, in standard deviations of their means
const SEED = 20240717;

/** The limits at each row of the series; null where they are not known. */
export interface Band {
  low: (number | null)[];
  high: (number | null)[];
}

/** Pseudorandom numbers from 0 to 1, the same on every page load: mulberry32. */
function generator(seed: number): () => number {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let mixed = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    mixed = (mixed + Math.imul(mixed ^ (mixed >>> 7), 61 | mixed)) ^ mixed;
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
  };
}

const normal = (uniform: () => number): number => Math.sqrt(-2 * Math.log(1 - uniform())) * Math.cos(2 * Math.PI * uniform());

/** Draws the noise of a birth, at scale 1. Student's t uses Bailey's method (1994). */
function noise({ law, df }: GeneLaw, uniform: () => number): number {
  if (law === "normal") return normal(uniform);
  if (law === "uniform") return 2 * uniform() - 1;
  if (law === "cauchy") return Math.tan(Math.PI * (uniform() - 0.5));
  return Math.sqrt(df * ((1 - uniform()) ** (-2 / df) - 1)) * Math.cos(2 * Math.PI * uniform());
}

/** Neutral genes with one law in one species, up to the end of the series. Parents are alive when their children are born, so only the living are kept. */
class Walks {
  readonly band: Band = { low: [], high: [] };
  private readonly genes = new Map<number, Float32Array>(); // of the living, by agent
  private readonly sums = new Float64Array(WALKS);
  private readonly uniform = generator(SEED);
  private done = -1; // step
  private torn = false; // whether some agent's parent is not known
  readonly size: number; // lives that were known at the beginning
  readonly rewinds: number;

  constructor(
    private readonly law: GeneLaw,
    private readonly species: number,
    lives: Lives,
  ) {
    [this.size, this.rewinds] = [lives.size, lives.rewinds];
  }

  /** Continues to the end of the series; the law changes after the step `until`. */
  advance(lives: Lives, series: Series, alive: number[], until: number): void {
    const first = this.band.low.length;
    if (first >= series.step.length) return;
    const since = [...lives.all()].filter((life) => life.species === this.species && (life.birth > this.done || life.death > this.done));
    const births = since.filter((life) => life.birth > this.done).sort((a, b) => a.birth - b.birth || a.id - b.id);
    const deaths = since.filter((life) => life.death > this.done).sort((a, b) => a.death - b.death);
    let [born, dead] = [0, 0];
    for (let row = first; row < series.step.length; row++) {
      const step = series.step[row]!;
      while (born < births.length && births[born]!.birth <= step) this.bear(births[born++]!);
      while (dead < deaths.length && deaths[dead]!.death <= step) this.bury(deaths[dead++]!.id);
      this.done = step;
      const known = !this.torn && step <= until && this.genes.size > 0 && this.genes.size === alive[row];
      const means = known ? this.sums.map((sum) => sum / this.genes.size).sort() : undefined;
      this.band.low.push(means ? quantile(means, OUTER) : null);
      this.band.high.push(means ? quantile(means, 1 - OUTER) : null);
    }
  }

  private bear(life: Life): void {
    const { law, uniform } = this;
    const parent = this.genes.get(life.parent);
    this.torn ||= parent ? false : life.parent >= 0 || life.birth > 0;
    const genes = new Float32Array(WALKS);
    for (let i = 0; i < WALKS; i++) {
      const value = parent ? parent[i]! + (uniform() < law.probability ? law.scale * noise(law, uniform) : 0) : law.mean + law.sd * normal(uniform);
      genes[i] = Math.min(Math.max(value, -law.limit), law.limit);
      this.sums[i]! += genes[i]!;
    }
    this.genes.set(life.id, genes);
  }

  private bury(id: number): void {
    this.genes.get(id)?.forEach((gene, i) => (this.sums[i]! -= gene));
    this.genes.delete(id);
  }
}

/** A quantile of sorted values, with linear interpolation. */
function quantile(sorted: Float64Array, share: number): number {
  const at = share * (sorted.length - 1);
  const below = Math.floor(at);
  return sorted[below]! + (at - below) * (sorted[Math.min(below + 1, sorted.length - 1)]! - sorted[below]!);
}

const walked = new WeakMap<Source, Map<string, Walks>>();

/** The drift band of a gene of a species, or the reason why there is none. */
export function drift(source: Source, species: Species, gene: number): Band | string {
  const { layout, lives, series } = source;
  if (layout.founders) return "No band: the founders come from a table.";
  if (species.mating === "pairs") return recorded(source, species, gene) ?? "No band: children have two parents, and the neutral genes have another law.";
  if (layout.mutation_noise === "tabulated") return recorded(source, species, gene) ?? "No band: births share their noise, and the neutral genes have another law.";
  if (!source.loaded) return "No band yet: the records are being read.";
  if (lives.size > MOST_LIVES) return `No band: more than ${show(MOST_LIVES)} agents. The figures of hedon report have it.`;
  const law = species.laws[gene]!;
  const known = walked.get(source) ?? new Map<string, Walks>();
  walked.set(source, known);
  const key = `${layout.species.indexOf(species)} ${JSON.stringify(law)}`;
  let walks = known.get(key);
  const stale = (each: Walks) => each.rewinds !== lives.rewinds || (!source.live && each.size !== lives.size) || each.band.low.length > series.step.length;
  if (!walks || stale(walks)) known.set(key, (walks = new Walks(law, layout.species.indexOf(species), lives)));
  walks.advance(lives, series, series.get(columnOf(layout, species, "alive")), source.relawed);
  const empty = lives.size > 0 && walks.band.low.length > 0 && walks.band.low.every((each) => each === null);
  return empty ? (recorded(source, species, gene) ?? "No band: the parents of some agents are not known.") : walks.band;
}

/** The band from recorded neutral genes, if enough of them have the same initial law and mutation as the gene. */
function recorded({ layout, series }: Source, species: Species, gene: number): Band | undefined {
  const law = JSON.stringify(species.laws[gene]);
  const alike = species.genes.filter((g, i) => layout.genes[g]!.role === "neutral" && JSON.stringify(species.laws[i]) === law);
  if (alike.length < ENOUGH) return undefined;
  const columns = alike.map((g) => series.get(columnOf(layout, species, `${layout.genes[g]!.name}_mean`)));
  const start = species.laws[gene]!.mean;
  const limits = series.step.map((_, i) => {
    const strayed = columns.map((column) => column[i]! - start).filter(Number.isFinite);
    return strayed.length > 0 ? RANGE * Math.sqrt(strayed.reduce((sum, each) => sum + each * each, 0) / strayed.length) : null;
  });
  return { low: limits.map((limit) => limit && start - limit), high: limits.map((limit) => limit && start + limit) };
}
