// Types of a world's layout and of its moments. Nothing here is specific to one kind of world.

export interface Gene {
  name: string;
  role: "reward" | "learning" | "setting" | "rule" | "neutral";
  input: string;
  title: string; // in plain language
  unit: string; // "" if there is none
  color: string;
}

/** The normal distribution of a gene in founders, and the noise that a birth adds to it with `probability`. */
export interface GeneLaw {
  mean: number;
  sd: number;
  law: string;
  scale: number;
  df: number;
  probability: number;
  limit: number;
}

export interface Species {
  name: string;
  color: string;
  capacity: number;
  radius: number;
  mouth_degrees: number;
  mouth_center_degrees: number;
  rays: { count: number; spread_degrees: number; length: number };
  sees: number[]; // types, by channel
  noses: { count: number; degrees: number; decay: number };
  smells: number[]; // types, by channel
  sets: { place: string; gene: number; low: number; high: number }[]; // settings that genes of the layout multiply
  genes: number[]; // indices into the layout's genes, in the order of the genome
  laws: GeneLaw[]; // for each of them
  mating: string; // "pairs" if children have two parents
  stores: { name: string; capacity: number }[]; // energy first
  observed: { name: string; unit: string; scale: number; meaning: string }[]; // other than rays and touch
  reward: { meals: { meal: number; gene: number; coef: number }[]; rest: string[] }; // terms from meals, and the names of the others
}

export interface Layout {
  species: Species[];
  types: string[];
  foods: { name: string; radius: number; energy: number; color: string }[];
  genes: Gene[];
  meals: string[];
  obstacle_corners: number;
  obstacle_color: string;
  arena: { width: number; height: number; walls: [number, number, number, number][] };
  window: number;
  energy_capacity: number;
  mutation_noise: string; // "tabulated" if births share it
  founders: boolean; // whether founders come from a table
}

export type Place = [number, number];

/** Everything with a position at one moment. Agents are in the order of their ids. */
export interface Frame {
  step: number;
  id: Int32Array;
  x: Float32Array;
  y: Float32Array;
  angle: Float32Array;
  energy: Float32Array;
  held: Record<string, Float32Array>; // of each store other than energy, as far as it is known; NaN for species without it
  species: Uint8Array;
  foodX: Float32Array;
  foodY: Float32Array;
  foodKind: Uint8Array;
}

/** One life, as far as it is known. */
export interface Life {
  id: number;
  parent: number; // -1 for founders
  generation: number;
  birth: number;
  death: number; // -1 while alive
  energy: number;
  children: number;
  reward: number;
  eaten: number[]; // by meal
  lastMeal: number; // index of its last meal, -1 for none; only a live world has it
  species: number;
  genome: number[]; // in the order of the layout's genes; NaN for a gene that its species lacks
}

/** What an agent senses now and its network's output; only a live world has it. */
export interface AgentProbe {
  id: number;
  reading: Float32Array; // distance + 1, 0 for nothing
  type: Uint8Array;
  output: Float32Array; // two actions, then the value
  observed: Float32Array; // observations other than rays and touch, in the order of its species
}

/** An event on the time line. */
export interface Event {
  step: number;
  text: string;
}

export interface Setting {
  path: string;
  engine: string[];
  value: number | string | boolean;
  choices: string[];
  whole: boolean;
  at_once: boolean; // whether a running world can take another value
  ge: number | null;
  gt: number | null;
  le: number | null;
  lt: number | null;
  unit: string;
  meaning: string;
  allowed: string;
}

export interface LiveWorld {
  name: string;
  description: string;
  source: string;
  fidelity: string;
  toml: string; // the complete config, for a world without a preset; otherwise ""
  layout: Layout;
  text: string;
  settings: Setting[];
}

export interface Part {
  file: string;
  bytes: number;
  worlds?: ([number, number] | null)[]; // for frames: first and last step of each world
  damaged?: boolean;
}

export interface RunIndex {
  name: string;
  folder: string;
  status: string;
  seeds: number[];
  steps: number[];
  asked: number;
  extinct: (number | null)[];
  frames: number;
  digests: string[];
  obstacles?: Place[][][]; // of each world
  layout: Layout;
  settings: { base: string; changed: [path: string, value: string, base: string][]; all: [path: string, value: string, meaning: string][] };
  files: { agents: Part[]; population: Part[]; frames: Part[] };
  others: { run: string; seeds: number[]; files: string[] }[]; // further runs whose curves are drawn
}
