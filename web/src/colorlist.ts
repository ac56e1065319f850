// The list of colors above the arena. Neutral genes are one entry of it, with a short list of their own.
import { type Coloring, colorings } from "./color";
import { by, option } from "./element";
import type { Source } from "./source";

const NEUTRAL = "neutral"; // the entry for all neutral genes

export class ColorList {
  current!: Coloring;
  private colors: Coloring[] = [];
  private first = ""; // the color of a world that opens
  private readonly list = by<HTMLSelectElement>("color");
  private readonly neutral = by<HTMLSelectElement>("neutral");

  constructor(changed: () => void) {
    const take = () => {
      this.choose(this.list.value === NEUTRAL ? this.neutral.value : this.list.value);
      changed();
    };
    this.list.onchange = this.neutral.onchange = take;
  }

  /** Offers the colors of a source. One that was chosen stays, and otherwise it is the first weight of the reward: what evolves. */
  offer(source: Source): void {
    const before = this.current && this.current.name !== this.first ? this.current.name : "";
    this.colors = colorings(source);
    this.first = source.layout.genes.find(({ role }) => role === "reward")?.name ?? this.colors[0]!.name;
    const neutral = this.colors.filter((each) => each.neutral);
    const entries = this.colors.filter((each) => !each.neutral).map(({ name, label }) => option(name, label));
    this.list.replaceChildren(...entries, ...(neutral.length > 0 ? [option(NEUTRAL, "neutral gene …")] : []));
    this.neutral.replaceChildren(...neutral.map(({ name, label }) => option(name, label)));
    this.choose(before);
  }

  /** Colors agents by what has this name, or by the first color if this world lacks it. */
  choose(name: string): void {
    const named = (wanted: string) => this.colors.find((each) => each.name === wanted);
    this.current = named(name) ?? named(this.first)!;
    this.neutral.hidden = !this.current.neutral;
    this.list.value = this.current.neutral ? NEUTRAL : this.current.name;
    if (this.current.neutral) this.neutral.value = this.current.name;
  }
}
