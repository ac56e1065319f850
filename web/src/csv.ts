// CSV files, and how the browser saves files. The columns of lives have the names used in the table `agents` of a run.
import type { Source } from "./source";
import type { Life } from "./types";

/** A header and one line for each life; missing values are empty. */
export function csvOf(source: Source, seed: number, lives: Life[]): string {
  const { layout } = source;
  const several = layout.species.length > 1;
  const names = ["seed", ...(several ? ["species"] : []), "agent_id", "parent_id", "generation", "birth_step", "death_step", "energy"];
  names.push(...layout.meals.map((meal) => `eaten_${meal}`), "children", "reward_sum", ...layout.genes.map((gene) => gene.name));
  const known = (value: number) => (value < 0 ? "" : String(value));
  const line = (life: Life): string => {
    const first = [String(seed), ...(several ? [layout.species[life.species]!.name] : []), String(life.id), known(life.parent)];
    first.push(String(life.generation), String(life.birth), known(life.death), String(life.energy), ...life.eaten.map(String));
    const genome = life.genome.map((value) => (Number.isNaN(value) ? "" : String(value)));
    return [...first, String(life.children), String(life.reward), ...genome].join(",");
  };
  return [names.join(","), ...lives.map(line)].join("\n") + "\n";
}

/** A header and rows; no cell may contain a comma. */
export const csvTable = (names: string[], rows: string[][]): string => [names, ...rows].map((cells) => cells.join(",") + "\n").join("");

/** A text as a cell. */
export const quoted = (text: string): string => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

/** Makes the browser save a text, a picture or a video as a file. */
export function save(name: string, content: string | Blob): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(typeof content === "string" ? new Blob([content], { type: "text/plain" }) : content);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
