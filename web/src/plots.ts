// The plots beside the world, in step with the time line; the page draws nothing that the layout does not name.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { by, element, option, show, styleColor } from "./element";
import { columnOf } from "./series";
import type { Source } from "./source";
import type { Frame } from "./types";

const HEIGHT = 130;
const LINES = ["#0072b2", "#d55e00", "#009e73", "#e69f00", "#cc79a7", "#56b4e9", "#5e4fa2", "#999933"];
const GENES = { reward: "mean weights", learning: "mean genes of learning", rule: "mean genes of rules" }; // by role
const RANGE = 1.96; // standard deviations of the neutral genes' means that the band shows on each side

interface Plot {
  chart: uPlot;
  data: () => uPlot.AlignedData;
}

export class Plots {
  private plots: Plot[] = [];
  private points = 0;
  private readonly scatter = element("canvas", { class: "small" });
  private readonly ages = element("canvas", { class: "small" });
  private readonly axes = [element("select"), element("select")] as const;
  private now = 0;

  constructor(
    private readonly source: Source,
    seek: (step: number) => void,
  ) {
    const { layout, series } = source;
    const host = by<HTMLDivElement>("plots");
    host.replaceChildren();
    const add = (title: string, names: string[], labels: string[], colors: string[], neutral: string[] = []) =>
      this.add(host, title, names, labels, colors, neutral, seek);
    const several = layout.species.length > 1;
    const each = (name: string) => layout.species.map((species) => columnOf(layout, species, name));
    const kinds = layout.species.map((species) => species.name);
    add("agents alive", each("alive"), kinds, LINES);
    add("mean energy", each("energy_mean"), kinds, several ? LINES : [LINES[3]!]);
    for (const species of layout.species) {
      const genes = (role: string) => species.genes.map((g) => layout.genes[g]!).filter((gene) => gene.role === role);
      const means = (role: string) => genes(role).map((gene) => columnOf(layout, species, `${gene.name}_mean`));
      for (const [role, title] of Object.entries(GENES)) {
        if (genes(role).length === 0) continue;
        const whose = `${title}${several ? ` of ${species.name}` : ""}, and the band of the neutral genes`;
        add(whose, means(role), genes(role).map((gene) => gene.name), LINES, means("neutral"));
      }
    }
    add("food present", layout.foods.map((food) => `food_${food.name}`), layout.foods.map((food) => food.name), layout.foods.map((food) => food.color));
    if (series.get(`eaten_${layout.foods[0]?.name}`).length > 0) {
      add("food eaten", layout.foods.map((food) => `eaten_${food.name}`), layout.foods.map((food) => food.name), layout.foods.map((food) => food.color));
    }
    host.append(element("h3", { text: "ages of the living" }), this.ages);
    layout.genes.forEach((gene, g) => this.axes.forEach((axis) => axis.append(option(String(g), gene.name))));
    this.axes[1].value = String(Math.min(1, layout.genes.length - 1));
    const pair = element("h3", { text: "genes of the living: " });
    pair.append(this.axes[0], " and ", this.axes[1]);
    host.append(pair, this.scatter);
  }

  update(frame: Frame | undefined, now: number): void {
    this.now = now;
    if (by("plots").hidden) return;
    const grown = this.source.series.step.length !== this.points;
    this.points = this.source.series.step.length;
    const width = Math.max(by("plots").clientWidth - 16, 100);
    for (const { chart, data } of this.plots) {
      if (chart.width !== width) chart.setSize({ width, height: HEIGHT });
      if (grown) chart.setData(data());
      else chart.redraw(false);
    }
    if (frame) this.drawLiving(frame);
  }

