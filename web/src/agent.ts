// The panel of the chosen agent: what it sees and does, whether it learns, its genes, its life, and links to its kin.
import { typeColor } from "./color";
import { by, counted, element, picture, show, styleColor, surface, table } from "./element";
import { LearningChart } from "./learning";
import { castRays } from "./rays";
import { smell } from "./smells";
import type { Source } from "./source";
import type { Frame, Gene, Life, Species } from "./types";

const SHOWN_CHILDREN = 12;
const ROUNDED = 1e4; // rewards are sums of 7-digit numbers

/** A part of the panel that is rewritten only if its content changes, so that the focused element keeps the focus. */
class Part {
  readonly host = element("section");
  private content = "";

  fill(...parts: Node[]): void {
    const content = parts.map((part) => (part instanceof Element ? part.outerHTML : (part.textContent ?? ""))).join("");
    if (content === this.content) return;
    this.content = content;
    this.host.replaceChildren(...parts);
  }
}

export class AgentPanel {
  private readonly host = by<HTMLDivElement>("agent");
  private readonly sight = element("canvas", { class: "sight" });
  private readonly course = element("canvas", { class: "small" });
  private readonly learning = new LearningChart();
  private readonly folded = element("details", { class: "neutral" }, element("summary"), element("div"));
  private readonly state = new Part();
  private readonly seen = new Part();
  private readonly answer = new Part();
  private readonly genes = new Part();
  private readonly life = new Part();
  private energies: [number, number][] = [];
  private last = "";
  private shown = "";

  constructor(private readonly choose: (id: number) => void) {
    picture(this.sight, "What its rays see");
    picture(this.course, "Its energy");
  }

  update(source: Source, frame: Frame | undefined, chosen: number): void {
    if (this.host.hidden) return;
    const key = `${chosen} ${frame?.step} ${source.lives.size} ${source.agentProbe()?.id} ${source.last} ${styleColor("--page")} ${this.host.clientWidth}`;
    if (key === this.last) return;
    this.last = key;
    if (chosen < 0) return this.invite();
    const life = source.lives.get(chosen);
    const at = frame ? frame.id.indexOf(chosen) : -1;
    const present = frame !== undefined && at >= 0;
    const heading = element("h2", { text: `Agent ${chosen}` });
    const gone = present ? [] : [element("p", { text: life ? whenGone(life, frame) : "There is no such agent in these records." })];
    this.state.fill(heading, ...gone, ...(life ? [lifeTable(source, life, frame, at, (id) => this.link(id))] : []));
    this.seen.fill(...(present ? seenTitle(source, frame, at) : []));
    this.answer.fill(...(present ? [...smellsOf(source, frame, at), ...observed(source, source.layout.species[frame.species[at]!]!), ...answer(source)] : []));
    if (life) {
      const neutral = this.neutral(source, life);
      this.genes.fill(element("h3", { text: "its genes" }), genome(source, life, (gene) => gene.role !== "neutral"));
      this.life.fill(...this.counts(source, life));
      this.arrange(present, source, neutral);
      this.drawLearning(source, life);
    } else this.arrange(present, source, false);
    if (!present) return;
    this.note(frame.step, frame.energy[at]!);
    drawSight(this.sight, source, frame, at);
    this.drawCourse(source);
  }

  forget(): void {
    this.energies = [];
    this.last = "";
  }

  /** Puts the most important parts first. Elements are moved only if the set of parts has changed. */
  private arrange(present: boolean, source: Source, neutral: boolean): void {
    const known = source.earned(0) !== undefined;
    const key = `${present} ${known} ${neutral}`;
    if (key === this.shown && this.host.firstChild === this.state.host) return;
    this.shown = key;
    const learning = [element("h3", { text: "is it learning? reward in each window" }), ...(known ? [this.learning.canvas, this.learning.text] : [unknown()])];
    const energy = [element("h3", { text: "energy while watched" }), this.course];
    this.host.replaceChildren(
      this.state.host,
      ...(present ? [this.seen.host, this.sight, this.answer.host] : []),
      ...learning,
      this.genes.host,
      ...(neutral ? [this.folded] : []),
      ...(present ? energy : []),
      this.life.host,
    );
  }

