// The meanings of an agent's color, for any world: names and values come from its layout and its lives.
import { scaleOf } from "./scale";
import type { Source } from "./source";
import type { Frame, Layout, Life } from "./types";

type Rgb = [number, number, number];

// Every color here has a contrast of 3 : 1 with both the light and the dark background, so it is the same on both.
// The ramp runs from blue to amber, which people with color blindness can distinguish.
const RAMP: Rgb[] = [[61, 111, 216], [138, 85, 204], [192, 74, 152], [210, 73, 63], [196, 120, 0]];
const DIVERGING: Rgb[] = [[31, 111, 224], [123, 133, 143], [200, 100, 0]];
const DISTINCT: Rgb[] = [[0, 114, 178], [213, 94, 0], [0, 149, 108], [176, 125, 26], [181, 80, 143], [58, 134, 200], [122, 79, 163], [128, 128, 36], [163, 90, 42], [14, 143, 143]];

/** The color of an agent whose value is not known; it is drawn hollow. */
export const UNKNOWN = 0;

export interface Coloring {
  name: string;
  label: string;
  /** The value of agent `i`, from its life and the frame; NaN if it is not known. */
  value(life: Life | undefined, frame: Frame, i: number): number;
  scale: "ramp" | "diverging" | "distinct" | "food";
  /** Whether this colors by a neutral gene. */
  neutral?: boolean;
  /** Fixed ends of the scale; by default they are the extremes of the frame. */
  ends?: (source: Source, frame: Frame) => [number, number];
  /** The named categories, if it has any. */
  key?: { name: string; color: string }[];
  /** Ends of the scale that take precedence. */
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

/** The color of a gene's value between -limit and limit. */
export const diverging = (value: number, limit: number): string => css(along(DIVERGING, (value / limit + 1) / 2));

/** The color of a value between 0 and a limit. */
export const ramp = (value: number, limit: number): string => css(along(RAMP, value / limit));

/** Everything that agents of this world can be colored by. */
export function colorings(source: Source): Coloring[] {
  const { layout, lives } = source;
  const mostEaten = (life: Life | undefined) => {
    const most = life ? Math.max(...life.eaten) : 0;
    return life && most > 0 ? life.eaten.indexOf(most) : NaN;
  };
  // Records have only the totals of a life, and a live world has its counts at the newest step.
  const counted = source.live ? "up to the newest step" : "of the whole life";
  const key = layout.species.map(({ name, color }) => ({ name, color }));
  const species: Coloring = { name: "species", label: "species", scale: "distinct", key, value: (_, frame, i) => frame.species[i]! };
  // Records count the meals of a life, but do not have their order.
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

/** Writes the color of each agent of a frame to `out`; returns the legend with the ends of the scale. */
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

/** The color of one of several unordered categories. */
const distinctColor = (value: number): Rgb => DISTINCT[(value * 7) % DISTINCT.length]!;

/** The color of the food or of the species that is eaten. */
export function mealColor(layout: Layout, meal: string): string {
  return [...layout.foods, ...layout.species].find((each) => each.name === meal)?.color ?? "#888888";
}

/** The color of a type that senses distinguish: a species, a food or an obstacle; "" for a wall. */
export function typeColor(layout: Layout, type: number): string {
  const things = [...layout.species, ...layout.foods];
  return things[type]?.color ?? (type > things.length ? layout.obstacle_color : "");
}

/** The color of a species. */
export const speciesColor = (layout: Layout, index: number): number => pack(parse(layout.species[index]!.color));

export function foodColors(layout: Layout): number[] {
  return layout.foods.map((food) => pack(parse(food.color)));
}
