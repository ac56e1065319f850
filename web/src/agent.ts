// The panel of the chosen agent: its life, its kin to click, its genome, and what its network sees and says.
import { by, element, show, table } from "./element";
import { castRays } from "./rays";
import { smell } from "./smells";
import type { Source } from "./source";
import type { Frame, Life } from "./types";

const SHOWN_CHILDREN = 12;
const ROUNDED = 1e4; // rewards are sums of numbers of 7 digits

export class AgentPanel {
  private readonly host = by<HTMLDivElement>("agent");
  private readonly sight = element("canvas", { class: "sight", title: "what each ray sees, from left to right" });
  private readonly course = element("canvas", { class: "small", title: "energy since it was chosen" });
  private energies: [number, number][] = [];
  private last = "";

  constructor(private readonly choose: (id: number) => void) {}

  update(source: Source, frame: Frame | undefined, chosen: number): void {
    if (this.host.hidden) return;
    const key = `${chosen} ${frame?.step} ${source.lives.size} ${source.agentProbe()?.id}`;
    if (key === this.last) return;
    this.last = key;
    if (chosen < 0) return this.invite();
    const life = source.lives.get(chosen);
    const at = frame ? frame.id.indexOf(chosen) : -1;
    const parts: Node[] = [element("h2", { text: `Agent ${chosen}` })];
    if (at < 0) parts.push(element("p", { text: life ? whenGone(life, frame) : "There is no such agent in these records." }));
    if (life) parts.push(this.lifeTable(life, frame, at), ...this.counts(source, life), element("h3", { text: "genome" }), genome(source, life));
    if (frame && at >= 0) {
      this.note(frame.step, frame.energy[at]!);
      parts.push(element("h3", { text: "energy while watched" }), this.course);
      parts.push(element("h3", { text: "what its rays see, from left to right" }), this.sight);
      if (source.layout.species[frame.species[at]!]!.smells.length > 0) parts.push(element("h3", { text: "what it smells" }), smells(source, frame, at));
      parts.push(answer(source));
    }
    this.host.replaceChildren(...parts);
    if (frame && at >= 0) {
      drawSight(this.sight, source, frame, at);
      this.drawCourse(source);
    }
  }

  forget(): void {
    this.energies = [];
    this.last = "";
  }

  private invite(): void {
    this.host.replaceChildren(
      element("p", { text: "Click an agent to see its life, its genome and what it sees. The chosen agent is ringed, and so are its near kin." }),
    );
  }

  private lifeTable(life: Life, frame: Frame | undefined, at: number): HTMLElement {
    const rows: [string, Node | string][] = [];
    const born = `born at ${show(life.birth)}${life.death >= 0 ? `, died at ${show(life.death)}` : ""}`;
    if (frame && at >= 0) rows.push(["age", `${show(frame.step - life.birth)} steps (${born})`], ["energy", show(frame.energy[at])]);
    else rows.push(["life", born]);
    rows.push(["generation", show(life.generation)], ["parent", life.parent >= 0 ? this.link(life.parent) : "none, a founder"]);
    return table(rows);
  }

  /** What is counted over a life: its course within the life is not known, so the title says up to when. */
  private counts(source: Source, life: Life): Node[] {
    const rows: [string, Node | string][] = [["reward", show(life.reward)], ...rewardParts(source, life), ["children", this.children(source, life)]];
    source.layout.meals.forEach((meal, k) => rows.push([`${meal} eaten`, show(life.eaten[k])]));
    return [element("h3", { text: countedUntil(source, life) }), table(rows)];
  }

  private children(source: Source, life: Life): Node {
    const known = source.lives.children(life.id);
    const out = element("span", { text: `${show(life.children)} ` });
    for (const id of known.slice(0, SHOWN_CHILDREN)) out.append(this.link(id), " ");
    if (known.length > SHOWN_CHILDREN) out.append("…");
    return out;
  }

  private link(id: number): HTMLElement {
    const button = element("button", { text: String(id), class: "link" });
    button.addEventListener("click", () => this.choose(id));
    return button;
  }

  private note(step: number, energy: number): void {
    const last = this.energies[this.energies.length - 1];
    if (last && last[0] > step) this.energies = [];
    if (!last || last[0] !== step) this.energies.push([step, energy]);
    if (this.energies.length > 600) this.energies.shift();
  }

