// What an agent's color means, for any world: names and values come from its layout and its lives.
import { scaleOf } from "./scale";
import type { Source } from "./source";
import type { Frame, Layout, Life } from "./types";

type Rgb = [number, number, number];

// Every color here stands out from the light ground and from the dark one by 3 : 1, so each means the same on both.
// The ramp goes from blue to amber, which the color-blind tell apart.
const RAMP: Rgb[] = [[61, 111, 216], [138, 85, 204], [192, 74, 152], [210, 73, 63], [196, 120, 0]];
const DIVERGING: Rgb[] = [[31, 111, 224], [123, 133, 143], [200, 100, 0]];
const DISTINCT: Rgb[] = [[0, 114, 178], [213, 94, 0], [0, 149, 108], [176, 125, 26], [181, 80, 143], [58, 134, 200], [122, 79, 163], [128, 128, 36], [163, 90, 42], [14, 143, 143]];

/** The color of an agent of which the value is not known; it is drawn hollow. */
export const UNKNOWN = 0;

export interface Coloring {
  name: string;
  label: string;
  /** Value of an agent, from its life and the frame; NaN for unknown. */
  value(life: Life | undefined, frame: Frame, i: number): number;
  scale: "ramp" | "diverging" | "distinct" | "food";
  /** Whether it is a neutral gene. */
  neutral?: boolean;
  /** The ends of the scale, which do not depend on the moment that is shown; without it they are those of the frame. */
  ends?: (source: Source, frame: Frame) => [number, number];
  /** The things that it tells apart, where they have names. */
  key?: { name: string; color: string }[];
  /** Ends that count instead. */
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

/** The color of a value of a gene, from -limit to limit. */
export const diverging = (value: number, limit: number): string => css(along(DIVERGING, (value / limit + 1) / 2));

/** The color of a value from 0 to a limit. */
export const ramp = (value: number, limit: number): string => css(along(RAMP, value / limit));

/** Everything that agents of this world can be colored by. */
export function colorings(source: Source): Coloring[] {
  const { layout, lives } = source;
  const mostEaten = (life: Life | undefined) => {
    const most = life ? Math.max(...life.eaten) : 0;
    return life && most > 0 ? life.eaten.indexOf(most) : NaN;
  };
  // Counts of a life have no course in the records, and a live world knows them at its newest step.
  const counted = source.live ? "up to the newest step" : "of the whole life";
  const key = layout.species.map(({ name, color }) => ({ name, color }));
  const species: Coloring = { name: "species", label: "species", scale: "distinct", key, value: (_, frame, i) => frame.species[i]! };
  // Records count the meals of a life and not their order.
  const lastMeal: Coloring = { name: "last", label: "ate last", scale: "food", value: (life) => (life && life.lastMeal >= 0 ? life.lastMeal : NaN) };
  const of = (name: string, label: string, scale: Coloring["scale"], value: Coloring["value"], measure: (life: Life) => number): Coloring => ({
    name, label, scale, value, ends: scaleOf(name, scale === "diverging", measure),
  });
  const until = (life: Life) => (life.death >= 0 ? life.death : source.last);
  return [
    { name: "energy", label: "energy", scale: "ramp", ends: scaleOf("energy"), value: (_, frame, i) => frame.energy[i]! },
    of("age", "age [steps]", "ramp", (life, frame) => (life ? frame.step - life.birth : NaN), (life) => until(life) - life.birth),
    of("generation", "generation", "ramp", (life) => life?.generation ?? NaN, (life) => life.generation),
    of("children", `children ${counted}`, "ramp", (life) => life?.children ?? NaN, (life) => life.children),
    of("reward", `reward ${counted}`, "diverging", (life) => life?.reward ?? NaN, (life) => life.reward),
    { name: "family", label: "family (a color for each founder)", scale: "distinct", value: (life) => (life ? lives.founder(life.id) : NaN) },
    ...(layout.species.length > 1 ? [species] : []),
    { name: "eats", label: `most frequent meal ${counted}`, scale: "food", value: mostEaten },
    ...(source.live ? [lastMeal] : []),
    ...layout.genes.map((gene, g): Coloring => ({
      ...of(gene.name, gene.title, "diverging", (life) => life?.genome[g] ?? NaN, (life) => life.genome[g]!),
      neutral: gene.role === "neutral",
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
  const values = Float32Array.from(frame.id, (id, i) => coloring.value(source.lives.get(id), frame, i));
  const known = values.filter((value) => !Number.isNaN(value));
  const ends = coloring.ends?.(source, frame) ?? [known.reduce((a, b) => Math.min(a, b), Infinity), known.reduce((a, b) => Math.max(a, b), -Infinity)];
  const [low, high] = [coloring.low ?? ends[0], coloring.high ?? ends[1]];
  const stops = coloring.scale === "diverging" ? DIVERGING : RAMP;
  const table = Uint32Array.from({ length: 256 }, (_, i) => pack(along(stops, i / 255)));
  const meals = source.layout.meals.map((meal) => pack(parse(mealColor(source.layout, meal))));
  const named = coloring.key?.map((each) => pack(parse(each.color)));
  const scale = 255 / (high - low || 1);
  for (let i = 0; i < count; i++) {
    const value = values[i]!;
    if (Number.isNaN(value)) out[i] = UNKNOWN;
    else if (coloring.scale === "distinct") out[i] = named?.[value] ?? pack(distinctColor(value));
    else if (coloring.scale === "food") out[i] = meals[value] ?? UNKNOWN;
    else out[i] = table[Math.min(Math.max(Math.round((value - low) * scale), 0), 255)]!;
  }
  return { colors: out, legend: { low, high, stops: stops.map(css) } };
}

/** The color of one of several things that have no order. */
const distinctColor = (value: number): Rgb => DISTINCT[(value * 7) % DISTINCT.length]!;

/** The color of a food, or that of the species that is eaten. */
export function mealColor(layout: Layout, meal: string): string {
  return [...layout.foods, ...layout.species].find((each) => each.name === meal)?.color ?? "#888888";
}

/** The color of what senses tell apart: a species, a food, an obstacle; "" for a wall. */
export function typeColor(layout: Layout, type: number): string {
  const things = [...layout.species, ...layout.foods];
  return things[type]?.color ?? (type > things.length ? layout.obstacle_color : "");
}

/** The color of a species. */
export const speciesColor = (layout: Layout, index: number): number => pack(parse(layout.species[index]!.color));

export function foodColors(layout: Layout): number[] {
  return layout.foods.map((food) => pack(parse(food.color)));
}
