// The places of meals in a live world. Records count the meals of a life but do not have their places.

const MOST = 200_000; // the most recent meals are kept
export const WORDS = 4; // of a meal: step, x, y, and its index among the layout's meals

export class Bites {
  private kept: number[] = [];
  total = 0; // since the world began

  get count(): number {
    return this.kept.length / WORDS;
  }

  /** Adds meals of `WORDS` numbers each. */
  add(words: Float32Array): void {
    for (const word of words) this.kept.push(word);
    this.total += words.length / WORDS;
    if (this.count > 1.25 * MOST) this.kept = this.kept.slice(-MOST * WORDS);
  }

  /** Forgets the meals after a step. */
  rewind(step: number): void {
    let end = this.kept.length;
    while (end > 0 && this.kept[end - WORDS]! > step) end -= WORDS;
    this.total -= (this.kept.length - end) / WORDS;
    this.kept.length = end;
  }

  /** Passes to `take` the place of each meal after the first `seen`, as far as they are kept. */
  after(seen: number, take: (x: number, y: number) => void): void {
    const first = Math.max(seen - (this.total - this.count), 0) * WORDS;
    for (let i = first; i < this.kept.length; i += WORDS) take(this.kept[i + 1]!, this.kept[i + 2]!);
  }
}
