// What a world consists of and what a moment of it is, as the page knows them. No word here is about one kind of world.

export interface Gene {
  name: string;
  role: "reward" | "learning" | "setting" | "rule" | "neutral";
  input: string;
  title: string; // in plain words
  unit: string; // "" where there is none
  color: string;
}

/** How a gene begins, by a normal law, and what a birth adds to it: with `probability` noise of a law and a scale. */
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
  sets: { place: string; gene: number; low: number; high: number }[]; // numbers that genes of the layout multiply
  genes: number[]; // of the layout's genes, in the order of the genome
  laws: GeneLaw[]; // of each of them
  mating: string; // "pairs" where children have two parents
  stores: { name: string; capacity: number }[]; // energy first
  observed: { name: string; unit: string; scale: number; meaning: string }[]; // beside rays and touch
  reward: { meals: { meal: number; gene: number; coef: number }[]; rest: string[] }; // what meals tell of it, and the rest
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
  mutation_noise: string; // "tabulated" where births share it
  founders: boolean; // whether they come from a table
}

export type Place = [number, number];

/** Everything that has a place at one moment. Agents are in the order of their ids. */
export interface Frame {
  step: number;
  id: Int32Array;
  x: Float32Array;
  y: Float32Array;
  angle: Float32Array;
  energy: Float32Array;
  held: Record<string, Float32Array>; // of each store beside energy, as far as it is known; NaN for species without it
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
  lastMeal: number; // what it ate last, -1 for nothing; only a live world knows it
  species: number;
  genome: number[]; // by the layout's genes; NaN for one that its species lacks
}

/** What an agent senses now and how its network answers; only a live world knows it. */
export interface AgentProbe {
  id: number;
  reading: Float32Array; // distance + 1, 0 for nothing
  type: Uint8Array;
  output: Float32Array; // two actions, then the value
  observed: Float32Array; // beside rays and touch, in the order of its species
}

/** Something that happened, for the time line. */
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
  at_once: boolean; // whether a world that has begun can go on with another value
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
  toml: string; // the whole config, for a world that no preset names; else ""
  layout: Layout;
  text: string;
  settings: Setting[];
}

export interface Part {
  file: string;
  bytes: number;
  worlds?: ([number, number] | null)[]; // of frames: first and last step of each world
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
}
