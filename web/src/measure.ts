// The measures of an agent for the table and its filter, by the names that a filter uses.
import type { Source } from "./source";
import type { Frame, Life } from "./types";

export interface Measure {
  name: string;
  meaning: string;
  /** The value of agent `i` of a frame; NaN if it is not known. */
  value(life: Life | undefined, frame: Frame, i: number): number;
  /** The words that its values stand for, such as the names of species. */
  words?: string[];
  /** Whether it is a column of the table; a filter can use all measures. */
  column: boolean;
}

/** All measures of the agents of a world, in the order of the columns. */
export function measures({ layout, live }: Source): Measure[] {
  const period = live ? "up to the newest step" : "in the whole life";
  const of = (name: string, meaning: string, value: (life: Life) => number, column = true): Measure => ({ name, meaning, column, value: (life) => (life ? value(life) : NaN) });
  const species: Measure = { name: "species", meaning: "species", words: layout.species.map(({ name }) => name), column: true, value: (_, frame, i) => frame.species[i]! };
  return [
    { name: "id", meaning: "id of the agent", column: true, value: (_, frame, i) => frame.id[i]! },
    ...(layout.species.length > 1 ? [species] : []),
    { name: "age", meaning: "age [steps]", column: true, value: (life, frame) => (life ? Math.floor(frame.step) - life.birth : NaN) },
    { name: "energy", meaning: "energy", column: true, value: (_, frame, i) => frame.energy[i]! },
    of("generation", "generation; founders have 0", (life) => life.generation),
    of("children", `children ${period}`, (life) => life.children),
    of("meals", `meals ${period}`, (life) => life.eaten.reduce((sum, count) => sum + count, 0)),
    of("reward", `sum of rewards ${period}`, (life) => life.reward),
    ...layout.genes.flatMap(({ name, title, role }, g) => (role === "reward" ? [of(name, title, (life) => life.genome[g]!)] : [])),
    ...layout.meals.map((meal, k) => of(`eaten_${meal}`, `meals of ${meal} ${period}`, (life) => life.eaten[k]!, false)),
    of("parent", "id of the parent", (life) => (life.parent < 0 ? NaN : life.parent), false),
    ...layout.genes.flatMap(({ name, title, role }, g) => (role === "reward" ? [] : [of(name, title, (life) => life.genome[g]!, false)])),
  ];
}
