// The last meal of the agent in each slot of a live world. The engine only counts meals, so it is the kind whose count grew.

export class LastMeals {
  private counts = new Int32Array();
  private first = (_slot: number) => -1; // the last meal of a slot before the first look
  private last = new Int8Array(); // by slot, -1 for nothing yet

  /** Compares the counts after a step (a row per slot, a column per kind of meal); calls `ate` for each kind that a slot ate. */
  note(eaten: Int32Array, kinds: number, ate?: (slot: number, kind: number) => void): void {
    if (this.counts.length !== eaten.length) {
      this.counts = eaten.slice();
      this.last = Int8Array.from({ length: eaten.length / kinds }, (_, slot) => this.first(slot));
      return;
    }
    for (let i = 0; i < eaten.length; i++) {
      if (eaten[i] === this.counts[i]) continue;
      // Counts fall only if a newborn has taken the slot.
      const more = eaten[i]! > this.counts[i]!;
      this.last[Math.floor(i / kinds)] = more ? i % kinds : -1;
      if (more) ate?.(Math.floor(i / kinds), i % kinds);
      this.counts[i] = eaten[i]!;
    }
  }

  of(slot: number): number {
    return this.last[slot] ?? -1;
  }

  /** The same meals after agents have moved to other slots, given the ids of the agents by slot before and after. */
  moved(before: number[], after: number[]): LastMeals {
    const made = new LastMeals();
    const last = new Map(before.map((id, slot) => [id, this.of(slot)]));
    made.first = (slot) => last.get(after[slot]!) ?? -1;
    return made;
  }

  copy(): LastMeals {
    const made = new LastMeals();
    [made.counts, made.last] = [this.counts.slice(), this.last.slice()];
    return made;
  }
}
