// The family tree of the agents alive at the moment shown, colored by a gene.
import { diverging } from "./color";
import { by, counted, element, option, picture, show, styleColor, surface } from "./element";
import { scaleOf } from "./scale";
import type { Source } from "./source";
import type { Frame, Life } from "./types";

const PAD = 6;
const NEAR = 10; // pixels from a line within which a click hits it
const AXIS = 18; // pixels for the time below the tree
const FAINT = 0.2; // opacity of the branches that are not chosen

/** A life in the tree: a living agent, or an ancestor of one. */
interface Branch {
  life: Life;
  row: number;
  end: number; // the last step of its line: the moment shown, or the last birth that led to a living agent
  children: Branch[]; // youngest first
}

export class Tree {
  /** The living agents of the chosen branch. */
  bearers = new Set<number>();
  branches: Branch[] = [];
  chosen = -1; // the life of the chosen branch
  private rows = 1;
  private key = "";
  private frame: Frame | undefined;
  private readonly known = new Map<number, Branch>();
  private readonly inside = new Set<Branch>(); // the chosen branch and its descendants
  private readonly scales: ReturnType<typeof scaleOf>[]; // of the genes
  private readonly host = by<HTMLDivElement>("tree");
  private readonly canvas = element("canvas", { class: "tree" });
  private readonly gene = element("select");
  private readonly caption = element("p", { class: "said" });
  private readonly ends: HTMLElement = element("p", { class: "hint" });

  constructor(
    private readonly source: Source,
    private readonly mark: (bearers: Set<number>) => void,
    private readonly agent: () => number,
  ) {
    this.scales = source.layout.genes.map(({ name }, g) => scaleOf(name, true, (life) => life.genome[g]!));
    picture(this.canvas, "The tree of the living");
    this.gene.setAttribute("aria-label", "Gene that colors the tree");
    this.gene.append(...source.layout.genes.map((gene, g) => option(String(g), gene.title)));
    this.gene.onchange = () => this.redraw();
    this.canvas.onclick = (event) => this.choose(this.at(event.offsetX, event.offsetY));
    const button = (text: string, act: () => void) => Object.assign(element("button", { text }), { onclick: act });
    this.host.replaceChildren(
      element("h2", { text: "Tree", class: "unseen" }),
      element("h3", { class: "plot-title", text: "the tree of the living, by time of birth" }),
      element("div", { class: "row" }, this.gene),
      this.ends,
      this.canvas,
      this.caption,
      element("div", { class: "row" }, button("Branch of the agent", () => this.choose(agent())), button("One parent up", () => this.up()), button("No branch", () => this.choose(-1))),
    );
    this.gather();
  }

  /** Updates the tree to the moment shown; while it is hidden, only if a chosen branch is ringed in the arena. */
  update(frame: Frame | undefined): void {
    if (!frame || (this.host.hidden && this.chosen < 0)) return;
    const theme = styleColor("--quiet");
    const key = [frame.step, this.source.lives.size, this.canvas.clientWidth, theme].join();
    if (key === this.key) return;
    this.key = key;
    this.frame = frame;
    this.grow(frame);
    this.gather();
    this.redraw();
  }

  /** Chooses the branch of a life, or none with -1. Choosing the same one again deselects it. */
  choose(id: number): void {
    this.chosen = id === this.chosen || !this.known.has(id) ? -1 : id;
    this.gather();
    this.redraw();
  }

  private up(): void {
    const parent = this.known.get(this.chosen >= 0 ? this.chosen : this.agent())?.life.parent ?? -1;
    if (this.known.has(parent)) this.choose(parent);
  }

  /** Builds the tree of the agents in a frame, as far back as lives are known. */
  private grow(frame: Frame): void {
    const { lives } = this.source;
    this.known.clear();
    const roots: Branch[] = [];
    const living = new Set(frame.id);
    for (const id of frame.id) {
      let below: Branch | undefined;
      for (let life = lives.get(id); ; life = lives.get(life.parent)) {
        if (!life) {
          if (below) roots.push(below);
          break;
        }
        const existing = this.known.get(life.id);
        const branch = existing ?? { life, row: 0, end: living.has(life.id) ? frame.step : 0, children: [] };
        if (below) branch.children.push(below);
        if (existing) break;
        this.known.set(life.id, branch);
        below = branch;
      }
    }
    this.place(roots.sort((a, b) => a.life.id - b.life.id), living);
  }

