// The plots beside the world, in step with the time line; the page draws nothing that the layout does not name.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { drift, type Band } from "./drift";
import { by, element, show, styleColor } from "./element";
import { SAMPLE_STEPS } from "./live";
import { LivingPlots } from "./living";
import { columnOf } from "./series";
import type { Source } from "./source";
import type { Frame, Species } from "./types";

const HEIGHT = 140;
const TALL = 190; // of a plot of a weight

interface Line {
  name: string; // column
  label: string;
  color: string;
}

interface Plot {
  chart: uPlot;
  height: number;
  data: () => uPlot.AlignedData;
  empty: HTMLElement; // what is said while there is nothing to see
  judge?: (at: number) => void;
}

export class Plots {
  private plots: Plot[] = [];
  private points = -1;
  private known = 0; // lives of a replay that the bands are of
  private theme = "";
  private now = 0;
  private readonly living: LivingPlots;
  private readonly host = by<HTMLDivElement>("plots");

  constructor(
    private readonly source: Source,
    private readonly seek: (step: number) => void,
  ) {
    const { layout } = source;
    this.host.replaceChildren(element("h2", { text: "Plots", class: "unseen" }));
    this.theme = styleColor("--quiet");
    for (const species of layout.species) this.addWeights(species);
    const each = (name: string): Line[] => layout.species.map((species) => ({ name: columnOf(layout, species, name), label: species.name, color: species.color }));
    const foods = (what: string): Line[] => layout.foods.map((food) => ({ name: `${what}_${food.name}`, label: food.name, color: food.color }));
    this.add("agents alive", "agents", each("alive"));
    this.add("mean energy", "energy", each("energy_mean"));
    this.add("food present", "pieces", foods("food"));
    if (!source.live) this.add("food eaten since the row before", "pieces", foods("eaten"));
    this.living = new LivingPlots(source);
    this.host.append(...this.living.parts);
  }

  update(frame: Frame | undefined, now: number): void {
    this.now = now;
    if (this.host.hidden) return;
    const { step } = this.source.series;
    const theme = styleColor("--quiet");
    const { lives, live, loaded } = this.source;
    const known = live || !loaded ? 0 : lives.size; // a replay reads lives after the series, and its bands need them
    const grown = step.length !== this.points || known !== this.known || theme !== this.theme;
    [this.points, this.known, this.theme] = [step.length, known, theme];
    const width = Math.max(this.host.clientWidth - 28, 100);
    const at = step.findLastIndex((each) => each <= now);
    for (const { chart, height, data, empty, judge } of this.plots) {
      if (chart.width !== width) chart.setSize({ width, height });
      if (grown) chart.setData(data());
      else chart.redraw(false);
      empty.hidden = step.length > 1;
      empty.textContent = this.source.live ? `Fills from step ${show(2 * SAMPLE_STEPS)} on: a point each ${SAMPLE_STEPS} steps.` : "Fills with the second row of the table population.";
      judge?.(at);
    }
    if (frame) this.living.draw(frame);
  }

  /** A plot for each weight of the reward, with the band of drift and what it says. */
  private addWeights(species: Species): void {
    const { layout, series } = this.source;
    const owner = layout.species.length > 1 ? `${species.name}: ` : "";
    species.genes.forEach((g, i) => {
      const gene = layout.genes[g]!;
      if (gene.role === "neutral") return;
      const name = columnOf(layout, species, `${gene.name}_mean`);
      const said = element("span", { class: "verdict" });
      const unit = gene.unit ? `${gene.unit}, mean of the living` : "mean of the living";
      const plot = this.add(`${owner}${gene.title}`, unit, [{ name, label: gene.title, color: gene.color }], () => drift(this.source, species, i), said);
      plot.judge = (at) => {
        const band = drift(this.source, species, i);
        const value = series.get(name)[at];
        said.textContent = typeof band === "string" ? band : judged(value, band, at);
        said.dataset.outside = String(typeof band !== "string" && outside(value, band, at));
      };
    });
  }

  private add(title: string, unit: string, lines: Line[], band?: () => Band | string, verdict?: HTMLElement): Plot {
    const { series } = this.source;
    const banded = band !== undefined;
    const data = () => {
      const columns = lines.map(({ name }) => fitted(series.get(name), series.step.length));
      const limits = band?.();
      const nothing = series.step.map(() => null);
      const { high, low } = typeof limits === "object" ? limits : { high: nothing, low: nothing };
      return [series.step, ...columns, ...(banded ? [high, low] : [])] as uPlot.AlignedData;
    };
    const drawn: uPlot.Series[] = lines.map(({ label, color }) => ({ label, stroke: color, width: 2, points: { show: false } }));
    if (banded) for (const label of ["drift, high", "drift, low"]) drawn.push({ label, stroke: "#8889", dash: [4, 4], points: { show: false } });
    const axis: uPlot.Axis = { stroke: () => styleColor("--quiet"), grid: { stroke: "#8882", width: 1 }, ticks: { show: false }, size: 52, font: "12px system-ui, sans-serif", labelFont: "12px system-ui, sans-serif" };
    const height = band ? TALL : HEIGHT;
    const options: uPlot.Options = {
      width: 300,
      height,
      legend: { show: false },
      cursor: { sync: { key: "time" }, y: false },
      scales: { x: { time: false } },
      series: [{ label: "step" }, ...drawn],
      bands: banded ? [{ series: [lines.length + 1, lines.length + 2], fill: "#8883" }] : [],
      axes: [{ ...axis, size: 30, label: "step", labelSize: 16 }, axis],
      hooks: { draw: [(chart) => this.markNow(chart)] },
    };
    const heading = element("h3", { class: "plot-title" }, `${title} [${unit}]`);
    if (lines.length > 1) heading.append(...key(lines).flatMap((each) => [" ", each]));
    const empty = element("p", { class: "empty" });
    const frame = element("div", { class: "plot" }, empty);
    this.host.append(heading, ...(verdict ? [verdict] : []), frame);
    const chart = new uPlot(options, data(), frame);
    chart.over.addEventListener("click", () => {
      const step = chart.posToVal(chart.cursor.left ?? -1, "x");
      if (Number.isFinite(step)) this.seek(step);
    });
    const plot: Plot = { chart, height, data, empty };
    this.plots.push(plot);
    return plot;
  }

  private markNow(chart: uPlot): void {
    const x = chart.valToPos(this.now, "x", true);
    const { left, width } = chart.bbox;
    if (!(x >= left && x <= left + width)) return; // it would cover the labels of the axis
    chart.ctx.fillStyle = styleColor("--mark");
    chart.ctx.fillRect(x - 1, chart.bbox.top, 2, chart.bbox.height);
  }
}

const outside = (value: number | undefined, { low, high }: Band, at: number): boolean => value !== undefined && at >= 0 && low[at] != null && (value < low[at]! || value > high[at]!);

function judged(value: number | undefined, band: Band, at: number): string {
  if (value === undefined || at < 0 || Number.isNaN(value) || band.low[at] == null) return "";
  const range = `${show(band.low[at]!, 3)} to ${show(band.high[at]!, 3)}`;
  return `${show(value, 3)}: ${outside(value, band, at) ? "outside" : "within"} drift (${range})`;
}

function key(lines: Line[]): HTMLElement[] {
  return lines.map(({ label, color }) => {
    const dot = element("b", { text: "●" });
    dot.style.color = color;
    return element("span", {}, dot, ` ${label}`);
  });
}

function fitted(column: number[], length: number): (number | null)[] {
  return Array.from({ length }, (_, i) => (Number.isFinite(column[i]) ? column[i]! : null));
}
