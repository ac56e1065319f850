// Runs a world away from the page's thread, a little at a time, and answers with what is to be drawn.
import { Engine } from "./engine.js";
import type { Frame, Layout, Life, Mind } from "./types";

export type Order =
  | { type: "make"; text: string; layout: Layout }
  | { type: "advance"; steps: number; milliseconds: number; chosen: number; digest: boolean };

export interface Moment {
  frame: Frame;
  lives: Life[];
  dead: Life[];
  counts: Record<string, number>;
  mind?: Mind;
  learning: number; // agents that still have to learn before the next step
  done: number; // steps of this order
  over: boolean;
  digest: string; // "" unless it was asked for and no window is being learned
}
export type Report = { type: "made"; fused: boolean; bytes: number } | { type: "moment"; moment: Moment } | { type: "error"; text: string };

const PIECE = 4; // learners between two looks at the clock
let engine: Engine | undefined;
let layout: Layout | undefined;

async function module(name: string): Promise<WebAssembly.Module | undefined> {
  const bytes = await (await fetch(new URL(`../${name}`, self.location.href))).arrayBuffer();
  return WebAssembly.validate(bytes) ? WebAssembly.compile(bytes) : undefined;
}

/** The module that fuses multiply-adds where this machine does so, since its digests are those of most machines. */
async function load(): Promise<Engine> {
  const relaxed = await module("hedon-relaxed.wasm");
  if (relaxed) {
    const fast = new Engine(relaxed);
    if (fast.fuses) return fast;
  }
  const plain = await module("hedon.wasm");
  if (!plain) throw new Error("this browser cannot run the engine: it needs WebAssembly with SIMD");
  return new Engine(plain);
}

async function make(order: Order & { type: "make" }): Promise<Report> {
  engine = undefined;
  const fresh = await load();
  const bytes = fresh.make(order.text);
  engine = fresh;
  layout = order.layout;
  return { type: "made", fused: fresh.fuses, bytes };
}

/** The species of a slot: each owns as many slots as it has capacity, one after the other. */
function speciesOf(slot: number): number {
  let [species, end] = [0, layout!.species[0]!.capacity];
  while (slot >= end) end += layout!.species[++species]!.capacity;
  return species;
}

/** A genome by the layout's genes, from a row of the engine, which has those of the species. */
function genome(row: Float32Array, species: number): number[] {
  const out = new Array<number>(layout!.genes.length).fill(NaN);
  layout!.species[species]!.genes.forEach((gene, g) => (out[gene] = row[g]!));
  return out;
}

function lives(world: Engine, prefix: string, rows: ArrayLike<number>): Life[] {
  const column = (name: string) => world.view(`${prefix === "life" ? "life" : "event"}.${name}`)!;
  const [id, parent, generation] = [column("agent_id"), column("parent_id"), column("generation")];
  const [birth, death, energy] = [column("birth_step"), column("death_step"), column("energy")];
  const [children, reward] = [column("children"), column("reward")];
  const eaten = world.view(prefix === "life" ? "eaten" : "event_eaten") as Int32Array;
  const genomes = world.view(prefix === "life" ? "genome" : "event_genome") as Float32Array;
  const species = prefix === "life" ? undefined : world.view("event_species")!;
  const [meals, genes] = [layout!.meals.length, Math.max(...layout!.species.map((each) => each.genes.length))];
  return Array.from(rows, (row) => ({
    id: Number(id[row]),
    parent: Number(parent[row]),
    generation: Number(generation[row]),
    birth: Number(birth[row]),
    death: Number(death[row]),
    energy: Number(energy[row]),
    children: Number(children[row]),
    reward: Number(reward[row]),
    eaten: Array.from(eaten.subarray(row * meals, (row + 1) * meals)),
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
    species: Uint8Array.from(living, speciesOf),
    foodX: Float32Array.from(foods, (i) => Number(fx[i])),
    foodY: Float32Array.from(foods, (i) => Number(fy[i])),
    foodKind: Uint8Array.from(kinds),
  };
}

/** Steps and learns until the steps are done or the time is over; returns the steps done. */
function advance(world: Engine, steps: number, milliseconds: number): number {
  const end = performance.now() + milliseconds;
  let done = 0;
  while (done < steps || world.mustLearn) {
    if (world.mustLearn) world.learn(PIECE);
    else {
      const stepped = world.run(1);
      if (stepped === 0) break;
      done += stepped;
    }
    if (performance.now() >= end) break;
  }
  return done;
}

function moment(world: Engine, done: number, { chosen, digest }: Order & { type: "advance" }): Moment {
  const living = (world.view("living") as Int32Array).slice(0, world.number("head.living_count"));
  const waiting = world.number("head.event_count");
  const dead = lives(world, "event", Array.from({ length: waiting }, (_, i) => i));
  world.takeDeaths();
  const here = frame(world, living);
  const at = here.id.indexOf(chosen);
  const counts = Object.fromEntries(["births", "deaths"].map((name) => [name, world.sum(`counters.${name}`)]));
  const learning = world.mustLearn ? world.learn(0) : 0;
  return {
    frame: here,
    lives: lives(world, "life", living),
    dead,
    counts,
    mind: at >= 0 ? { id: chosen, ...world.mind(living[at]!) } : undefined,
    learning,
    done,
    over: living.length === 0,
    digest: learning || !digest ? "" : world.digest(),
  };
}

self.onmessage = async ({ data }: MessageEvent<Order>) => {
  try {
    if (data.type === "make") self.postMessage(await make(data));
    else if (engine) {
      const done = advance(engine, data.steps, data.milliseconds);
      self.postMessage({ type: "moment", moment: moment(engine, done, data) } satisfies Report);
    }
  } catch (error) {
    self.postMessage({ type: "error", text: error instanceof Error ? error.message : String(error) } satisfies Report);
  }
};
