// All known lives and their pedigree.
import type { Life } from "./types";

export class Lives {
  rewinds = 0; // how often lives were forgotten
  private readonly known = new Map<number, Life>();
  private readonly family = new Map<number, number[]>();
  private readonly roots = new Map<number, number>();

  get size(): number {
    return this.known.size;
  }

  get(id: number): Life | undefined {
    return this.known.get(id);
  }

  all(): IterableIterator<Life> {
    return this.known.values();
  }

  put(life: Life): void {
    if (!this.known.has(life.id) && life.parent >= 0) {
      const siblings = this.family.get(life.parent);
      if (siblings) siblings.push(life.id);
      else this.family.set(life.parent, [life.id]);
    }
    this.known.set(life.id, life);
  }

  /** Forgets all births and deaths after a step. */
  rewind(step: number): void {
    this.rewinds++;
    const before = [...this.known.values()].filter((life) => life.birth <= step);
    for (const each of [this.known, this.family, this.roots]) each.clear();
    for (const life of before) this.put(life.death > step ? { ...life, death: -1 } : life);
  }

  children(id: number): number[] {
    return this.family.get(id) ?? [];
  }

  /** The id of the founder that a life descends from, or of its earliest ancestor that has a known id. */
  founder(id: number): number {
    const path: number[] = [];
    let at = id;
    for (;;) {
      const known = this.roots.get(at);
      if (known !== undefined) {
        at = known;
        break;
      }
      path.push(at);
      const life = this.known.get(at);
      if (!life || life.parent < 0) break;
      at = life.parent;
    }
    if (this.known.has(id)) for (const step of path) this.roots.set(step, at);
    return at;
  }

  /** Whether two agents share an ancestor at most `generations` back, counting the agents themselves as ancestors. */
  kin(a: number, b: number, generations = 3): boolean {
    const up = this.ancestors(a, generations);
    for (const id of this.ancestors(b, generations)) if (up.has(id)) return true;
    return false;
  }

  private ancestors(id: number, generations: number): Set<number> {
    const ids = new Set([id]);
    let at = this.known.get(id);
    for (let i = 0; i < generations && at && at.parent >= 0; i++) {
      ids.add(at.parent);
      at = this.known.get(at.parent);
    }
    return ids;
  }
}
