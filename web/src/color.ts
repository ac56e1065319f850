// What an agent's color means, for any world: names and values come from its layout and its lives.
import type { Source } from "./source";
import type { Frame, Layout, Life } from "./types";

type Rgb = [number, number, number];

// Dark to bright in even steps that the color-blind can follow (after Crameri's "batlow").
const RAMP: Rgb[] = [[1, 25, 89], [16, 63, 96], [28, 90, 98], [60, 109, 86], [104, 123, 62], [157, 137, 43], [210, 147, 67], [248, 161, 123], [253, 183, 188], [250, 204, 250]];
const DIVERGING: Rgb[] = [[0, 90, 160], [90, 160, 205], [205, 205, 205], [230, 150, 90], [190, 70, 0]];
const DISTINCT: Rgb[] = [[0, 114, 178], [213, 94, 0], [0, 158, 115], [230, 159, 0], [204, 121, 167], [86, 180, 233], [94, 79, 162], [150, 150, 60], [120, 60, 40], [60, 120, 120]];

export interface Coloring {
  name: string;
  label: string;
  /** Value of an agent, from its life and the frame; NaN for unknown. */
  value(life: Life | undefined, frame: Frame, i: number): number;
  scale: "ramp" | "diverging" | "distinct" | "food";
  /** The things that it tells apart, where they have names. */
  key?: { name: string; color: string }[];
  low?: number;
  high?: number;
}

function along(stops: Rgb[], share: number): Rgb {
  const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(at), stops.length - 2);
  const [a, b, t] = [stops[i]!, stops[i + 1]!, at - i];
  return [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t];
}

export const pack = ([r, g, b]: Rgb, alpha = 255): number => ((alpha << 24) | (b << 16) | (g << 8) | r) >>> 0;

export function parse(hex: string): Rgb {
  const value = /^#[0-9a-f]{6}$/i.test(hex) ? parseInt(hex.slice(1), 16) : 0x888888;
  return [value >> 16, (value >> 8) & 255, value & 255];
}

export const css = ([r, g, b]: Rgb): string => `rgb(${r.toFixed(0)} ${g.toFixed(0)} ${b.toFixed(0)})`;

/** Everything that agents of this world can be colored by. */
export function colorings(source: Source): Coloring[] {
  const { layout, lives } = source;
  const mostEaten = (life: Life | undefined) => {
    const most = life ? Math.max(...life.eaten) : 0;
    return life && most > 0 ? life.eaten.indexOf(most) : NaN;
  };
  // Counts of a life have no course in the records, and a live world knows them at its newest step.
  const counted = source.live ? "up to the newest step" : "of the whole life";
  const key = layout.species.map((each, i) => ({ name: each.name, color: css(distinctColor(i)) }));
  const species: Coloring = { name: "species", label: "species", scale: "distinct", key, value: (_, frame, i) => frame.species[i]! };
  // Records count the meals of a life and not their order.
  const lastMeal: Coloring = { name: "last", label: "ate last", scale: "food", value: (life) => (life && life.lastMeal >= 0 ? life.lastMeal : NaN) };
  return [
    { name: "energy", label: "energy", scale: "ramp", low: 0, value: (_, frame, i) => frame.energy[i]! },
    { name: "age", label: "age [steps]", scale: "ramp", low: 0, value: (life, frame) => (life ? frame.step - life.birth : NaN) },
    { name: "generation", label: "generation", scale: "ramp", value: (life) => life?.generation ?? NaN },
    { name: "children", label: `children ${counted}`, scale: "ramp", low: 0, value: (life) => life?.children ?? NaN },
    { name: "reward", label: `reward ${counted}`, scale: "diverging", value: (life) => life?.reward ?? NaN },
    { name: "family", label: "family (founder)", scale: "distinct", value: (life) => (life ? lives.founder(life.id) : NaN) },
    ...(layout.species.length > 1 ? [species] : []),
    { name: "eats", label: `most frequent meal ${counted}`, scale: "food", value: mostEaten },
    ...(source.live ? [lastMeal] : []),
    ...layout.genes.map((gene, g): Coloring => ({
      name: gene.name,
      label: `gene ${gene.name}${gene.role === "neutral" ? " (neutral)" : ""}`,
      scale: "diverging",
      value: (life) => life?.genome[g] ?? NaN,
    })),
  ];
}

export interface Painted {
  colors: Uint32Array;
  legend: { low: number; high: number; stops: string[] };
}

/** The color of each agent of a frame, and what the ends of the scale are. */
export function paint(coloring: Coloring, source: Source, frame: Frame, out: Uint32Array): Painted {
  const count = frame.id.length;
  const values = new Float32Array(count);
  let [low, high] = [Infinity, -Infinity];
  for (let i = 0; i < count; i++) {
    const value = (values[i] = coloring.value(source.lives.get(frame.id[i]!), frame, i));
    if (value < low) low = value;
    if (value > high) high = value;
  }
  if (coloring.low !== undefined) low = coloring.low;
  if (coloring.high !== undefined) high = coloring.high;
  if (coloring.scale === "diverging") [low, high] = [-Math.max(-low, high, 1e-6), Math.max(-low, high, 1e-6)];
  const stops = coloring.scale === "diverging" ? DIVERGING : RAMP;
  const table = Uint32Array.from({ length: 256 }, (_, i) => pack(along(stops, i / 255)));
  const meals = source.layout.meals.map((meal) => pack(parse(mealColor(source.layout, meal))));
  const scale = 255 / (high - low || 1);
  const unknown = pack([140, 140, 140]);
  for (let i = 0; i < count; i++) {
    const value = values[i]!;
    if (Number.isNaN(value)) out[i] = unknown;
    else if (coloring.scale === "distinct") out[i] = pack(distinctColor(value));
    else if (coloring.scale === "food") out[i] = meals[value] ?? unknown;
    else out[i] = table[Math.min(Math.max(Math.round((value - low) * scale), 0), 255)]!;
  }
  return { colors: out, legend: { low, high, stops: stops.map(css) } };
}

/** The color of one of several things that have no order. */
const distinctColor = (value: number): Rgb => DISTINCT[(value * 7) % DISTINCT.length]!;

/** The color of a food, or that of the species that is eaten. */
export function mealColor(layout: Layout, meal: string): string {
  const food = layout.foods.find((each) => each.name === meal);
  const [r, g, b] = DISTINCT[Math.max(layout.species.findIndex((each) => each.name === meal), 0) % DISTINCT.length]!;
  return food?.color ?? `#${[r, g, b].map((part) => part.toString(16).padStart(2, "0")).join("")}`;
}

/** The color of the rim of a species; the first one has none. */
export const speciesColor = (index: number): number => pack(DISTINCT[index % DISTINCT.length]!);

export function foodColors(layout: Layout): number[] {
  return layout.foods.map((food) => pack(parse(food.color)));
}
