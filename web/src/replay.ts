// A run's records as a source of moments: loads only the parts of the frames that are shown, and follows a run.
import { show } from "./element";
import { Film, numbers, type Columns } from "./film";
import { Lives } from "./lives";
import type { Answer, Request } from "./records.worker";
import { Series } from "./series";
import type { Source } from "./source";
import type { Frame, Layout, Place, RunIndex } from "./types";

const FOLLOW_MS = 2000; // between two looks at a run that goes on

type Row = Record<string, number>;

const COUNTS = /^(alive|births|deaths|learners|agent_steps|eaten_|energy_)/;
const OF_ONE = /_(sd|q25|median|q75)$/;

/** One row of all species: counts are summed, means are weighted by the living, what is of the whole world stays. */
function together(rows: Row[]): Row {
  const out: Row = { ...rows[0]! };
  for (const name of Object.keys(out)) {
    const known = rows.filter((row) => !Number.isNaN(row[name]!));
    const sum = (of: (row: Row) => number) => known.reduce((total, row) => total + of(row), 0);
    if (name.endsWith("_mean")) out[name] = sum((row) => row[name]! * row.alive!) / sum((row) => row.alive!);
    else if (/_(max|min)$/.test(name)) out[name] = Math[name.endsWith("_max") ? "max" : "min"](...known.map((row) => row[name]!));
    else if (OF_ONE.test(name)) out[name] = NaN; // these of all do not follow from those of each
    else if (COUNTS.test(name)) out[name] = sum((row) => row[name]!);
  }
  return out;
}

/** The numbers of each species by its name: `prey.alive`. */
function apart(rows: Map<string, Row>): Row {
  const named = [...rows].flatMap(([species, row]) => Object.entries(row).map(([name, value]) => [`${species}.${name}`, value] as const));
  return Object.fromEntries(named);
}

export class Replay implements Source {
  readonly live = false;
  readonly relawed = Infinity;
  readonly bites = undefined;
  loaded = false;
  readonly lives = new Lives();
  readonly series = new Series();
  readonly layout: Layout;
  private readonly worker = new Worker(new URL("./records.worker.ts", import.meta.url), { type: "module" });
  private readonly waiting = new Map<number, (answer: Answer) => void>();
  private readonly read = new Map<string, number>(); // bytes of the tables' parts that were read
  private readonly film: Film;
  private interval = { step: -1, rows: new Map<string, Row>() }; // the last one of the population, by species
  private key = 0;
  private trouble = "";

  constructor(
    private index: RunIndex,
    private readonly world = 0,
  ) {
    this.layout = index.layout;
    this.film = new Film(this.layout, world, (file) => this.ask(file));
    this.worker.onmessage = ({ data }: MessageEvent<Answer>) => {
      this.waiting.get(data.key)?.(data);
      this.waiting.delete(data.key);
    };
    this.film.update(index.files.frames);
    void this.readTables();
    if (index.status === "running") setTimeout(() => void this.follow(), FOLLOW_MS);
  }

  static async open(world = 0): Promise<Replay> {
    return new Replay((await (await fetch("data/run.json")).json()) as RunIndex, world);
  }

  get worlds(): number[] {
    return this.index.seeds;
  }

  get settings(): RunIndex["settings"] {
    return this.index.settings;
  }

  get title(): string {
    return this.index.folder;
  }

  get first(): number {
    return this.film.first ?? this.series.step[0] ?? 0;
  }

  get last(): number {
    return Math.max(this.film.last ?? -1, this.series.step[this.series.step.length - 1] ?? 0);
  }

  get spacing(): number {
    return this.index.frames;
  }

  get obstacles(): Place[][] {
    return this.index.obstacles?.[this.world] ?? [];
  }

  get ended(): boolean {
    return this.index.status !== "running";
  }

  earned(): undefined {
    return undefined; // records have the reward of whole lives
  }

  status(): string {
    if (this.trouble) return this.trouble;
    const damaged = this.index.files.frames.filter((part) => part.damaged).map((part) => part.file);
    if (damaged.length > 0) return `damaged, and left out: ${damaged.join(", ")}`;
    const seed = `seed ${this.index.seeds[this.world]}`;
    const none = this.index.files.frames.length === 0 ? "; no positions: run with --frames 64 to see agents move" : "";
    const end = this.index.extinct[this.world];
    const over = typeof end === "number" ? `, died out at step ${show(end)}` : "";
    return `${this.index.name}, ${seed}, ${this.index.status}${over}${none}`;
  }

  digest(): string {
    return this.index.digests[this.world] ?? "";
  }

  agentProbe(): undefined {
    return undefined;
  }

  around(step: number): { before?: Frame; after?: Frame } {
    return this.film.around(step);
  }

  moments(after: number, take: (frame: Frame) => boolean): Promise<void> {
    return this.film.each(after, take);
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
    this.loaded = true;
  }

  private addPopulation(columns: Columns): void {
    const step = numbers(columns, "step");
    const world = numbers(columns, "world");
    const species = columns.species as string[] | undefined;
    const names = Object.keys(columns).filter((name) => columns[name] instanceof Float64Array);
    for (let row = 0; row < step.length; row++) {
      if (world[row] !== this.world || step[row]! < this.interval.step) continue;
      if (step[row]! > this.interval.step) this.interval = { step: step[row]!, rows: new Map() };
      const { rows } = this.interval; // they may begin in the part before, as in old runs
      rows.set(species?.[row] ?? "", Object.fromEntries(names.map((name) => [name, numbers(columns, name)[row]!])));
      this.series.rewind(step[row]! - 1);
      this.series.add(step[row]!, rows.size === 1 ? [...rows.values()][0]! : { ...together([...rows.values()]), ...apart(rows) });
    }
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
      this.film.update(this.index.files.frames);
      this.trouble = "";
      await this.readTables();
    } catch {
      this.trouble = "the server of `hedon view` has ended";
    }
    if (this.index.status === "running") setTimeout(() => void this.follow(), FOLLOW_MS);
  }
}