  /** Gives each living agent a row; a dead ancestor shares the row of its last child, so that no lines cross. */
  private place(roots: Branch[], living: Set<number>): void {
    const order: Branch[] = [];
    const waiting = roots.reverse();
    this.rows = 0;
    for (let next = waiting.pop(); next; next = waiting.pop()) {
      order.push(next);
      if (living.has(next.life.id)) next.row = this.rows++;
      next.children.sort((a, b) => b.life.birth - a.life.birth);
      waiting.push(...[...next.children].reverse());
    }
    for (const branch of [...order].reverse()) {
      if (living.has(branch.life.id)) continue;
      branch.row = branch.children[0]!.row;
      branch.end = branch.children[0]!.life.birth;
    }
    this.branches = order;
  }

  private gather(): void {
    this.inside.clear();
    const waiting = [this.known.get(this.chosen)];
    for (let next = waiting.pop(); next; next = waiting.pop()) {
      this.inside.add(next);
      waiting.push(...next.children);
    }
    const below = new Set([...this.inside].map(({ life }) => life.id));
    this.bearers = new Set([...(this.frame?.id ?? [])].filter((id) => below.has(id)));
    this.mark(this.bearers);
    this.tell();
  }

  private tell(): void {
    const life = this.known.get(this.chosen)?.life;
    this.caption.textContent = life
      ? `${counted(this.bearers.size, "agent")} of ${show(this.frame!.id.length)} that live: agent ${life.id}, born at step ${show(life.birth)} in generation ${life.generation}, and its descendants. They are ringed in the arena.`
      : "Click a line to ring its agent and all its living descendants.";
  }

  private redraw(): void {
    const { canvas, frame, inside } = this;
    if (!frame || this.host.hidden) return;
    const pen = surface(canvas);
    const g = Number(this.gene.value);
    const [, limit] = this.scales[g]!(this.source, frame);
    const quiet = styleColor("--quiet");
    for (const branch of this.branches) {
      const value = branch.life.genome[g]!;
      pen.globalAlpha = inside.size === 0 || inside.has(branch) ? 1 : FAINT;
      pen.fillStyle = Number.isFinite(value) ? diverging(value, limit) : quiet;
      const [x, y] = [this.toX(branch.life.birth), this.toY(branch.row)];
      pen.fillRect(x, y - 0.75, Math.max(this.toX(branch.end) - x, 1), 1.5);
      const parent = this.known.get(branch.life.parent);
      if (parent) pen.fillRect(x - 0.5, Math.min(this.toY(parent.row), y), 1, Math.abs(this.toY(parent.row) - y));
    }
    pen.globalAlpha = 1;
    pen.textAlign = "left";
    pen.fillStyle = quiet;
    pen.fillText(`step ${show(this.source.first)}`, PAD, canvas.clientHeight - 4);
    pen.textAlign = "right";
    pen.fillText(show(frame.step), canvas.clientWidth - PAD, canvas.clientHeight - 4);
    canvas.setAttribute("aria-label", `Tree of ${counted(this.rows, "agent")} that live, and ${show(this.branches.length - this.rows)} of their ancestors`);
    const dot = (at: number) => {
      const made = element("b", { text: "●" });
      made.style.color = diverging(at, limit);
      return made;
    };
    this.ends.replaceChildren(dot(-limit), ` ${show(-limit)} and less, `, dot(0), " 0, ", dot(limit), ` ${show(limit)} and more`);
  }

  private toX(step: number): number {
    const { first } = this.source;
    return PAD + ((step - first) / Math.max((this.frame?.step ?? 0) - first, 1)) * (this.canvas.clientWidth - 2 * PAD);
  }

  private toY(row: number): number {
    return PAD + ((row + 0.5) / Math.max(this.rows, 1)) * (this.canvas.clientHeight - 2 * PAD - AXIS);
  }

  /** The life whose line is nearest to a place of the canvas, or -1. */
  private at(x: number, y: number): number {
    let [nearest, best] = [-1, NEAR];
    for (const { life, row, end } of this.branches) {
      if (x < this.toX(life.birth) - 2 || x > this.toX(end) + 2) continue;
      const away = Math.abs(this.toY(row) - y);
      if (away < best) [nearest, best] = [life.id, away];
    }
    return nearest;
  }
}