  private add(host: HTMLElement, title: string, names: string[], labels: string[], colors: string[], neutral: string[], seek: (step: number) => void): void {
    const { series } = this.source;
    const withBand = neutral.length > 1;
    const data = () => {
      const columns = names.map((name) => fitted(series.get(name), series.step.length));
      const limits = withBand ? spread(neutral.map((name) => series.get(name)), series.step.length) : [];
      return [series.step, ...columns, ...limits] as uPlot.AlignedData;
    };
    const lines: uPlot.Series[] = names.map((_, i) => ({ label: labels[i], stroke: colors[i % colors.length], width: 1.5, points: { show: false } }));
    if (withBand) for (const label of ["neutral, high", "neutral, low"]) lines.push({ label, stroke: "#8884", points: { show: false } });
    const axis: uPlot.Axis = { stroke: () => styleColor("--quiet"), grid: { stroke: "#8882", width: 1 }, ticks: { show: false }, size: 44 };
    const options: uPlot.Options = {
      width: 300,
      height: HEIGHT,
      legend: { show: false },
      cursor: { sync: { key: "time" }, y: false },
      scales: { x: { time: false } },
      series: [{ label: "step" }, ...lines],
      bands: withBand ? [{ series: [names.length + 1, names.length + 2], fill: "#8882" }] : [],
      axes: [{ ...axis, size: 26 }, axis],
      hooks: { draw: [(chart) => this.markNow(chart)] },
    };
    const heading = element("p", { text: title, class: "plot-title" });
    if (names.length > 1) {
      labels.forEach((label, i) => {
        const dot = element("b", { text: "●" });
        dot.style.color = colors[i % colors.length]!;
        heading.append(element("span", {}, dot, ` ${label}`));
      });
    }
    host.append(heading);
    const chart = new uPlot(options, data(), host);
    chart.over.addEventListener("click", () => {
      const step = chart.posToVal(chart.cursor.left ?? -1, "x");
      if (Number.isFinite(step)) seek(step);
    });
    this.plots.push({ chart, data });
  }

  private markNow(chart: uPlot): void {
    const x = chart.valToPos(this.now, "x", true);
    chart.ctx.fillStyle = styleColor("--mark");
    chart.ctx.fillRect(x - 1, chart.bbox.top, 2, chart.bbox.height);
  }

  private drawLiving(frame: Frame): void {
    const lives = Array.from(frame.id, (id) => this.source.lives.get(id)).filter((life) => life !== undefined);
    const ages = lives.map((life) => frame.step - life.birth);
    const oldest = Math.max(1, ...ages);
    const bins = new Array<number>(20).fill(0);
    for (const age of ages) bins[Math.min(19, Math.floor((age / oldest) * 20))]!++;
    const pen = surface(this.ages);
    const most = Math.max(1, ...bins);
    const [width, height] = [this.ages.clientWidth, this.ages.clientHeight - 14];
    pen.fillStyle = LINES[0]!;
    bins.forEach((count, i) => pen.fillRect((i * width) / 20 + 1, height - (count / most) * height, width / 20 - 2, (count / most) * height));
    pen.fillStyle = styleColor("--quiet");
    pen.fillText(`0 to ${show(oldest)} steps; ${lives.length} agents`, 2, height + 11);
    const [a, b] = this.axes.map((axis) => Number(axis.value)) as [number, number];
    this.drawScatter(lives.map((life) => [life.genome[a]!, life.genome[b]!]));
  }

  private drawScatter(points: [number, number][]): void {
    const pen = surface(this.scatter);
    const [width, height] = [this.scatter.clientWidth, this.scatter.clientHeight];
    const limit = Math.max(1e-3, ...points.flatMap(([x, y]) => [Math.abs(x), Math.abs(y)])) * 1.08;
    pen.fillStyle = "#8884";
    pen.fillRect(width / 2, 0, 1, height);
    pen.fillRect(0, height / 2, width, 1);
    pen.fillStyle = LINES[1]! + "aa";
    for (const [x, y] of points) pen.fillRect(((x / limit + 1) * width) / 2 - 1.5, ((1 - y / limit) * height) / 2 - 1.5, 3, 3);
    pen.fillStyle = styleColor("--quiet");
    pen.fillText(`± ${show(limit)}`, 2, 10);
  }
}

/** A canvas of the size that it has on the page, empty. */
function surface(canvas: HTMLCanvasElement): CanvasRenderingContext2D {
  const ratio = window.devicePixelRatio || 1;
  [canvas.width, canvas.height] = [canvas.clientWidth * ratio, canvas.clientHeight * ratio];
  const pen = canvas.getContext("2d")!;
  pen.scale(ratio, ratio);
  return pen;
}

function fitted(column: number[], length: number): (number | null)[] {
  return Array.from({ length }, (_, i) => (Number.isFinite(column[i]) ? column[i]! : null));
}

/** Limits between which the means of neutral genes lie: what drift alone does. */
function spread(columns: number[][], length: number): [(number | null)[], (number | null)[]] {
  const [high, low]: [(number | null)[], (number | null)[]] = [[], []];
  for (let i = 0; i < length; i++) {
    const values = columns.map((column) => column[i]!).filter(Number.isFinite);
    const variance = values.reduce((sum, value) => sum + value * value, 0) / Math.max(values.length, 1);
    const limit = values.length > 1 ? RANGE * Math.sqrt(variance) : null;
    high.push(limit);
    low.push(limit === null ? null : -limit);
  }
  return [high, low];
}
