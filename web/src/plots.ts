// The plots next to the world, synchronized with the time line. Only what the layout names is plotted.
import { Curves, dashOf, type Choice, type Line } from "./curves";
import { Density } from "./density";
import { Distributions } from "./distribution";
import { drift, type Band } from "./drift";
import { by, element, option, show, styleColor } from "./element";
import { LivingPlots } from "./living";
import { Plot, type Content, type View } from "./plot";
import { recall, remember } from "./preference";
import { columnOf } from "./series";
import { WINDOWS } from "./smooth";
import type { Source } from "./source";
import type { Frame, Species } from "./types";

export class Plots implements View {
  zoom: [number, number] | undefined;
  now = 0;
  private plots: Plot[] = [];
  private points = -1;
  private known = 0; // lives of a replay that the drift bands include
  private theme = "";
  private seeds = 0; // other seeds that are drawn
  private otherRows = 0;
  private readonly choice: Choice;
  private readonly distributions = new Map<Species, Distributions>();
  private readonly living: LivingPlots;
  private readonly host = by<HTMLDivElement>("plots");
  private readonly whole = element("button", { text: "Whole time", title: "Shows all steps again, as does a double click on a plot" });

  constructor(
    private readonly source: Source,
    readonly seek: (step: number) => void,
  ) {
    const { layout } = source;
    const window = Number(recall("smoothing"));
    this.choice = { window: WINDOWS.includes(window) ? window : 1, seeds: false };
    this.host.replaceChildren(element("h2", { text: "Plots", class: "unseen" }), this.tools());
    this.theme = styleColor("--quiet");
    for (const species of layout.species) this.addWeights(species);
    const each = (column: string): Line[] => layout.species.map(({ name, color }, i) => ({ name: columnOf(layout, layout.species[i]!, column), column, species: name, label: name, color }));
    const foods = (what: string): Line[] => layout.foods.map(({ name, color }) => ({ name: `${what}_${name}`, column: `${what}_${name}`, species: "", label: name, color }));
    this.addCurves("agents alive", "agents", each("alive"));
    this.addCurves("mean energy", "energy", each("energy_mean"));
    this.addCurves("food present", "pieces", foods("food"));
    if (!source.live) this.addCurves("food eaten since the row before", "pieces", foods("eaten"));
    this.living = new LivingPlots(source);
    this.host.append(...this.living.parts);
  }

  update(frame: Frame | undefined, now: number): void {
    this.now = Math.min(now, this.source.last);
    if (this.host.hidden) return;
    const { step } = this.source.series;
    const theme = styleColor("--quiet");
    const { lives, live, loaded, others } = this.source;
    const known = live || !loaded ? 0 : lives.size; // a replay reads lives after the series, and the drift bands need them
    const otherRows = this.choice.seeds ? others.reduce((sum, each) => sum + each.series.step.length, 0) : 0;
    const grown = step.length !== this.points || known !== this.known || theme !== this.theme || otherRows !== this.otherRows;
    [this.points, this.known, this.theme, this.otherRows] = [step.length, known, theme, otherRows];
    const seeds = this.choice.seeds ? others.length : 0;
    if (seeds !== this.seeds) this.remake(seeds);
    const worked = new Set([...this.distributions].filter(([, each]) => each.advance()).map(([, each]) => each));
    const width = Math.max(this.host.clientWidth - 28, 100);
    const at = step.findLastIndex((each) => each <= this.now);
    for (const plot of this.plots) {
      plot.update(width, grown || (plot.content instanceof Density && worked.has(plot.content.distributions)));
      plot.judge?.(at);
    }
    if (frame) this.living.draw(frame);
  }

  /** Shows a range of steps in all plots; undefined for all steps. */
  setZoom(zoom: [number, number] | undefined): void {
    const steps = this.plots[0]!.chart.data[0];
    const [first, last] = [steps[0] ?? 0, steps[steps.length - 1] ?? 0];
    const range = zoom && ([Math.max(Math.round(zoom[0]), first), Math.min(Math.round(zoom[1]), last)] as [number, number]);
    if (range && range[1] - range[0] < 1) return;
    this.zoom = range && (range[0] > first || range[1] < last) ? range : undefined;
    this.whole.disabled = !this.zoom;
    for (const plot of this.plots) plot.rescale();
  }

