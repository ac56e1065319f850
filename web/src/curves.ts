// The content of a plot of columns of the series: their lines, the drift band and, optionally, a running mean and the other seeds.
import type uPlot from "uplot";
import { quoted } from "./csv";
import type { Band } from "./drift";
import { show } from "./element";
import { SAMPLE_STEPS } from "./live";
import type { Content } from "./plot";
import type { Key } from "./plotfile";
import type { Series } from "./series";
import { smooth, type Values } from "./smooth";
import type { Source } from "./source";

const HEIGHT = 140;
const TALL = 190; // of a plot of a reward weight
const RAW = "4d"; // opacity of the raw values behind their running mean
const OTHER = "b3"; // opacity of the lines of the other seeds
const DASHES: [name: string, dash: number[]][] = [["dashed", [7, 4]], ["dotted", [2, 3]], ["dash-dotted", [8, 3, 2, 3]]]; // of further runs

export interface Line extends Key {
  name: string; // in the series
  column: string; // in the table `population`
  species: string; // "" for a measure of the whole world
}

/** What is drawn in addition to the values themselves. */
export interface Choice {
  window: number; // rows of the running mean
  seeds: boolean;
}

type Drawn = (number | null | undefined)[]; // undefined where a seed has no row; its line bridges the gap

export class Curves implements Content {
  readonly height: number;
  private table: uPlot.AlignedData = [[]];

  constructor(
    private readonly source: Source,
    private readonly choice: Choice,
    readonly title: string,
    readonly unit: string,
    readonly lines: Line[],
    private readonly band?: () => Band | string,
  ) {
    this.height = band ? TALL : HEIGHT;
  }

  get file(): string {
    const { lines } = this;
    const species = lines.length === 1 && this.source.layout.species.length > 1 ? `${lines[0]!.species}-` : "";
    return species + (lines.every(({ column }) => column === lines[0]!.column) ? lines[0]!.column : lines[0]!.column.split("_")[0]!);
  }

  notes(): Key[] {
    const { choice, others } = this;
    const notes: Key[] = [];
    if (typeof this.band?.() === "object") notes.push({ label: "gray: 95 % of neutral genes (drift)", color: "--quiet" });
    if (choice.window > 1) notes.push({ label: `line: mean of ${choice.window} rows; faint: each row`, color: "--quiet" });
    const seeds = (run: string) => others.filter((each) => each.run === run).map(({ seed }) => seed).join(", ");
    if (seeds("")) notes.push({ label: `thin: seeds ${seeds("")}; thick: seed ${this.source.seed}`, color: "--quiet" });
    this.source.runs.forEach(({ run }, i) => {
      if (!seeds(run)) return; // not drawn, or not read yet
      const known = others.some((each) => each.run === run && this.lines.some(({ name }) => each.series.get(name).length > 0));
      notes.push({ label: known ? `${dashOf(i)[0]}: ${run}, seeds ${seeds(run)}` : `${run} has no such values`, color: "--quiet" });
    });
    return notes;
  }

  series(): uPlot.Series[] {
    const { lines } = this;
    const order = this.source.runs.map(({ run }) => run);
    const others = this.others.flatMap(({ run }) => {
      const dash = run ? dashOf(order.indexOf(run))[1] : undefined;
      return lines.map(({ color }): uPlot.Series => ({ stroke: color + OTHER, width: dash ? 2 : 1, dash }));
    });
    const raw = this.smoothed ? lines.map(({ color }): uPlot.Series => ({ stroke: color + RAW, width: 2 })) : [];
    const main = lines.map(({ label, color }): uPlot.Series => ({ label, stroke: color, width: 2 }));
    const limits = this.band ? ["drift, high", "drift, low"].map((label): uPlot.Series => ({ label, stroke: "#8889", dash: [4, 4] })) : [];
    return [...others, ...raw, ...main, ...limits];
  }

  bands(): uPlot.Band[] {
    if (!this.band) return [];
    const last = this.series().length;
    return [{ series: [last - 1, last], fill: "#8883" }];
  }

