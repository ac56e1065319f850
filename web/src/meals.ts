// What the agent in each slot of a live world ate last: the engine counts meals, so the count that grew tells it.

export class LastMeals {
  private counts = new Int32Array();
  private first = (_slot: number) => -1; // what each ate last before the first look
  private last = new Int8Array(); // by slot, -1 for nothing yet

  /** Looks at the counts after a step: rows of slots, one column for each kind of meal. Reports each kind that a slot ate. */
  note(eaten: Int32Array, kinds: number, ate?: (slot: number, kind: number) => void): void {
    if (this.counts.length !== eaten.length) {
      this.counts = eaten.slice();
      this.last = Int8Array.from({ length: eaten.length / kinds }, (_, slot) => this.first(slot));
      return;
    }
    for (let i = 0; i < eaten.length; i++) {
      if (eaten[i] === this.counts[i]) continue;
      // Counts fall only where a newborn has taken the slot.
      const more = eaten[i]! > this.counts[i]!;
      this.last[Math.floor(i / kinds)] = more ? i % kinds : -1;
      if (more) ate?.(Math.floor(i / kinds), i % kinds);
      this.counts[i] = eaten[i]!;
    }
  }

  of(slot: number): number {
    return this.last[slot] ?? -1;
  }

  /** The same where agents have other slots: the ids of the agents by slot, before and after. */
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