  private invite(): void {
    this.shown = "";
    this.host.replaceChildren(
      element("p", { text: "Click an agent, or press Next, to see what it sees and does, whether it learns, and its genes. The chosen agent is ringed, and so are its near kin." }),
    );
  }

  /** Fills the folded list of neutral genes; returns false if there are none. */
  private neutral(source: Source, life: Life): boolean {
    const genes = source.layout.species[life.species]!.genes.filter((g) => source.layout.genes[g]!.role === "neutral");
    this.folded.firstElementChild!.textContent = `${counted(genes.length, "neutral gene")}, without effect`;
    this.folded.lastElementChild!.replaceChildren(genome(source, life, (gene) => gene.role === "neutral"));
    return genes.length > 0;
  }

  private drawLearning(source: Source, life: Life): void {
    const windows = source.earned(life.id);
    if (windows) this.learning.draw(windows, source.layout.window);
  }

  /** The totals of a life. How they grew during it is not known, so the title gives the period they cover. */
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
    button.setAttribute("aria-label", `Agent ${id}`);
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
    const pen = surface(this.course);
    const [width, height] = [this.course.clientWidth, this.course.clientHeight];
    const [first, last] = [this.energies[0]![0], this.energies[this.energies.length - 1]![0]];
    const most = Math.max(1, ...this.energies.map(([, energy]) => energy));
    pen.strokeStyle = styleColor("--high");
    pen.lineWidth = 1.5;
    pen.beginPath();
    for (const [step, energy] of this.energies) {
      pen.lineTo(((step - first) / Math.max(last - first, 1)) * width, height - (energy / most) * (height - 20) - 4);
    }
    pen.stroke();
    pen.fillStyle = styleColor("--quiet");
    const text = `at most ${show(most)} of ${show(source.layout.energy_capacity)}, steps ${show(first)} to ${show(Math.floor(last))}`;
    pen.fillText(text, 3, 12);
    this.course.setAttribute("aria-label", `Energy: ${text}`);
  }
}

const unknown = (): HTMLElement => element("p", { class: "quiet", text: "Records contain only the reward of whole lives. A live world shows it for each window." });

function whenGone(life: Life, frame: Frame | undefined): string {
  if (frame && life.birth > frame.step) return "Not yet born at this step.";
  return life.death >= 0 ? "Dead at this step." : "No position is known at this step.";
}

/** The contents of each of its stores. */
function held(source: Source, frame: Frame, at: number): [string, string][] {
  return source.layout.species[frame.species[at]!]!.stores.map(({ name, capacity }, i) => {
    const amount = i === 0 ? frame.energy[at] : frame.held[name]?.[at];
    const known = amount !== undefined && !Number.isNaN(amount);
    return [name, known ? `${show(amount)} of ${show(capacity)}` : "not recorded"];
  });
}

function lifeTable(source: Source, life: Life, frame: Frame | undefined, at: number, link: (id: number) => HTMLElement): HTMLElement {
  const rows: [string, Node | string][] = [];
  const born = `born at ${show(life.birth)}${life.death >= 0 ? `, died at ${show(life.death)}` : ""}`;
  if (source.layout.species.length > 1) rows.push(["species", source.layout.species[life.species]!.name]);
  if (frame && at >= 0) rows.push(["age", `${counted(Math.floor(frame.step) - life.birth, "step")} (${born})`], ...held(source, frame, at));
  else rows.push(["life", born]);
  rows.push(["generation", show(life.generation)], ["parent", life.parent >= 0 ? link(life.parent) : "none, a founder"]);
  return table(rows);
}

/** The period over which a life's reward, children and meals are counted; it does not depend on the step shown. */
function countedUntil(source: Source, life: Life): string {
  if (life.death >= 0) return "in its whole life";
  return source.live ? `up to step ${show(source.last)}` : "up to the last record of it";
}

