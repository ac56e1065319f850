// A world that the engine runs on this page, as a source of moments.
import { Bites } from "./bites";
import { counted } from "./element";
import { fileAddress, liveWorker } from "./files";
import { Lives } from "./lives";
import type { Actions, Edit, Moment, Order, Report } from "./live.worker";
import { columnOf, Series } from "./series";
import type { Source } from "./source";
import type { Frame, GeneLaw, Layout, Life, LiveWorld, AgentProbe, Place } from "./types";
import { type Earned, Windows } from "./windows";

export const SAMPLE_STEPS = 256; // between two points of the plots
const KEPT_FRAMES = 2000; // that the user can go back to

/** The world's text for the engine, with some settings changed and another seed. */
export function textOf(world: LiveWorld, changes: Map<string, string>, seed: number): string {
  const engine = new Map(world.settings.flatMap(({ engine, path }) => engine.map((name) => [name, changes.get(path)] as const)));
  const line = (text: string) => {
    const path = text.slice(0, text.indexOf("="));
    if (path === "seed") return `seed=${seed}`;
    const changed = engine.get(path);
    return changed === undefined ? text : `${path}=${changed}`;
  };
  return world.text.trimEnd().split("\n").map(line).join("\n") + "\n";
}

/** The layout with the genes' laws from the engine's text, since settings may have been changed. */
function lawful(layout: Layout, text: string): Layout {
  const values = new Map(text.split("\n").map((line) => [line.slice(0, line.indexOf("=")), line.slice(line.indexOf("=") + 1)]));
  const law = (s: number, i: number): GeneLaw => {
    const of = (name: string) => values.get(`layout[${s}].genes[${i}].${name}`)!;
    const [mean, sd] = ["law.initial_mean", "law.initial_sd"].map((name) => Number(of(name))) as [number, number];
    const [scale, df, probability, limit] = ["scale", "df", "probability", "limit"].map((name) => Number(of(`mutation.${name}`))) as [number, number, number, number];
    return { mean, sd, law: of("mutation.law"), scale, df, probability, limit };
  };
  const species = layout.species.map((each, s) => ({ ...each, laws: each.genes.map((_, i) => law(s, i)), mating: values.get(`species[${s}].birth.mating`)! }));
  return { ...layout, species, mutation_noise: values.get("world.mutation_noise")! };
}

export class Live implements Source {
  readonly live = true;
  readonly lives = new Lives();
  readonly series = new Series();
  readonly windows = new Windows();
  readonly bites = new Bites();
  readonly acts: { step: number; path: string; value: string }[] = []; // settings changed while the world ran
  readonly first = 0;
  readonly spacing = 1;
  readonly others = [];
  readonly loaded = true;
  readonly layout: Layout;
  last = 0;
  chosen = -1;
  fused = false;
  megabytes = 0;
  threads = 1;
  stepsPerSecond = 0;
  error = "";
  over = false;
  obstacles: Place[][] = [];
  edited = false;
  kept = -1; // step of the snapshot
  refused = ""; // why the last edit was refused, or ""
  onMoment: ((moment: Moment) => void) | undefined; // called with each new moment
  private due: { path: string; value: string; done: (refused: string) => void }[] = []; // changes that wait until no agent is learning
  private ready = false;
  private busy = false;
  private learning = 0;
  private known = "";
  private seen: AgentProbe | undefined;
  private readonly frames: Frame[] = [];
  private sampled = { step: 0, births: 0, deaths: 0 };
  private measured = { time: performance.now(), steps: 0 };
  private readonly worker = liveWorker();

  constructor(
    readonly world: LiveWorld,
    readonly changes: Map<string, string>,
    readonly seed: number,
    readonly wanted = 0, // threads; 0 lets the worker choose
  ) {
    this.worker.onmessage = ({ data }: MessageEvent<Report>) => this.take(data);
    const text = textOf(world, changes, seed);
    this.layout = lawful(world.layout, text);
    this.send({ type: "make", text, layout: world.layout, threads: wanted, modules: [fileAddress("hedon-relaxed.wasm"), fileAddress("hedon.wasm")] });
  }

  get title(): string {
    return this.world.name;
  }

  get runs(): [] {
    return [];
  }

  get seeds(): number[] {
    return [this.seed];
  }

  close(): void {
    this.worker.terminate();
  }

  get relawed(): number {
    return this.acts.find(({ path }) => path.includes("genome."))?.step ?? Infinity;
  }

  get ended(): boolean {
    return this.over;
  }

  readOthers(): void {} // a live world has one seed

  earned(id: number): Earned[] {
    return this.windows.of(id, this.lives.get(id)?.birth ?? 0);
  }

  status(): string {
    if (this.error) return "stopped";
    if (!this.ready) return "loading the engine …";
    if (this.over) return `${this.world.name}, seed ${this.seed}: died out`;
    const doing = this.learning > 0 ? `learning, ${counted(this.learning, "agent")} left` : `${this.stepsPerSecond.toFixed(0)} steps/s`;
    return `${this.world.name}, seed ${this.seed}, live: ${doing}`;
  }

  digest(): string {
    return this.known;
  }

  agentProbe(): AgentProbe | undefined {
    return this.seen?.id === this.chosen ? this.seen : undefined;
  }

