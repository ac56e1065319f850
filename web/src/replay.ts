// A run's records as a source of moments: loads only the parts of the frames that are shown, and follows a run.
import { Lives } from "./lives";
import type { Answer, Column, Request } from "./records.worker";
import { Series } from "./series";
import type { Source } from "./source";
import type { Frame, Layout, Part, Place, RunIndex } from "./types";

const FOLLOW_MS = 2000; // between two looks at a run that goes on
const KEPT_PARTS = 6; // parts of the frames in memory

type Columns = Record<string, Column>;

const numbers = (columns: Columns, name: string): Float64Array => (columns[name] as Float64Array) ?? new Float64Array();

/** One row of all species: counts are summed, means are weighted by the living, what is of the whole world stays. */
function together(rows: Record<string, number>[]): Record<string, number> {
  const out: Record<string, number> = { ...rows[0]! };
  for (const name of Object.keys(out)) {
    const known = rows.filter((row) => !Number.isNaN(row[name]!));
    const sum = (of: (row: Record<string, number>) => number) => known.reduce((total, row) => total + of(row), 0);
    if (name.endsWith("_mean")) out[name] = sum((row) => row[name]! * row.alive!) / sum((row) => row.alive!);
    else if (/^(alive|births|deaths|learners|agent_steps|eaten_|energy_)/.test(name)) out[name] = sum((row) => row[name]!);
    else if (/_(max|min)$/.test(name)) out[name] = Math[name.endsWith("_max") ? "max" : "min"](...known.map((row) => row[name]!));
  }
  return out;
}

export class Replay implements Source {
  readonly live = false;
  readonly lives = new Lives();
  readonly series = new Series();
  readonly layout: Layout;
  private readonly worker = new Worker(new URL("./records.worker.ts", import.meta.url), { type: "module" });
  private readonly waiting = new Map<number, (answer: Answer) => void>();
  private readonly parts = new Map<string, Frame[] | "asked">(); // in the order of use
  private readonly read = new Map<string, number>(); // bytes of the tables' parts that were read
  private key = 0;
  private trouble = "";

  constructor(
    private index: RunIndex,
    private readonly world = 0,
  ) {
    this.layout = index.layout;
    this.worker.onmessage = ({ data }: MessageEvent<Answer>) => {
      this.waiting.get(data.key)?.(data);
      this.waiting.delete(data.key);
    };
    void this.readTables();
    if (index.status === "running") setTimeout(() => void this.follow(), FOLLOW_MS);
  }

  static async open(world = 0): Promise<Replay> {
    return new Replay((await (await fetch("data/run.json")).json()) as RunIndex, world);
  }

  get worlds(): number[] {
    return this.index.seeds;
  }

  get title(): string {
    return this.index.folder;
  }

  get first(): number {
    return this.index.files.frames[0]?.first ?? this.series.step[0] ?? 0;
  }

  get last(): number {
    const frames = this.index.files.frames;
    const shown = frames[frames.length - 1]?.last ?? -1;
    return Math.max(shown, this.series.step[this.series.step.length - 1] ?? 0);
  }

  get obstacles(): Place[][] {
    return this.index.obstacles?.[this.world] ?? [];
  }

  status(): string {
    if (this.trouble) return this.trouble;
    const seed = `seed ${this.index.seeds[this.world]}`;
    const none = this.index.files.frames.length === 0 ? "; no positions: run with --frames 64 to see agents move" : "";
    return `${this.index.name}, ${seed}, ${this.index.status}${none}`;
  }

  digest(): string {
    return this.index.digests[this.world] ?? "";
  }

  mind(): undefined {
    return undefined;
  }

  around(step: number): { before?: Frame; after?: Frame } {
    const parts = this.index.files.frames;
    const at = parts.findLastIndex((part) => part.first! <= step);
    const here = this.frames(parts[Math.max(at, 0)]);
    const next = at + 1 < parts.length ? parts[at + 1] : undefined;
    const before = here?.findLast((frame) => frame.step <= step) ?? here?.[0];
    let after = here?.find((frame) => frame.step > step);
    if (!after && next) after = this.frames(next)?.find((frame) => frame.step > step);
    return { before, after };
  }

  private frames(part: Part | undefined): Frame[] | undefined {
    if (!part) return undefined;
    const known = this.parts.get(part.file);
    if (known === "asked") return undefined;
    if (known) {
      this.parts.delete(part.file); // to the end: the first ones are dropped first
      this.parts.set(part.file, known);
      return known;
    }
    this.parts.set(part.file, "asked");
    void this.ask(part.file).then((columns) => {
      this.parts.set(part.file, columns ? this.split(columns) : []);
      for (const [file, frames] of this.parts) {
        if (this.parts.size <= KEPT_PARTS) break;
        if (frames !== "asked" && file !== part.file) this.parts.delete(file);
      }
    });
    return undefined;
  }

