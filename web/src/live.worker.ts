// Runs a world off the page's thread, a little at a time, and answers with the data to be drawn.
import { compile, Engine, EngineError, type Post } from "./engine.js";
import { LastMeals } from "./meals";
import type { Frame, Layout, Life, AgentProbe, Place } from "./types";
import type { WindowEnd } from "./windows";

/** An edit of a world by hand. A type is the index of a species, or of a food after all species. */
export type Edit =
  | { type: "add"; kind: number; x: number; y: number }
  | { type: "remove"; x: number; y: number; slack: number }
  | { type: "change"; text: string }
  | { type: "keep" }
  | { type: "back" };
export type Order =
  | { type: "make"; text: string; layout: Layout; threads: number; modules: [string, string] } // addresses: with fused multiply-adds, and without
  | { type: "do"; edit: Edit; chosen: number; digest: boolean }
  | { type: "advance"; steps: number; milliseconds: number; chosen: number; digest: boolean; trace?: boolean; actions?: Actions };
/** The actions of an agent whose policy is `external`, before the sigmoid: left motor, right motor. */
export type Actions = [number, number];

export interface Moment {
  frame: Frame;
  lives: Life[];
  dead: Life[];
  counts: Record<string, number>;
  agentProbe?: AgentProbe;
  learning: number; // agents that have yet to learn before the next step
  done: number; // steps of this order
  trace: Float32Array; // x, y of the chosen agent after each step of this order, if requested
  over: boolean;
  bites: Float32Array; // meals since the last moment: step, x, y, and the index among the layout's meals
  ends: WindowEnd[]; // of the windows that have ended since the last moment
  edit?: Edit["type"]; // the edit that was made
  digest: string; // "" unless it was requested and no window is being learned
  edited: boolean; // whether the world has been edited by hand
  kept: number; // step of the snapshot; -1 if there is none
  refused: string; // why the edit was refused, or ""
}
export type Report = { type: "made"; fused: boolean; bytes: number; threads: number; obstacles: Place[][] } | { type: "moment"; moment: Moment } | { type: "error"; text: string };

const PIECE = 2; // learners per thread between two looks at the clock
const START_MS = 20_000; // time limit for starting a thread
const SHARED = self.crossOriginIsolated; // otherwise the browser cannot share memory, and there is one thread
const USUAL_THREADS = 4; // by default at most, so that the page does not occupy a large machine
let engine: Engine | undefined;
let layout: Layout | undefined;
let meals = new LastMeals();
let ends: WindowEnd[] = [];
let bites: number[] = [];
let kept: { step: number; meals: LastMeals } | undefined;

async function module(address: string): Promise<WebAssembly.Module | undefined> {
  const bytes = new Uint8Array(await (await fetch(address)).arrayBuffer());
  return WebAssembly.validate(bytes) ? compile(bytes, SHARED) : undefined;
}

/** Loads the module with fused multiply-adds if this machine fuses them, since its digests match those of most machines. */
async function load([fusing, usual]: [string, string]): Promise<WebAssembly.Module> {
  const relaxed = await module(fusing);
  if (relaxed && new Engine(relaxed, SHARED).fuses) return relaxed;
  const plain = await module(usual);
  if (!plain) throw new Error("this browser cannot run the engine: it needs WebAssembly with SIMD and atomic operations");
  return plain;
}

/** Starts a worker as a thread of the engine; resolves to a function that ends it. */
function hire(post: Post): Promise<() => void> {
  const worker = new Worker(new URL("./member.worker.ts", import.meta.url), { type: "module" });
  return new Promise((ready, fail) => {
    const refuse = (why: string) => {
      worker.terminate();
      fail(new Error(why));
    };
    const late = setTimeout(() => refuse("it does not answer"), START_MS);
    worker.onmessage = () => {
      clearTimeout(late);
      ready(() => worker.terminate());
    };
    worker.onerror = (event) => {
      event.preventDefault();
      clearTimeout(late);
      refuse(event.message || "its program cannot be loaded");
    };
    worker.postMessage(post);
  });
}

async function make(order: Order & { type: "make" }): Promise<Report> {
  engine?.close();
  engine = undefined;
  const threads = SHARED ? order.threads || Math.min(USUAL_THREADS, navigator.hardwareConcurrency) : 1;
  const fresh = await Engine.make(await load(order.modules), order.text, { shared: SHARED, threads, hire });
  engine = fresh;
  layout = order.layout;
  meals = new LastMeals();
  kept = undefined;
  [ends, bites] = [[], []];
  return { type: "made", fused: fresh.fuses, bytes: fresh.bytes, threads, obstacles: obstacles(fresh) };
}

/** The corners of each obstacle. */
function obstacles(world: Engine): Place[][] {
  const corners = layout!.obstacle_corners;
  const places = corners > 0 ? (world.view("obstacle") as Float32Array) : new Float32Array();
  const corner = (i: number): Place => [places[2 * i]!, places[2 * i + 1]!];
  return Array.from({ length: places.length / 2 / (corners || 1) }, (_, o) => Array.from({ length: corners }, (_, c) => corner(o * corners + c)));
}