/** Every gene of its species, as a bar that starts at 0 in the middle. */
function genome(source: Source, life: Life, wanted: (gene: Gene) => boolean): HTMLElement {
  const genes = source.layout.species[life.species]!.genes.filter((g) => wanted(source.layout.genes[g]!));
  const limit = Math.max(0.1, ...genes.map((g) => Math.abs(life.genome[g]!)).filter(Number.isFinite));
  const rows = genes.map((g): [string, Node] => {
    const [gene, value] = [source.layout.genes[g]!, life.genome[g]!];
    const fill = element("i");
    const share = (50 * Math.abs(value)) / limit;
    fill.style.width = `${share}%`;
    fill.style.left = `${value < 0 ? 50 - share : 50}%`;
    const bar = element("div", { title: `${gene.name} = ${value}`, class: `gene ${gene.role} ${value < 0 ? "low" : "high"}` }, fill);
    return [gene.title, element("div", {}, bar, show(value, 3))];
  });
  const list = table(rows);
  list.classList.add("genome");
  return list;
}

/** The components of a life's reward that follow from its meals, and the rest. */
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

/** The intensity of each type at each nose, at most 1. */
function smellsOf(source: Source, frame: Frame, at: number): HTMLElement[] {
  const { layout } = source;
  const { smells } = layout.species[frame.species[at]!]!;
  if (smells.length === 0) return [];
  const sides = smell(source, frame, at);
  const text = (channel: number) => (sides.length === 1 ? show(sides[0]![channel]) : `left ${show(sides[1]![channel])}, right ${show(sides[0]![channel])}`);
  return [element("h3", { text: "what it smells" }), table(smells.map((type, channel): [string, string] => [layout.types[type]!, text(channel)]))];
}

/** Its observations other than rays and touch, in their units; only a live world has them. */
function observed(source: Source, species: Species): HTMLElement[] {
  const probe = source.agentProbe();
  if (!probe) return [];
  const rows = species.observed.map(({ name, unit, scale, meaning }, i): [string, Node] => {
    const value = show(probe.observed[i]! * scale, 3);
    return [name, element("span", { title: meaning, text: unit === "1" || unit === "amount" ? value : `${value} ${unit}` })];
  });
  return [element("h3", { text: "what else it observes" }), table(rows)];
}

/** The output of its network: the force of each motor, and the reward it expects. */
function answer(source: Source): HTMLElement[] {
  const probe = source.agentProbe();
  if (!probe) {
    const why = source.live ? "…" : "Networks are not recorded. In a live world you see its motors and what it expects.";
    return [element("p", { text: why, class: "quiet" })];
  }
  const [left, right, value] = probe.output;
  const motor = (name: string, action: number): [string, Node] => {
    const share = 100 / (1 + Math.exp(-action));
    const meter = Object.assign(element("meter"), { max: 100, value: share });
    meter.setAttribute("aria-label", name);
    return [name, element("div", { class: "motor" }, meter, `${share.toFixed(0)} %`)];
  };
  return [element("h3", { text: "what its network says" }), table([motor("left motor", left!), motor("right motor", right!), ["value of now", `${show(value)} reward to come`]])];
}

/** What its rays see now, in words and colors. */
function seenTitle(source: Source, frame: Frame, at: number): HTMLElement[] {
  const { layout } = source;
  const types = [...new Set(castRays(source, frame, at).map((ray) => ray.type))].filter((type) => type >= 0);
  const names = types.map((type) => {
    const dot = element("b", { text: "■" });
    dot.style.color = typeColor(layout, type) || "var(--wall)";
    return element("span", {}, dot, ` ${layout.types[type]}`);
  });
  return [element("h3", { text: "what it sees: left to right, taller is nearer" }), element("p", { class: "key" }, ...(names.length > 0 ? names : ["nothing"]))];
}

function drawSight(canvas: HTMLCanvasElement, source: Source, frame: Frame, at: number): void {
  const { layout } = source;
  const pen = surface(canvas);
  const rays = castRays(source, frame, at).reverse();
  const [width, height] = [canvas.clientWidth / rays.length, canvas.clientHeight];
  rays.forEach((ray, i) => {
    if (ray.type < 0) return;
    const tall = Math.max(3, (1 - ray.share) * height);
    pen.fillStyle = typeColor(layout, ray.type) || styleColor("--wall");
    pen.fillRect(i * width + 0.5, height - tall, width - 1, tall);
  });
  const seen = rays.filter((ray) => ray.type >= 0).map((ray) => layout.types[ray.type]);
  canvas.setAttribute("aria-label", seen.length > 0 ? `Its rays see, from left to right: ${seen.join(", ")}` : "Its rays see nothing");
}
