// Plots of the agents alive at the moment shown: their ages, and two of their genes.
import { brush } from "./brush";
import { element, option, picture, show, styleColor, surface } from "./element";
import { quantile } from "./scale";
import type { Source } from "./source";
import type { Frame, Life } from "./types";

const BINS = 20;
const PART = 0.98; // share of the points that are within the axes; the few beyond are drawn at the rim

export class LivingPlots {
  readonly parts: HTMLElement[];
  private readonly scatter = element("canvas", { class: "tall" });
  private readonly ages = element("canvas", { class: "small" });
  private readonly kind = element("select");
  private readonly axes = [element("select"), element("select")] as const;

  constructor(private readonly source: Source) {
    const { layout } = source;
    this.scatter.id = "scatter";
    picture(this.ages, "Ages of the living");
    picture(this.scatter, "Two genes of the living");
    [this.kind, ...this.axes].forEach((select, i) => select.setAttribute("aria-label", ["Species", "Gene along x", "Gene along y"][i]!));
    this.kind.append(...layout.species.map((species, s) => option(String(s), species.name)));
    this.kind.hidden = layout.species.length === 1;
    this.kind.onchange = () => this.offer();
    this.offer();
    this.parts = [
      element("h3", { class: "plot-title", text: "ages of the living [agents, by steps]" }),
      this.ages,
      element("h3", { class: "plot-title", text: "two genes of each of the living" }),
      element("div", { class: "row" }, this.kind, this.axes[0], this.axes[1]),
      this.scatter,
    ];
  }

  draw(frame: Frame): void {
    const lives = Array.from(frame.id, (id) => this.source.lives.get(id)).filter((life) => life !== undefined);
    this.drawAges(lives.map((life) => frame.step - life.birth));
    this.drawScatter(lives.filter((life) => life.species === Number(this.kind.value)));
  }

  /** Lists the genes of the chosen species, which species may not share. */
  private offer(): void {
    const { layout } = this.source;
    const genes = layout.species[Number(this.kind.value)]!.genes;
    this.axes.forEach((axis, i) => {
      axis.replaceChildren(...genes.map((g) => option(String(g), layout.genes[g]!.title)));
      axis.value = String(genes[Math.min(i, genes.length - 1)]);
    });
  }

  private drawAges(ages: number[]): void {
    const oldest = Math.max(1, ...ages);
    const bins = new Array<number>(BINS).fill(0);
    for (const age of ages) bins[Math.min(BINS - 1, Math.floor((age / oldest) * BINS))]!++;
    const pen = surface(this.ages);
    const most = Math.max(1, ...bins);
    const [width, height] = [this.ages.clientWidth, this.ages.clientHeight - 34];
    pen.fillStyle = styleColor("--high");
    bins.forEach((count, i) => pen.fillRect((i * width) / BINS + 1, 16 + height - (count / most) * height, width / BINS - 2, (count / most) * height));
    pen.fillStyle = styleColor("--quiet");
    pen.fillText(`at most ${show(most)}`, 2, 12);
    pen.fillText("0", 2, height + 30);
    pen.textAlign = "right";
    pen.fillText(`${show(Math.floor(oldest))} steps`, width - 2, height + 30);
    this.ages.setAttribute("aria-label", `Ages of ${ages.length} agents, up to ${show(Math.floor(oldest))} steps`);
  }

  private drawScatter(lives: Life[]): void {
    const [a, b] = this.axes.map((axis) => Number(axis.value)) as [number, number];
    const points = lives.map((life): [number, number] => [life.genome[a]!, life.genome[b]!]).filter(([x, y]) => Number.isFinite(x) && Number.isFinite(y));
    const pen = surface(this.scatter);
    const [width, height] = [this.scatter.clientWidth, this.scatter.clientHeight];
    const limit = Math.max(1e-3, quantile(points.flatMap(([x, y]) => [Math.abs(x), Math.abs(y)]), PART) || 0) * 1.08;
    const within = (value: number) => Math.min(Math.max(value / limit, -0.99), 0.99);
    pen.fillStyle = styleColor("--rule");
    pen.fillRect(width / 2, 0, 1, height);
    pen.fillRect(0, height / 2, width, 1);
    pen.fillStyle = this.source.layout.species[Number(this.kind.value)]!.color;
    for (const [x, y] of points) pen.fillRect(((within(x) + 1) * width) / 2 - 2, ((1 - within(y)) * height) / 2 - 2, 4, 4);
    pen.fillStyle = styleColor("--quiet");
    pen.fillText(`${show(limit)} ↑ ${this.source.layout.genes[b]!.title}`, width / 2 + 4, 12);
    pen.textAlign = "right";
    pen.fillText(`${this.source.layout.genes[a]!.title} → ${show(limit)}`, width - 2, height / 2 - 4);
    this.scatter.setAttribute("aria-label", `Two genes of ${points.length} agents`);
    brush.drawn({ canvas: this.scatter, species: Number(this.kind.value), genes: [a, b], limit });
  }
}
