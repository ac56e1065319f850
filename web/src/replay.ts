// A run's records as a source of moments. Loads only the frames that are shown, and follows a run in progress.
import { show } from "./element";
import { Film, numbers, type Columns } from "./film";
import { Lives } from "./lives";
import { Population } from "./population";
import type { Answer, Request } from "./records.worker";
import type { Series } from "./series";
import type { Source } from "./source";
import type { Frame, Layout, Place, RunIndex } from "./types";

const FOLLOW_MS = 2000; // between two looks at a run in progress

export class Replay implements Source {
  readonly live = false;
  readonly relawed = Infinity;
  readonly bites = undefined;
  loaded = false;
  readonly lives = new Lives();
  readonly series: Series;
  readonly layout: Layout;
  others: Population[] = []; // of the run's other seeds and of further runs, once requested
  private readonly worker = new Worker(new URL("./records.worker.ts", import.meta.url), { type: "module" });
  private readonly waiting = new Map<number, (answer: Answer) => void>();
  private readonly read = new Map<string, number>(); // bytes already read, by part of a table
  private readonly film: Film;
  private readonly population: Population;
  private othersWanted = false;
  private reading = Promise.resolve(); // tables are read one after another, so that rows are added in order
  private key = 0;
  private trouble = "";

  constructor(
    private index: RunIndex,
    private readonly world = 0,
  ) {
    this.layout = index.layout;
    this.population = new Population(world, this.seed);
    this.series = this.population.series;
    this.film = new Film(this.layout, world, (file) => this.ask(file));
    this.worker.onmessage = ({ data }: MessageEvent<Answer>) => {
      this.waiting.get(data.key)?.(data);
      this.waiting.delete(data.key);
    };
    this.film.update(index.files.frames);
    void this.inTurn(() => this.readTables());
    if (index.status === "running") setTimeout(() => void this.follow(), FOLLOW_MS);
  }

  static async open(world = 0): Promise<Replay> {
    return new Replay((await (await fetch("data/run.json")).json()) as RunIndex, world);
  }

  get seeds(): number[] {
    return this.index.seeds;
  }

  get runs(): RunIndex["others"] {
    return this.index.others;
  }

  get seed(): number {
    return this.index.seeds[this.world]!;
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
    return undefined; // records have only the reward of whole lives
  }

  status(): string {
    if (this.trouble) return this.trouble;
    const damaged = this.index.files.frames.filter((part) => part.damaged).map((part) => part.file);
    if (damaged.length > 0) return `damaged, and left out: ${damaged.join(", ")}`;
    const seed = `seed ${this.seed}`;
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

  /** Reads the populations of the run's other seeds, which are updated from then on, and of further runs. */
  readOthers(): void {
    if (this.othersWanted) return;
    this.othersWanted = true;
    void this.inTurn(async () => {
      const others = this.seeds.map((seed, world) => new Population(world, seed)).filter(({ world }) => world !== this.world);
      const read = async (files: string[], worlds: Population[]) => {
        for (const file of files) {
          const columns = await this.ask(file);
          if (columns) for (const each of worlds) each.add(columns);
        }
        this.others = [...this.others, ...worlds];
      };
      await read(this.index.files.population.map(({ file }) => file), others);
      for (const { run, seeds, files } of this.runs) await read(files, seeds.map((seed, world) => new Population(world, seed, run)));
    });
  }

  private inTurn(read: () => Promise<void>): Promise<void> {
    return (this.reading = this.reading.catch(() => undefined).then(read));
  }

  private async readTables(): Promise<void> {
    for (const table of ["population", "agents"] as const) {
      for (const part of this.index.files[table]) {
        if (this.read.get(part.file) === part.bytes) continue;
        this.read.set(part.file, part.bytes);
        const columns = await this.ask(part.file);
        if (!columns) continue;
        if (table === "population") for (const each of [this.population, ...this.others.filter(({ run }) => run === "")]) each.add(columns);
        else this.addLives(columns);
      }
    }
    this.loaded = true;
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
      if (death < 0 && (this.lives.get(id)?.death ?? -1) >= 0) continue; // the list of the living is older
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
      await this.inTurn(() => this.readTables());
    } catch {
      this.trouble = "the server of `hedon view` has ended";
    }
    if (this.index.status === "running") setTimeout(() => void this.follow(), FOLLOW_MS);
  }
}
