// The frames of one world of a run. Only the parts that are shown are loaded, and the last few are kept.
import type { Column } from "./records.worker";
import type { Frame, Layout, Part } from "./types";

const KEPT_PARTS = 6; // in memory

export type Columns = Record<string, Column>;
export const numbers = (columns: Columns, name: string): Float64Array => (columns[name] as Float64Array) ?? new Float64Array();

/** A file with frames of the world, and the first and last step it has of it. */
interface Filmed {
  file: string;
  steps: [number, number];
}

/** An agent or a food at a moment. */
interface Body {
  kind: string;
  id: number;
  x: number;
  y: number;
  angle: number;
  energy: number;
  held: number[]; // of each store other than energy
}

export class Film {
  private parts: Filmed[] = [];
  private readonly kept = new Map<string, Frame[] | "asked">(); // by file, least recently used first
  private readonly stores: string[]; // other than energy, of all species

  constructor(
    private readonly layout: Layout,
    private readonly world: number,
    private readonly ask: (file: string) => Promise<Columns | undefined>,
  ) {
    this.stores = [...new Set(layout.species.flatMap(({ stores }) => stores.slice(1).map(({ name }) => name)))];
  }

  /** Updates the list of parts. */
  update(parts: Part[]): void {
    this.parts = parts.flatMap(({ file, worlds }) => {
      const steps = worlds?.[this.world];
      return steps ? [{ file, steps }] : [];
    });
  }

  get first(): number | undefined {
    return this.parts[0]?.steps[0];
  }

  get last(): number | undefined {
    return this.parts[this.parts.length - 1]?.steps[1];
  }

  around(step: number): { before?: Frame; after?: Frame } {
    const at = Math.max(this.lastWith(step), 0);
    const here = this.frames(at);
    const before = here?.findLast((frame) => frame.step <= step) ?? here?.[0];
    let after = here?.find((frame) => frame.step > step);
    const next = this.parts[at + 1]?.steps[0];
    if (!after && next !== undefined) after = this.frames(this.lastWith(next))?.find((frame) => frame.step > step);
    return { before, after };
  }

  /** Passes the frames after a step to `take`, in order, until it returns false. Parts read for this are not kept. */
  async each(after: number, take: (frame: Frame) => boolean): Promise<void> {
    for (let at = Math.max(this.lastWith(after), 0); at < this.parts.length; at++) {
      if (this.parts[at]!.steps[1] <= after) continue;
      const known = this.kept.get(this.parts[at]!.file);
      const frames = known && known !== "asked" ? known : await this.load(at);
      for (const frame of frames) if (frame.step > after && !take(frame)) return;
    }
  }

  /** The last part with frames at or before a step, in which a frame at this step is complete; -1 if there is none. */
  private lastWith(step: number): number {
    return this.parts.findLastIndex(({ steps }) => steps[0] <= step);
  }

  private frames(at: number): Frame[] | undefined {
    const file = this.parts[at]?.file;
    if (file === undefined) return undefined;
    const known = this.kept.get(file);
    if (known === "asked") return undefined;
    if (known) {
      this.kept.delete(file); // and added at the end, since the first ones are dropped first
      this.kept.set(file, known);
      return known;
    }
    this.kept.set(file, "asked");
    void this.load(at).then((frames) => {
      this.kept.set(file, frames);
      for (const [other, frames] of this.kept) {
        if (this.kept.size <= KEPT_PARTS) break;
        if (frames !== "asked" && other !== file) this.kept.delete(other);
      }
    });
    return undefined;
  }

  /** The frames of a part. In old runs a step may continue in the next part; its frame belongs to the last part that has it. */
  private async load(at: number): Promise<Frame[]> {
    const { parts } = this;
    const [first] = parts[at]!.steps;
    let from = at;
    while (from > 0 && parts[from - 1]!.steps[1] === first) from--;
    const end = parts[at + 1]?.steps[0] ?? Infinity;
    const moments = new Map<number, Body[]>();
    for (const { file } of parts.slice(from, at + 1)) {
      const columns = await this.ask(file);
      if (columns) this.collect(columns, first, end, moments);
    }
    return [...moments].map(([step, bodies]) => this.frame(step, bodies));
  }

  /** Adds the bodies of this world from the rows of a part, by step, for the steps from `first` up to but excluding `end`. */
  private collect(columns: Columns, first: number, end: number, moments: Map<number, Body[]>): void {
    const kind = columns.kind as string[];
    const [world, step, id] = [numbers(columns, "world"), numbers(columns, "step"), numbers(columns, "id")];
    const [x, y, angle, energy] = ["x", "y", "angle", "energy"].map((name) => numbers(columns, name));
    const held = this.stores.map((name) => numbers(columns, name));
    for (let row = 0; row < step.length; row++) {
      if (world[row] !== this.world || step[row]! < first || step[row]! >= end) continue;
      const body = { kind: kind[row]!, id: id[row]!, x: x![row]!, y: y![row]!, angle: angle![row]!, energy: energy![row]!, held: held.map((store) => store[row] ?? NaN) };
      const known = moments.get(step[row]!);
      if (known) known.push(body);
      else moments.set(step[row]!, [body]);
    }
  }

  private frame(step: number, bodies: Body[]): Frame {
    const species = new Map(this.layout.species.map((each, i) => [each.name, i]));
    const foods = new Map(this.layout.foods.map((food, i) => [food.name, i]));
    const agents = bodies.filter(({ kind }) => species.has(kind)).sort((a, b) => a.id - b.id);
    const eaten = bodies.filter(({ kind }) => !species.has(kind));
    return {
      step,
      id: Int32Array.from(agents, (each) => each.id),
      x: Float32Array.from(agents, (each) => each.x),
      y: Float32Array.from(agents, (each) => each.y),
      angle: Float32Array.from(agents, (each) => each.angle),
      energy: Float32Array.from(agents, (each) => each.energy),
      held: Object.fromEntries(this.stores.map((name, i) => [name, Float32Array.from(agents, (each) => each.held[i]!)])),
      species: Uint8Array.from(agents, (each) => species.get(each.kind)!),
      foodX: Float32Array.from(eaten, (each) => each.x),
      foodY: Float32Array.from(eaten, (each) => each.y),
      foodKind: Uint8Array.from(eaten, (each) => foods.get(each.kind) ?? 0),
    };
  }
}