/** The species of a slot. The slots of each species are contiguous, as many as its capacity. */
function speciesOf(slot: number): number {
  let [species, end] = [0, layout!.species[0]!.capacity];
  while (slot >= end) end += layout!.species[++species]!.capacity;
  return species;
}

/** A genome in the order of the layout's genes, from a row of the engine, which has only the genes of the species. */
function genome(row: Float32Array, species: number): number[] {
  const out = new Array<number>(layout!.genes.length).fill(NaN);
  layout!.species[species]!.genes.forEach((gene, g) => (out[gene] = row[g]!));
  return out;
}

function lives(world: Engine, prefix: string, rows: ArrayLike<number>): Life[] {
  const column = (name: string) => world.view(`${prefix === "life" ? "life" : "death_log"}.${name}`)!;
  const [id, parent, generation] = [column("agent_id"), column("parent_id"), column("generation")];
  const [birth, death, energy] = [column("birth_step"), column("death_step"), column("energy")];
  const [children, reward] = [column("children"), column("reward")];
  const eaten = world.view(prefix === "life" ? "eaten" : "death_log_eaten") as Int32Array;
  const genomes = world.view(prefix === "life" ? "genome" : "death_log_genome") as Float32Array;
  const species = prefix === "life" ? undefined : world.view("death_log_species")!;
  const [kinds, genes] = [layout!.meals.length, Math.max(...layout!.species.map((each) => each.genes.length))];
  return Array.from(rows, (row) => ({
    id: Number(id[row]),
    parent: Number(parent[row]),
    generation: Number(generation[row]),
    birth: Number(birth[row]),
    death: Number(death[row]),
    energy: Number(energy[row]),
    children: Number(children[row]),
    reward: Number(reward[row]),
    eaten: Array.from(eaten.subarray(row * kinds, (row + 1) * kinds)),
    lastMeal: prefix === "life" ? meals.of(row) : -1,
    species: species ? Number(species[row]) : speciesOf(row),
    genome: genome(genomes.subarray(row * genes, (row + 1) * genes), species ? Number(species[row]) : speciesOf(row)),
  }));
}

function frame(world: Engine, living: Int32Array): Frame {
  const body = (name: string) => world.view(`physics.bodies.${name}`) as Float32Array;
  const [x, y, angle] = [body("x"), body("y"), body("angle")];
  const [id, energy] = [world.view("life.agent_id")!, world.view("life.energy")!];
  const present = world.view("physics.circles.present") as Uint8Array;
  const [fx, fy] = [world.view("physics.circles.x")!, world.view("physics.circles.y")!];
  const foods: number[] = [];
  const kinds: number[] = [];
  for (let k = 0; k < layout!.foods.length; k++) {
    for (let i = world.foodStart(k); i < world.foodStart(k + 1); i++) {
      if (present[i]) {
        foods.push(i);
        kinds.push(k);
      }
    }
  }
  return {
    step: world.number("head.step"),
    id: Int32Array.from(living, (slot) => Number(id[slot])),
    x: Float32Array.from(living, (slot) => x[slot]!),
    y: Float32Array.from(living, (slot) => y[slot]!),
    angle: Float32Array.from(living, (slot) => angle[slot]!),
    energy: Float32Array.from(living, (slot) => Number(energy[slot])),
    held: held(world, living),
    species: Uint8Array.from(living, speciesOf),
    foodX: Float32Array.from(foods, (i) => Number(fx[i])),
    foodY: Float32Array.from(foods, (i) => Number(fy[i])),
    foodKind: Uint8Array.from(kinds),
  };
}

/** The contents of each store other than energy, for all living agents. */
function held(world: Engine, living: Int32Array): Record<string, Float32Array> {
  const { species } = layout!;
  const width = Math.max(...species.map(({ stores }) => stores.length)) - 1;
  if (width === 0) return {};
  const store = world.view("store") as Float64Array;
  const names = new Set(species.flatMap(({ stores }) => stores.slice(1).map(({ name }) => name)));
  const of = (name: string, slot: number) => {
    const at = species[speciesOf(slot)]!.stores.findIndex((each) => each.name === name);
    return at > 0 ? store[slot * width + at - 1]! : NaN;
  };
  return Object.fromEntries([...names].map((name) => [name, Float32Array.from(living, (slot) => of(name, slot))]));
}

/** The slot of an agent, or -1 if it is not alive. */
function slotOf(world: Engine, id: number): number {
  if (id < 0) return -1;
  const [ids, living] = [world.view("life.agent_id")!, world.view("living") as Int32Array];
  return living.subarray(0, world.number("head.living_count")).find((slot) => Number(ids[slot]) === id) ?? -1;
}