  private async ask(file: string, columns?: string[]): Promise<Columns | undefined> {
    const request: Request = { key: ++this.key, url: new URL(`data/run/${file}`, document.baseURI).href, columns };
    const answer = await new Promise<Answer>((resolve) => {
      this.waiting.set(request.key, resolve);
      this.worker.postMessage(request);
    });
    if (answer.error) this.trouble = `${file} cannot be read: ${answer.error}`;
    return answer.columns;
  }

  /** The frames of this world in a part: rows of one step follow one another. */
  private split(columns: Columns): Frame[] {
    const world = numbers(columns, "world");
    const step = numbers(columns, "step");
    const kind = columns.kind as string[];
    const [id, x, y] = [numbers(columns, "id"), numbers(columns, "x"), numbers(columns, "y")];
    const [angle, energy] = [numbers(columns, "angle"), numbers(columns, "energy")];
    const species = new Map(this.layout.species.map((each, i) => [each.name, i]));
    const foods = new Map(this.layout.foods.map((food, i) => [food.name, i]));
    const rows = new Map<number, { agents: number[]; foods: number[] }>();
    for (let row = 0; row < step.length; row++) {
      if (world[row] !== this.world) continue;
      let found = rows.get(step[row]!);
      if (!found) rows.set(step[row]!, (found = { agents: [], foods: [] }));
      (species.has(kind[row]!) ? found.agents : found.foods).push(row);
    }
    const pick = (from: Float64Array, at: number[]) => Float32Array.from(at, (row) => from[row]!);
    return [...rows].map(([step, { agents, foods: eaten }]) => ({
      step,
      id: Int32Array.from(agents, (row) => id[row]!),
      x: pick(x, agents),
      y: pick(y, agents),
      angle: pick(angle, agents),
      energy: pick(energy, agents),
      species: Uint8Array.from(agents, (row) => species.get(kind[row]!) ?? 0),
      foodX: pick(x, eaten),
      foodY: pick(y, eaten),
      foodKind: Uint8Array.from(eaten, (row) => foods.get(kind[row]!) ?? 0),
    }));
  }

  private async readTables(): Promise<void> {
    for (const table of ["population", "agents"] as const) {
      for (const part of this.index.files[table]) {
        if (this.read.get(part.file) === part.bytes) continue;
        this.read.set(part.file, part.bytes);
        const columns = await this.ask(part.file);
        if (!columns) continue;
        if (table === "population") this.addPopulation(columns);
        else this.addLives(columns);
      }
    }
  }

  private addPopulation(columns: Columns): void {
    const step = numbers(columns, "step");
    const world = numbers(columns, "world");
    const names = Object.keys(columns).filter((name) => columns[name] instanceof Float64Array);
    const rows = new Map<number, Record<string, number>[]>(); // of each species at a step
    for (let row = 0; row < step.length; row++) {
      if (world[row] !== this.world) continue;
      const known = rows.get(step[row]!) ?? [];
      known.push(Object.fromEntries(names.map((name) => [name, numbers(columns, name)[row]!])));
      rows.set(step[row]!, known);
    }
    for (const [at, each] of rows) this.series.add(at, each.length === 1 ? each[0]! : together(each));
  }

  private addLives(columns: Columns): void {
    const of = (name: string) => numbers(columns, name);
    const eaten = this.layout.meals.map((meal) => of(`eaten_${meal}`));
    const genes = this.layout.genes.map((gene) => of(gene.name));
    const world = of("world");
    const kinds = columns.species as string[] | undefined;
    const species = new Map(this.layout.species.map((each, i) => [each.name, i]));
    const orNone = (value: number | undefined) => (value === undefined || Number.isNaN(value) ? -1 : value);
    for (let row = 0; row < world.length; row++) {
      if (world[row] !== this.world) continue;
      const death = orNone(of("death_step")[row]);
      const id = of("agent_id")[row]!;
      if (death < 0 && (this.lives.get(id)?.death ?? -1) >= 0) continue; // an older list of the living
      this.lives.put({
        id,
        parent: orNone(of("parent_id")[row]),
        generation: of("generation")[row]!,
        birth: of("birth_step")[row]!,
        death,
        energy: of("energy")[row]!,
        children: of("children")[row]!,
        reward: of("reward_sum")[row]!,
        eaten: eaten.map((column) => column[row] ?? 0),
        lastMeal: -1,
        species: kinds ? (species.get(kinds[row]!) ?? 0) : 0,
        genome: genes.map((column) => column[row]!),
      });
    }
  }

  private async follow(): Promise<void> {
    try {
      const response = await fetch("data/run.json");
      if (response.ok) this.index = (await response.json()) as RunIndex;
      this.trouble = "";
      await this.readTables();
    } catch {
      this.trouble = "the server of `hedon view` has ended";
    }
    if (this.index.status === "running") setTimeout(() => void this.follow(), FOLLOW_MS);
  }
}