  private drawCourse(source: Source): void {
    const pen = sized(this.course);
    const [width, height] = [this.course.clientWidth, this.course.clientHeight];
    const [first, last] = [this.energies[0]![0], this.energies[this.energies.length - 1]![0]];
    const most = Math.max(1, ...this.energies.map(([, energy]) => energy));
    pen.strokeStyle = "#e69f00";
    pen.beginPath();
    for (const [step, energy] of this.energies) {
      pen.lineTo(((step - first) / Math.max(last - first, 1)) * width, height - (energy / most) * (height - 4) - 2);
    }
    pen.stroke();
    pen.fillStyle = "#8a8f98";
    pen.fillText(`up to ${show(most)} of ${show(source.layout.energy_capacity)}`, 3, 10);
  }
}

function whenGone(life: Life, frame: Frame | undefined): string {
  if (frame && life.birth > frame.step) return "Not yet born at this step.";
  return life.death >= 0 ? "Dead at this step." : "No position is known at this step.";
}

/** Up to when reward, children and meals of a life are counted, whatever step is shown. */
function countedUntil(source: Source, life: Life): string {
  if (life.death >= 0) return "in its whole life";
  return source.live ? `up to step ${show(source.last)}` : "up to the last record of it";
}

/** Each gene as a bar from the middle, where it is 0; neutral ones are gray. */
function genome(source: Source, life: Life): HTMLElement {
  const limit = Math.max(0.1, ...life.genome.map(Math.abs));
  const rows = source.layout.genes.map((gene, g): [string, Node] => {
    const value = life.genome[g]!;
    const fill = element("i");
    const share = (50 * Math.abs(value)) / limit;
    fill.style.width = `${share}%`;
    fill.style.left = `${value < 0 ? 50 - share : 50}%`;
    const bar = element("div", { title: `${gene.name} = ${value}`, class: `gene ${gene.role} ${value < 0 ? "low" : "high"}` }, fill);
    return [gene.name, element("div", {}, bar, show(value, 3))];
  });
  const list = table(rows);
  list.classList.add("genome");
  return list;
}

/** What the reward of a life is made of, as far as its meals tell. */
function rewardParts(source: Source, life: Life): [string, string][] {
  const { layout } = source;
  const { meals, rest } = layout.species[life.species]!.reward;
  if (meals.length === 0) return [];
  const values = meals.map(({ meal, gene, coef }) => coef * life.genome[gene]! * life.eaten[meal]!);
  const rows = meals.map(({ meal }, i): [string, string] => [`… by ${layout.meals[meal]}`, show(values[i])]);
  const left = values.reduce((sum, value) => sum - value, life.reward);
  if (rest.length > 0) rows.push([`… by ${rest.join(", ")}`, show(Math.round(left * ROUNDED) / ROUNDED)]);
  return rows;
}

/** What each nose smells of each type, at most 1. */
function smells(source: Source, frame: Frame, at: number): HTMLElement {
  const { layout } = source;
  const sides = smell(layout, frame, at);
  const { smells } = layout.species[frame.species[at]!]!;
  const text = (channel: number) => (sides.length === 1 ? show(sides[0]![channel]) : `left ${show(sides[1]![channel])}, right ${show(sides[0]![channel])}`);
  return table(smells.map((type, channel): [string, string] => [layout.types[type]!, text(channel)]));
}

function answer(source: Source): HTMLElement {
  const probe = source.agentProbe();
  if (!probe) {
    const why = source.live ? "…" : "Networks are not recorded. In a live world you see what they say.";
    return element("p", { text: why, class: "quiet" });
  }
  const [left, right, value] = probe.output;
  const share = (action: number) => `${(100 / (1 + Math.exp(-action))).toFixed(0)} %`;
  return table([
    ["left motor", share(left!)],
    ["right motor", share(right!)],
    ["value of now", show(value)],
  ]);
}

function drawSight(canvas: HTMLCanvasElement, source: Source, frame: Frame, at: number): void {
  const { layout } = source;
  const pen = sized(canvas);
  const rays = castRays(layout, frame, at, source.obstacles).reverse();
  const [width, height] = [canvas.clientWidth / rays.length, canvas.clientHeight];
  const first = layout.species.length;
  rays.forEach((ray, i) => {
    if (ray.type < 0) return;
    const tall = Math.max(3, (1 - ray.share) * height);
    pen.fillStyle = layout.foods[ray.type - first]?.color ?? (ray.type < first ? "#0072b2" : "#8a8f98");
    pen.fillRect(i * width + 0.5, height - tall, width - 1, tall);
  });
}

function sized(canvas: HTMLCanvasElement): CanvasRenderingContext2D {
  const ratio = window.devicePixelRatio || 1;
  [canvas.width, canvas.height] = [Math.max(canvas.clientWidth, 1) * ratio, Math.max(canvas.clientHeight, 1) * ratio];
  const pen = canvas.getContext("2d")!;
  pen.scale(ratio, ratio);
  return pen;
}