/** The reward and the meals of each living agent so far. */
function windowEnd(world: Engine): WindowEnd {
  const living = (world.view("living") as Int32Array).slice(0, world.number("head.living_count"));
  const [id, reward] = [world.view("life.agent_id")!, world.view("life.reward")!];
  const [eaten, kinds] = [world.view("eaten") as Int32Array, layout!.meals.length];
  return {
    step: world.number("head.step"),
    id: Int32Array.from(living, (slot) => Number(id[slot])),
    reward: Float32Array.from(living, (slot) => Number(reward[slot])),
    meals: Int32Array.from(living, (slot) => eaten.subarray(slot * kinds, (slot + 1) * kinds).reduce((sum, each) => sum + each, 0)),
  };
}

/** Continues with other settings. The engine may move agents to other slots. */
function change(world: Engine, text: string): void {
  const ids = () => Array.from(world.view("life.agent_id")!, Number);
  const before = ids();
  world.change(text);
  meals = meals.moved(before, ids());
  kept = undefined;
}

/** Steps and learns until the steps are done or the time is up; returns the steps done and the path of the chosen agent. */
function advance(world: Engine, order: Order & { type: "advance" }): { done: number; trace: Float32Array } {
  const { steps, milliseconds, chosen, actions } = order;
  const end = performance.now() + milliseconds;
  const slot = order.trace || actions ? slotOf(world, chosen) : -1;
  if (actions && slot >= 0) (world.view("external_action") as Float32Array).set(actions, slot * actions.length);
  const trace: number[] = [];
  let done = 0;
  while (done < steps || world.mustLearn) {
    if (world.mustLearn) world.learn(PIECE * world.threads);
    else {
      const stepped = world.run(1);
      if (stepped === 0) break;
      done += stepped;
      if (world.mustLearn) ends.push(windowEnd(world));
      meals.note(world.view("eaten") as Int32Array, layout!.meals.length, (slot, kind) => {
        const [x, y] = ["x", "y"].map((axis) => Number(world.view(`physics.bodies.${axis}`)![slot]));
        bites.push(world.number("head.step"), x!, y!, kind);
      });
      if (order.trace && slot >= 0 && Number(world.view("life.agent_id")![slot]) === chosen) {
        for (const axis of ["x", "y"]) trace.push(Number(world.view(`physics.bodies.${axis}`)![slot]));
      }
    }
    if (performance.now() >= end) break;
  }
  return { done, trace: Float32Array.from(trace) };
}

/** Makes an edit; returns the reason if it is refused, or "". */
function act(world: Engine, edit: Edit): string {
  try {
    if (edit.type === "add") world.add(edit.kind, edit.x, edit.y);
    else if (edit.type === "remove") world.remove(edit.x, edit.y, edit.slack);
    else if (edit.type === "change") change(world, edit.text);
    else if (edit.type === "keep") {
      world.keep();
      kept = { step: world.number("head.step"), meals: meals.copy() };
    } else {
      world.goBack();
      meals = kept!.meals.copy();
    }
    meals.note(world.view("eaten") as Int32Array, layout!.meals.length);
    return "";
  } catch (error) {
    if (error instanceof EngineError) return error.message;
    throw error;
  }
}

interface Outcome {
  done: number;
  trace: Float32Array;
  edit?: Edit["type"];
  refused: string;
}

function moment(world: Engine, { done, trace, refused, edit }: Outcome, { chosen, digest }: { chosen: number; digest: boolean }): Moment {
  const living = (world.view("living") as Int32Array).slice(0, world.number("head.living_count"));
  const waiting = world.number("head.death_log_count");
  const dead = lives(world, "death_log", Array.from({ length: waiting }, (_, i) => i));
  world.takeDeaths();
  const here = frame(world, living);
  const at = here.id.indexOf(chosen);
  const counts = Object.fromEntries(["births", "deaths"].map((name) => [name, world.sum(`counters.${name}`)]));
  const learning = world.mustLearn ? world.learn(0) : 0;
  const [ended, eaten] = [ends, Float32Array.from(bites)];
  [ends, bites] = [[], []];
  return {
    frame: here,
    lives: lives(world, "life", living),
    dead,
    counts,
    agentProbe: at >= 0 ? { id: chosen, ...world.probeAgent(living[at]!) } : undefined,
    learning,
    done,
    trace,
    bites: eaten,
    ends: ended,
    edit,
    over: living.length === 0,
    digest: learning || !digest ? "" : world.digest(),
    edited: world.edited,
    kept: kept?.step ?? -1,
    refused,
  };
}

self.onmessage = async ({ data }: MessageEvent<Order>) => {
  try {
    if (data.type === "make") self.postMessage(await make(data));
    else if (engine) {
      const outcome: Outcome = { done: 0, trace: new Float32Array(), refused: "" };
      if (data.type === "advance") Object.assign(outcome, advance(engine, data));
      else [outcome.edit, outcome.refused] = [data.edit.type, act(engine, data.edit)];
      self.postMessage({ type: "moment", moment: moment(engine, outcome, data) } satisfies Report);
    }
  } catch (error) {
    engine?.close();
    engine = undefined;
    self.postMessage({ type: "error", text: error instanceof Error ? error.message : String(error) } satisfies Report);
  }
};