  get world(): string {
    return `${this.source.title}, seed ${this.source.seed}`;
  }

  /** The full name of a plot's file. */
  file(name: string): string {
    return `${this.source.title}-s${this.source.seed}-${name}`;
  }

  /** The controls that apply to all plots. */
  private tools(): HTMLElement {
    const { source, choice, whole } = this;
    const smoothing = element("select");
    smoothing.id = "smoothing";
    smoothing.append(...WINDOWS.map((window) => option(String(window), window === 1 ? "off" : `${window} rows`)));
    smoothing.value = String(choice.window);
    smoothing.onchange = () => {
      choice.window = Number(smoothing.value);
      remember("smoothing", smoothing.value);
      this.remake(this.seeds);
    };
    whole.id = "whole-time";
    whole.disabled = true;
    whole.onclick = () => this.setZoom(undefined);
    const tools = element("div", { class: "row plot-tools" }, element("label", {}, "Smoothing ", smoothing));
    const worlds = [source, ...source.runs].reduce((sum, { seeds }) => sum + seeds.length, 0);
    if (worlds > 1) {
      const seeds = Object.assign(element("input"), { type: "checkbox", id: "all-seeds" });
      const runs = [`solid: ${source.title}`, ...source.runs.map(({ run }, i) => `${dashOf(i)[0]}: ${run}`)];
      const key = element("p", { class: "runs", text: runs.join(", ") });
      const apply = () => {
        choice.seeds = seeds.checked;
        key.hidden = !seeds.checked || source.runs.length === 0;
        if (seeds.checked) source.readOthers();
      };
      seeds.onchange = apply;
      seeds.checked = source.runs.length > 0; // several runs are given to be compared
      apply();
      tools.append(element("label", { class: "check" }, seeds, source.runs.length > 0 ? ` all runs and seeds (${worlds})` : ` all seeds (${worlds})`), key);
    }
    tools.append(whole);
    return tools;
  }

  private remake(seeds: number): void {
    this.seeds = seeds;
    for (const plot of this.plots) if (plot.content instanceof Curves) plot.remake();
  }

  /** Adds two plots for each reward weight: its mean with the drift band and a verdict, and its distribution. */
  private addWeights(species: Species): void {
    const { layout, series } = this.source;
    const owner = layout.species.length > 1 ? `${species.name}: ` : "";
    const distributions = new Distributions(this.source, species);
    this.distributions.set(species, distributions);
    species.genes.forEach((g, i) => {
      const gene = layout.genes[g]!;
      if (gene.role === "neutral") return;
      const column = `${gene.name}_mean`;
      const name = columnOf(layout, species, column);
      const verdict = element("span", { class: "verdict" });
      const unit = gene.unit ? `${gene.unit}, mean of the living` : "mean of the living";
      const line: Line = { name, column, species: species.name, label: gene.title, color: gene.color };
      const plot = this.addCurves(`${owner}${gene.title}`, unit, [line], () => drift(this.source, species, i), verdict);
      plot.judge = (at) => {
        const band = drift(this.source, species, i);
        const value = series.get(name)[at];
        verdict.textContent = typeof band === "string" ? band : judged(value, band, at);
        verdict.dataset.outside = String(typeof band !== "string" && outside(value, band, at));
      };
      if (gene.role === "reward") this.add(new Density(this.source, species, gene, distributions));
    });
  }

  private addCurves(title: string, unit: string, lines: Line[], band?: () => Band | string, verdict?: HTMLElement): Plot {
    return this.add(new Curves(this.source, this.choice, title, unit, lines, band), verdict);
  }

  private add(content: Content, verdict?: HTMLElement): Plot {
    const plot = new Plot(content, this, verdict);
    this.host.append(...plot.parts);
    this.plots.push(plot);
    return plot;
  }
}

const outside = (value: number | undefined, { low, high }: Band, at: number): boolean => value !== undefined && at >= 0 && low[at] != null && (value < low[at]! || value > high[at]!);

function judged(value: number | undefined, band: Band, at: number): string {
  if (value === undefined || at < 0 || Number.isNaN(value) || band.low[at] == null) return "";
  const range = `${show(band.low[at]!, 3)} to ${show(band.high[at]!, 3)}`;
  return `${show(value, 3)}: ${outside(value, band, at) ? "outside" : "within"} drift (${range})`;
}