  /**
   * Runs the world for some steps, but at most for this time. Returns false, and does nothing, while the previous order is running.
   * `trace` records the path of the chosen agent; `actions` are what that agent does if its policy is `external`.
   */
  advance(steps: number, milliseconds: number, options: { trace?: boolean; actions?: Actions } = {}): boolean {
    if (!this.ready || this.busy || this.error || (this.over && steps > 0)) return false;
    this.busy = true;
    // The digest reads the whole state, so it is requested only when the world is paused.
    this.send({ type: "advance", steps, milliseconds, chosen: this.chosen, digest: steps === 0, ...options });
    return true;
  }

  /** Edits the world by hand, takes a snapshot of it, or goes back to the snapshot. */
  act(edit: Edit): void {
    if (!this.ready || this.error) return;
    this.refused = "";
    this.busy = true;
    this.send({ type: "do", edit, chosen: this.chosen, digest: true });
  }

  /** Continues the world with another value of a setting as soon as no agent is learning. Resolves to the reason if it cannot, or to "". */
  change(path: string, value: string): Promise<string> {
    return new Promise((done) => {
      this.due.push({ path, value, done });
      this.settle();
    });
  }

  private settle(): void {
    const [next] = this.due;
    if (!next || !this.ready || this.busy || this.error) return;
    if (this.learning > 0) return void this.advance(0, 50);
    const now = new Map([...this.changes, ...this.acts.map((each) => [each.path, each.value] as const), [next.path, next.value]]);
    this.act({ type: "change", text: textOf(this.world, now, this.seed) });
  }

  /** Requests the moment again without a step, for another chosen agent or for the digest. */
  look(): void {
    if (this.known === "" || (this.chosen >= 0 && this.seen?.id !== this.chosen)) this.advance(0, 5);
  }

  around(step: number): { before?: Frame; after?: Frame } {
    const at = this.frames.findLastIndex((frame) => frame.step <= step);
    return { before: this.frames[Math.max(at, 0)], after: this.frames[at + 1] };
  }

  async moments(after: number, take: (frame: Frame) => boolean): Promise<void> {
    for (const frame of this.frames) if (frame.step > after && !take(frame)) return;
  }

  private send(order: Order): void {
    this.worker.postMessage(order);
  }

  private take(report: Report): void {
    this.busy = false;
    if (report.type === "error") this.error = report.text;
    else if (report.type === "made") {
      this.ready = true;
      this.fused = report.fused;
      this.threads = report.threads;
      this.megabytes = report.bytes / 1e6;
      this.obstacles = report.obstacles;
      this.advance(0, 1);
    } else {
      this.add(report.moment);
      const { refused } = report.moment;
      if (report.moment.edit === "change") this.due.shift()?.done(refused);
      this.settle();
    }
  }

  private add(moment: Moment): void {
    const { frame } = moment;
    this.learning = moment.learning;
    this.known = moment.digest;
    this.over = moment.over;
    this.seen = moment.agentProbe;
    this.edited = moment.edited;
    this.kept = moment.kept;
    if (moment.refused && moment.edit !== "change") this.refused = moment.refused;
    if (moment.edit === "back" && !moment.refused) this.rewind(frame.step, moment.counts);
    if (moment.edit === "change" && !moment.refused) this.acts.push({ step: frame.step, path: this.due[0]!.path, value: this.due[0]!.value });
    for (const end of moment.ends) this.windows.add(end);
    this.bites.add(moment.bites);
    for (const life of moment.dead) this.lives.put(life);
    for (const life of moment.lives) this.lives.put(life);
    if (this.frames[this.frames.length - 1]?.step === frame.step) this.frames.pop(); // it may have been edited by hand
    this.frames.push(frame);
    if (this.frames.length > KEPT_FRAMES) this.frames.shift();
    this.last = frame.step;
    this.measure(moment.done);
    if (frame.step >= this.sampled.step + SAMPLE_STEPS || moment.over) this.sample(moment);
    this.onMoment?.(moment);
  }

  private rewind(step: number, counts: Record<string, number>): void {
    this.lives.rewind(step);
    this.series.rewind(step);
    this.windows.rewind(step);
    this.bites.rewind(step);
    this.frames.length = this.frames.findLastIndex((frame) => frame.step < step) + 1;
    this.sampled = { step, births: counts.births!, deaths: counts.deaths! };
  }

  private measure(steps: number): void {
    const now = performance.now();
    this.measured.steps += steps;
    const seconds = (now - this.measured.time) / 1000;
    if (seconds < 1) return;
    this.stepsPerSecond = this.measured.steps / seconds;
    this.measured = { time: now, steps: 0 };
  }

  private sample(moment: Moment): void {
    const { lives, frame, counts } = moment;
    const row: Record<string, number> = { alive: lives.length };
    row.births = counts.births! - this.sampled.births;
    row.deaths = counts.deaths! - this.sampled.deaths;
    row.generation_max = lives.reduce((most, life) => Math.max(most, life.generation), 0);
    this.layout.species.forEach((species, s) => {
      const members = lives.filter((life) => life.species === s);
      const mean = (of: (life: Life) => number) => members.reduce((sum, life) => sum + of(life), 0) / members.length;
      const put = (name: string, value: number) => (row[columnOf(this.layout, species, name)] = value);
      put("alive", members.length);
      put("energy_mean", mean((life) => life.energy));
      for (const g of species.genes) put(`${this.layout.genes[g]!.name}_mean`, mean((life) => life.genome[g]!));
    });
    this.layout.foods.forEach((food, k) => {
      row[`food_${food.name}`] = frame.foodKind.reduce((count, kind) => count + (kind === k ? 1 : 0), 0);
    });
    this.series.add(frame.step, row);
    this.sampled = { step: frame.step, births: counts.births!, deaths: counts.deaths! };
  }
}
