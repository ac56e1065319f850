// The list of colorings above the arena. All neutral genes share one entry, which opens a list of their own.
import { type Coloring, colorings } from "./color";
import { by, option } from "./element";
import type { Source } from "./source";

const NEUTRAL = "neutral"; // the entry for all neutral genes

export class ColorList {
  current!: Coloring;
  private colors: Coloring[] = [];
  private first = ""; // the initial coloring
  private readonly list = by<HTMLSelectElement>("color");
  private readonly neutral = by<HTMLSelectElement>("neutral");

  constructor(changed: () => void) {
    const take = () => {
      this.choose(this.list.value === NEUTRAL ? this.neutral.value : this.list.value);
      changed();
    };
    this.list.onchange = this.neutral.onchange = take;
  }

  /** Lists the colorings of a source. Keeps the current choice if possible; the default is the first reward weight, since it evolves. */
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

  /** Colors agents by the coloring of this name, or by the default if this world lacks it. */
  choose(name: string): void {
    const named = (wanted: string) => this.colors.find((each) => each.name === wanted);
    this.current = named(name) ?? named(this.first)!;
    this.neutral.hidden = !this.current.neutral;
    this.list.value = this.current.neutral ? NEUTRAL : this.current.name;
    if (this.current.neutral) this.neutral.value = this.current.name;
  }
}
