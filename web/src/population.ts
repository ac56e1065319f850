// Turns the table `population` of a run into the series of one of its worlds.
import { numbers, type Columns } from "./film";
import { Series } from "./series";

type Row = Record<string, number>;

const COUNTS = /^(alive|births|deaths|learners|agent_steps|eaten_|energy_)/;
const OF_ONE = /_(sd|q25|median|q75)$/;

/** One row for all species: counts are summed, means are weighted by living agents, measures of the whole world are kept. */
function together(rows: Row[]): Row {
  const out: Row = { ...rows[0]! };
  for (const name of Object.keys(out)) {
    const known = rows.filter((row) => !Number.isNaN(row[name]!));
    const sum = (of: (row: Row) => number) => known.reduce((total, row) => total + of(row), 0);
    if (name.endsWith("_mean")) out[name] = sum((row) => row[name]! * row.alive!) / sum((row) => row.alive!);
    else if (/_(max|min)$/.test(name)) out[name] = Math[name.endsWith("_max") ? "max" : "min"](...known.map((row) => row[name]!));
    else if (OF_ONE.test(name)) out[name] = NaN; // cannot be computed from the values of each species
    else if (COUNTS.test(name)) out[name] = sum((row) => row[name]!);
  }
  return out;
}

/** The values of each species under its name, as in `prey.alive`. */
function apart(rows: Map<string, Row>): Row {
  const named = [...rows].flatMap(([species, row]) => Object.entries(row).map(([name, value]) => [`${species}.${name}`, value] as const));
  return Object.fromEntries(named);
}

export class Population {
  readonly series = new Series();
  private interval = { step: -1, rows: new Map<string, Row>() }; // the last interval, by species

  constructor(
    readonly world: number,
    readonly seed: number,
    readonly run = "", // "" for the run that the page shows
  ) {}

  /** Adds the rows of this world from a part of the table. Parts arrive in order; a part may arrive again with more rows. */
  add(columns: Columns): void {
    const step = numbers(columns, "step");
    const world = numbers(columns, "world");
    const species = columns.species as string[] | undefined;
    const names = Object.keys(columns).filter((name) => columns[name] instanceof Float64Array);
    for (let row = 0; row < step.length; row++) {
      if (world[row] !== this.world || step[row]! < this.interval.step) continue;
      if (step[row]! > this.interval.step) this.interval = { step: step[row]!, rows: new Map() };
      const { rows } = this.interval; // in old runs they may begin in the previous part
      rows.set(species?.[row] ?? "", Object.fromEntries(names.map((name) => [name, numbers(columns, name)[row]!])));
      this.series.rewind(step[row]! - 1);
      this.series.add(step[row]!, rows.size === 1 ? [...rows.values()][0]! : { ...together([...rows.values()]), ...apart(rows) });
    }
  }
}