  data(): uPlot.AlignedData {
    const { source, lines, others, choice } = this;
    const { series } = source;
    const step = others.length > 0 ? [...new Set([series, ...others.map((each) => each.series)].flatMap((each) => each.step))].sort((a, b) => a - b) : series.step;
    const rows = new Map(step.map((each, i) => [each, i]));
    const place = (from: Series, values: Values): Drawn => {
      if (from.step.length === step.length) return values;
      const out = new Array<number | null | undefined>(step.length).fill(undefined);
      from.step.forEach((each, i) => (out[rows.get(each)!] = values[i]));
      return out;
    };
    const columns = lines.map(({ name }) => fitted(series, name));
    const band = this.band?.();
    const nothing = series.step.map(() => null);
    const limits = this.band ? (typeof band === "object" ? [band.high, band.low] : [nothing, nothing]) : [];
    this.table = [
      step,
      ...others.flatMap((each) => lines.map(({ name }) => place(each.series, smooth(fitted(each.series, name), choice.window)))),
      ...(this.smoothed ? columns.map((values) => place(series, values)) : []),
      ...columns.map((values) => place(series, smooth(values, choice.window))),
      ...limits.map((values) => place(series, values)),
    ];
    return this.table;
  }

  values(row: number): string {
    const { lines, table, others } = this;
    const first = 1 + others.length * lines.length; // column of the first line of the seed shown
    const smoothed = this.smoothed ? lines.length : 0;
    const texts = lines.map(({ label }, i) => {
      const notes: string[] = [];
      if (smoothed) notes.push(`smoothed ${show(table[first + smoothed + i]![row] ?? undefined, 3)}`);
      for (const run of new Set(others.map((each) => each.run))) {
        const elsewhere = others.flatMap((each, k) => (each.run === run ? (table[1 + k * lines.length + i]![row] ?? []) : []));
        const [low, high] = [Math.min(...elsewhere), Math.max(...elsewhere)];
        if (elsewhere.length === 1) notes.push(`${run || "other seed"} ${show(low, 3)}`);
        else if (elsewhere.length > 1) notes.push(`${run || "other seeds"} ${show(low, 3)} to ${show(high, 3)}`);
      }
      const value = show(table[first + i]![row] ?? undefined, 3);
      return `${lines.length > 1 ? `${label} ` : ""}${value}${notes.length > 0 ? ` (${notes.join("; ")})` : ""}`;
    });
    const [high, low] = this.band ? [table[table.length - 2]![row], table[table.length - 1]![row]] : [];
    return texts.join(", ") + (high != null && low != null ? `; drift ${show(low, 3)} to ${show(high, 3)}` : "");
  }

  /** The values as they are in the table `population`, whatever is drawn of them. */
  csv(): string {
    const { source, lines, others } = this;
    const named = source.layout.species.length > 1 && lines.some(({ species }) => species !== "");
    const groups = named ? lines.map((line) => [line]) : [lines];
    const band = this.band?.();
    const limits = typeof band === "object" ? [band.low, band.high] : [];
    const runs = source.runs.length > 0; // a column tells them apart
    const header = [...(runs ? ["run"] : []), "seed", ...(named ? ["species"] : []), "step", ...groups[0]!.map(({ column }) => column), ...(limits.length > 0 ? ["drift_low", "drift_high"] : [])];
    const table = [header.join(",")];
    for (const { run, seed, series } of [{ run: "", seed: source.seed, series: source.series }, ...others]) {
      for (const group of groups) {
        const columns = group.map(({ name }) => fitted(series, name));
        const drift = limits.map((values) => (series === source.series ? values : []));
        series.step.forEach((step, i) => {
          const values = [...columns, ...drift].map((column) => column[i] ?? "");
          table.push([...(runs ? [quoted(run || source.title)] : []), seed, ...(named ? [group[0]!.species] : []), step, ...values].join(","));
        });
      }
    }
    return table.join("\n") + "\n";
  }

  empty(): string {
    if (this.table[0].length > 1) return "";
    return this.source.live ? `Fills from step ${show(2 * SAMPLE_STEPS)} on: a point each ${SAMPLE_STEPS} steps.` : "Fills with the second row of the table population.";
  }

  private get smoothed(): boolean {
    return this.choice.window > 1;
  }

  private get others(): Source["others"] {
    return this.choice.seeds ? this.source.others : [];
  }
}

/** The name and pattern of the lines of a further run. */
export const dashOf = (run: number) => DASHES[run % DASHES.length]!;

/** A column of the series, one value per row; null where it is not known. */
function fitted(series: Series, name: string): Values {
  const column = series.get(name);
  return series.step.map((_, i) => (Number.isFinite(column[i]) ? column[i]! : null));
}
