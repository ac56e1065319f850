// The content of a plot of a reward weight's distribution: its quantiles over time, and the density of agents behind them.
import type uPlot from "uplot";
import { element, show, styleColor } from "./element";
import { PARTS, type Distributions, type Quantiles } from "./distribution";
import type { Content } from "./plot";
import type { Key } from "./plotfile";
import type { Source } from "./source";
import type { Gene, Species } from "./types";

const SHOWN = [0.05, 0.25, 0.5, 0.75, 0.95];
const NAMES = ["q05", "q25", "median", "q75", "q95"];
const MEDIAN = 2;
const MARGIN = 0.15; // beyond the outer quantiles, relative to their range
const MOST = 0.9; // maximum opacity, where all agents are alike
const BIN = 4; // pixels of the page
const HALF = 3; // density, relative to an even spread, at which the opacity is half of the maximum

export class Density implements Content {
  readonly height = 190;
  readonly title: string;
  readonly unit: string;
  readonly lines: Key[];
  readonly file: string;
  private quantiles: Quantiles[] = [];
  private readonly heat = element("canvas");
  private drawn = ""; // key of the state that the heat map shows

  constructor(
    private readonly source: Source,
    private readonly species: Species,
    private readonly gene: Gene,
    readonly distributions: Distributions,
  ) {
    const { layout } = source;
    const owner = layout.species.length > 1 ? species.name : "";
    this.title = `${owner ? `${owner}: ` : ""}${gene.title}, distribution`;
    this.unit = gene.unit || "of the living";
    this.lines = [{ label: "median, 25–75 %, 5–95 %", color: "--ink" }];
    this.file = `${owner ? `${owner}-` : ""}${gene.name}_distribution`;
  }

  notes(): Key[] {
    return [this.lines[0]!, { label: "stronger color: more agents", color: this.gene.color }];
  }

  series(): uPlot.Series[] {
    return SHOWN.map((share, i) => ({ label: NAMES[i]!, stroke: () => styleColor("--ink"), width: i === MEDIAN ? 2 : 1, dash: share < 0.25 || share > 0.75 ? [3, 3] : undefined }));
  }

  bands(): uPlot.Band[] {
    return [];
  }

  yRange: uPlot.Range.Function = (_, low, high) => {
    if (low == null) return [0, 1];
    const margin = (high - low) * MARGIN || 0.01;
    return [low - margin, high + margin];
  };

  data(): uPlot.AlignedData {
    const { step } = this.source.series;
    this.quantiles = this.distributions.of(this.source.layout.genes.indexOf(this.gene));
    return [step, ...SHOWN.map((share) => step.map((_, row) => this.quantiles[row]?.[share * PARTS] ?? null))];
  }

  values(row: number): string {
    const limits = this.quantiles[row];
    if (!limits) return "–";
    const [low, lower, median, upper, high] = SHOWN.map((share) => show(limits[share * PARTS], 3));
    return `median ${median}; half of the living ${lower} to ${upper}; 90 % ${low} to ${high}`;
  }

  csv(): string {
    const { source, species, gene } = this;
    const several = source.layout.species.length > 1;
    const table = [["seed", ...(several ? ["species"] : []), "step", ...NAMES.map((name) => `${gene.name}_${name}`)].join(",")];
    source.series.step.forEach((step, row) => {
      const values = SHOWN.map((share) => this.quantiles[row]?.[share * PARTS] ?? "");
      table.push([source.seed, ...(several ? [species.name] : []), step, ...values].join(","));
    });
    return table.join("\n") + "\n";
  }

  empty(): string {
    if (!this.source.loaded) return "The records are being read.";
    if (this.quantiles.length === 0 || this.quantiles.some((each) => each)) return "";
    return "The lives of some of the living are not known.";
  }

  /** Shades each moment by the density of agents at a value: after a split there is a pale gap between two dark stripes. */
  under(chart: uPlot): void {
    const { left, top, width, height } = chart.bbox;
    const { x, y } = chart.scales as { x: uPlot.Scale; y: uPlot.Scale };
    const steps = chart.data[0] as number[];
    if (this.quantiles.length === 0 || width < 1 || height < 1) return;
    const key = [this.quantiles.length, steps[steps.length - 1], this.source.lives.size, x.min, x.max, y.min, y.max, width, height].join();
    if (key !== this.drawn) {
      this.drawn = key;
      [this.heat.width, this.heat.height] = [Math.round(width), Math.round(height)];
      this.shade(chart, steps);
    }
    chart.ctx.drawImage(this.heat, left, top);
  }

  private shade(chart: uPlot, steps: number[]): void {
    const pen = this.heat.getContext("2d")!;
    const { left, width, height } = chart.bbox;
    const { min, max } = chart.scales.y as { min: number; max: number };
    pen.fillStyle = this.gene.color;
    const edge = (row: number) => Math.round(chart.valToPos((steps[Math.max(row - 1, 0)]! + steps[Math.min(row, steps.length - 1)]!) / 2, "x", true) - left);
    const bins = Math.max(Math.round(height / (BIN * devicePixelRatio)), 1);
    const tall = height / bins;
    let from = -Infinity; // pixel up to which it is shaded; the first of several rows within a pixel wins
    for (let row = 0; row < this.quantiles.length; row++) {
      const [start, end] = [Math.max(edge(row), from), edge(row + 1)];
      const limits = this.quantiles[row];
      if (end <= start || end < 0 || start > width) continue;
      from = end;
      if (!limits) continue;
      shares(limits, min, max, bins).forEach((share, bin) => {
        const crowding = share * bins; // density relative to an even spread over the plot
        pen.globalAlpha = (MOST * crowding) / (crowding + HALF);
        if (crowding > 0) pen.fillRect(start, height - (bin + 1) * tall, end - start, tall);
      });
    }
  }
}

/** The share of agents in each of `bins` bins from `min` to `max`, assuming an even spread between adjacent quantiles. */
function shares(limits: Float64Array, min: number, max: number, bins: number): Float64Array {
  const counts = new Float64Array(bins);
  const at = (value: number) => ((value - min) / (max - min)) * bins;
  for (let k = 0; k < PARTS; k++) {
    const [low, high] = [at(limits[k]!), at(limits[k + 1]!)];
    for (let bin = Math.max(Math.floor(low), 0); bin < Math.min(Math.floor(high) + 1, bins); bin++) {
      counts[bin]! += (high > low ? (Math.min(high, bin + 1) - Math.max(low, bin)) / (high - low) : 1) / PARTS;
    }
  }
  return counts;
}
