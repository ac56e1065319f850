// The page: one source of moments, the user's selections, and the drawing, 60 times a second.
import { AgentPanel } from "./agent";
import { AgentTable } from "./agents";
import { Arena } from "./arena";
import { blend } from "./blend";
import { Chapters } from "./chapters";
import { ColorList } from "./colorlist";
import { by, counted, element, option, show } from "./element";
import { Heat } from "./heat";
import { showHelp } from "./help";
import { Legend } from "./legend";
import { type Link, readLink, writeLink } from "./link";
import { Live } from "./live";
import { Notice } from "./notice";
import { Plots } from "./plots";
import { recall, remember } from "./preference";
import { castRays, type Ray } from "./rays";
import { recordedSettings } from "./recorded";
import { Replay } from "./replay";
import { Selection } from "./selection";
import { Settings } from "./settings";
import { Tabs } from "./tabs";
import { events, Timeline } from "./timeline";
import { Tools } from "./tools";
import { Tree } from "./tree";
import { Twin } from "./twin";
import type { Source } from "./source";
import type { Event, Frame, LiveWorld, Setting } from "./types";

const SPEEDS = [1 / 8, 1 / 4, 1 / 2, 1, 2, 4, 8, 16, 64, 256, 1000]; // steps per picture
const PICTURES = 16; // at least, between two recorded moments, until the user chooses another speed
const PICTURE_MS = 13; // of work on a live world between two pictures
const HURRY_MS = 120; // the same while catching up with the step in a link, and at the highest speeds
const PANEL_MS = 200; // between two updates of the panels
const MOST_THREADS = 16; // the engine has seats for no more
const NOTHING: Link = { changes: new Map() };

export class App {
  readonly arena = new Arena(by<HTMLCanvasElement>("scene"));
  readonly twin = new Twin();
  source!: Source;
  frame: Frame | undefined;
  chosen = -1;
  playing = false;
  speed = 1;
  now = 0;
  pictures = 0;
  tree: Tree | undefined;
  private plots: Plots | undefined;
  private tools: Tools | undefined;
  private goal: { step: number; agent: number } | undefined; // of the link that opened a live world
  private skipped = 0; // steps between the last two pictures, which were not drawn
  private marks: Event[] = [];
  private panelsDue = 0;
  private threads = 0; // of a live world, from the link; 0 lets the worker choose
  private owed = 0; // fractions of a step accumulated at speeds below 1
  private readonly colors = new ColorList(() => this.changed());
  private readonly legend = new Legend();
  private readonly notice = new Notice();
  private readonly panel = new AgentPanel((id) => this.choose(id));
  private readonly heat = new Heat(this.arena);
  private readonly selection = new Selection(() => this.changed());
  private readonly table = new AgentTable(this.selection, () => this.changed(), (id) => this.choose(id));
  private readonly timeline = new Timeline(by<HTMLCanvasElement>("timeline"), (step) => this.seek(step), () => [this.source.first, this.source.last]);
  private readonly chapters = new Chapters((step) => this.seek(step));
  private readonly tabs = new Tabs(["agent", "agents", "plots", "tree", "settings", "world-panel"], (name) => this.opened(name));
  private worlds: LiveWorld[] = [];

  async open(): Promise<void> {
    for (const speed of SPEEDS) by("speed").append(option(String(speed), `${speed < 1 ? `1/${1 / speed} step` : counted(speed, "step")} per picture`));
    const page = (await (await fetch("data/page.json")).json()) as { run: boolean; worlds: LiveWorld[] };
    this.worlds = page.worlds;
    const select = by<HTMLSelectElement>("world");
    if (page.run) {
      const index = (await (await fetch("data/run.json")).json()) as { folder: string; seeds: number[] };
      index.seeds.forEach((seed, i) => select.append(option(`run ${i}`, `run ${index.folder}, seed ${seed}`)));
    }
    this.worlds.forEach((world, i) => select.append(option(`live ${i}`, `live: ${world.name}`)));
    const link = readLink(location.hash.slice(1));
    if (link.threads && link.threads <= MOST_THREADS) this.threads = link.threads;
    const wanted = this.worlds.findIndex((world) => world.source === link.live);
    if (wanted >= 0) select.value = `live ${wanted}`;
    else if (link.run !== undefined && page.run) select.value = `run ${link.run}`;
    select.addEventListener("change", () => void this.show(select.value));
    await this.show(select.value, link);
    requestAnimationFrame(() => this.picture());
  }

  choose(id: number): void {
    if (id !== this.chosen) this.say(id >= 0 ? `Agent ${id} is chosen` : "No agent is chosen");
    this.chosen = id;
    this.panel.forget();
    if (this.source instanceof Live) {
      this.source.chosen = id;
      if (!this.playing) this.source.look();
    }
    this.panelsDue = 0;
    if (id >= 0) this.tab("agent");
    else this.follow(false);
    this.keepLink();
  }

  /** Chooses the living agent with the next higher id. */
  next(): void {
    const ids = this.frame?.id;
    if (ids && ids.length > 0) this.choose(ids.find((id) => id > this.chosen) ?? ids[0]!);
  }

  follow(on: boolean): void {
    if (on && this.chosen < 0) this.next();
    this.arena.follow = on;
    this.panelsDue = 0;
  }

  /** Shows the whole arena. */
  whole(): void {
    this.arena.follow = false;
    this.arena.fit(this.source);
    this.viewed();
  }

  /** Remembers the view that the user chose, and updates the link. */
  viewed(): void {
    remember("view", writeLink({ ...NOTHING, view: this.arena.view(this.source) }));
    this.keepLink();
  }

  fullScreen(): void {
    if (document.fullscreenElement) void document.exitFullscreen();
    else void by("stage").requestFullscreen?.().catch(() => this.say("This browser has no full screen"));
  }

  /** Handles a click at a place in the world: chooses the agent there, or edits the world. */
  click(x: number, y: number): void {
    const { scene } = this.arena;
    if (this.tools?.click(this.source, x, y, 1 / scene.zoom)) this.now = this.source.last;
    else if (this.frame) this.choose(this.arena.pick(this.source, this.frame, x, y));
  }

  seek(step: number): void {
    const { first, last } = this.source;
    this.now = Math.min(Math.max(Math.round(step), first), last);
    if (this.source.live && this.now < last) this.play(false);
    this.panelsDue = 0;
    this.keepLink();
  }

  /** Moves forward or back by frames of the records or steps of a live world. */
  step(by: number): void {
    this.play(false);
    if (this.source instanceof Live && by > 0 && this.now >= this.source.last && !this.source.over) {
      for (const each of this.running()) each.advance(by, 4000);
      this.now = Infinity;
      return;
    }
    for (let i = 0; i < Math.abs(by); i++) {
      const { before, after } = this.source.around(this.now);
      if (by > 0) this.now = after?.step ?? this.now;
      else this.now = before && before.step < this.now ? before.step : (this.source.around((before?.step ?? 1) - 1).before?.step ?? this.now);
    }
    this.seek(this.now);
  }

  /** Plays or pauses; a recording that has ended plays again from its beginning. */
  play(on: boolean): void {
    if (on && this.source.ended && this.now >= this.source.last) this.now = this.source.around(0).before?.step ?? this.source.first;
    if (this.playing && !on) this.say(`Paused at step ${show(Math.floor(this.now))}${this.population()}`);
    this.playing = on;
    by("play").textContent = on ? "Pause" : "Play";
    if (on) return;
    for (const each of this.running()) each.look();
    this.keepLink();
  }

  faster(by_: number): void {
    const at = SPEEDS.findIndex((speed) => speed >= this.speed);
    this.setSpeed(SPEEDS[Math.min(Math.max(at + by_, 0), SPEEDS.length - 1)]!);
  }

  tab(name: string): void {
    this.tabs.open(name);
  }

  /** The rays of agent `i` of the moment shown. */
  rays(i: number): Ray[] {
    return this.frame ? castRays(this.source, this.frame, i) : [];
  }

  help(): void {
    showHelp(this.source);
  }

  private opened(name: string): void {
    by("plots").parentElement!.parentElement!.classList.toggle("plotting", name === "plots" || name === "agents");
    this.panelsDue = 0;
  }

  private async show(name: string, link: Link = NOTHING): Promise<void> {
    const [kind, index] = name.split(" ");
    const world = this.worlds[Number(index)];
    this.goal = undefined;
    if (kind === "run") this.watch(await Replay.open(Number(index)));
    else if (world) {
      const known = new Set(world.settings.map(({ path }) => path));
      this.start(world, new Map([...link.changes].filter(([path]) => known.has(path))), link.seed ?? 1);
      if (link.step) this.goal = { step: link.step, agent: link.agent ?? -1 };
    }
    if (link.color) this.colors.choose(link.color);
    if (link.filter) this.table.write(link.filter);
    const view = link.view ?? readLink(recall("view") ?? "").view;
    if (view) this.arena.look(this.source, view);
    if (link.agent !== undefined && !this.goal) this.choose(link.agent);
    if (link.step !== undefined && kind === "run") {
      this.now = link.step;
      this.play(false);
    }
    this.keepLink();
  }

  /** The live worlds shown: one, or two side by side. */
  private running(): Live[] {
    return [this.source, this.twin.live].filter((each) => each instanceof Live);
  }

  /** Restarts the world, next to a copy of it with one setting changed. */
  private beside(first: Live, setting: Setting, value: string): void {
    const again = new Live(first.world, first.changes, first.seed, first.wanted);
    this.watch(again);
    this.twin.open(again, setting, value);
    this.tab("world-panel");
  }

  private start(world: LiveWorld, changes: Map<string, string>, seed: number): void {
    const live = new Live(world, changes, seed, this.threads);
    this.watch(live);
    new Settings(live, (other, next) => this.start(world, other, next));
    this.keepLink();
  }

  private watch(source: Source): void {
    const { source: former } = this;
    if (former instanceof Live) former.close();
    this.twin.close();
    const view = former ? this.arena.view(former) : undefined;
    [this.source, this.chosen, this.frame, this.now] = [source, -1, undefined, source.first];
    if (source instanceof Replay) by("settings").replaceChildren(...recordedSettings(source.settings));
    this.colors.offer(source);
    if (!by("agent").hidden) this.tab("plots"); // no agent is chosen
    this.arena.forgetTrails();
    this.heat.open(source);
    this.selection.open(source);
    this.table.open(source);
    this.plots = new Plots(source, (step) => this.seek(step));
    this.tree = new Tree(source, (bearers) => (this.arena.marked = bearers), () => this.chosen);
    const beside = (setting: Setting, value: string) => source instanceof Live && this.beside(source, setting, value);
    this.tools = new Tools(source, beside, () => this.twin.close());
    this.panel.forget();
    this.setSpeed(SPEEDS.findLast((speed) => speed <= Math.max(4, source.spacing / PICTURES))!);
    this.arena.follow = false;
    const same = former && JSON.stringify(former.layout.arena) === JSON.stringify(source.layout.arena);
    if (view && same) this.arena.look(source, view);
    else this.arena.fit(source);
    this.play(!matchMedia("(prefers-reduced-motion: reduce)").matches);
  }

  /** Updates the panels at once after a change of color, filter, rectangle or table order. */
  private changed(): void {
    this.panelsDue = 0;
    this.keepLink();
  }

  setSpeed(speed: number): void {
    this.speed = speed;
    by<HTMLSelectElement>("speed").value = String(speed);
  }

  private picture(): void {
    this.move();
    const shown = this.frame?.step;
    const { before, after } = this.source.around(this.now);
    this.frame = before && blend(before, after, this.source.live ? before.step : this.now);
    if (!this.playing) this.skipped = 0;
    else if (this.frame && shown !== undefined && this.frame.step > shown) this.skipped = this.frame.step - shown - 1;
    const legend = this.arena.draw(this.source, this.frame, this.colors.current, this.chosen);
    this.twin.draw(this.arena, this.now, this.colors.current, legend);
    if (this.frame) this.pictures++;
    const time = performance.now();
    if (time >= this.panelsDue) {
      this.panelsDue = time + PANEL_MS;
      this.showPanels(legend);
    }
    requestAnimationFrame(() => this.picture());
  }

  private move(): void {
    const { source } = this;
    if (source instanceof Live && this.goal) return this.hurry(source, this.goal);
    if (source instanceof Live && !(source.over && this.now < source.last)) {
      const running = this.running();
      const least = Math.min(...running.filter((each) => !each.over).map((each) => each.last), source.over ? Infinity : source.last);
      if (this.playing || this.now > source.last) this.now = Math.min(least, Math.max(...running.map((each) => each.last)));
      if (!this.playing) return;
      if (running.every((each) => each.over)) return this.end();
      this.owed = Math.min(this.owed + this.speed, this.speed + 1);
      if (this.owed < 1) return;
      // The faster of two worlds waits for the other.
      for (const each of running) {
        const steps = least + Math.floor(this.owed) - each.last;
        if (steps > 0) each.advance(steps, this.speed >= 256 ? HURRY_MS : PICTURE_MS);
      }
      this.owed %= 1;
    } else if (this.playing) {
      const ready = this.frame !== undefined || source.around(this.now).before === undefined;
      if (ready && source.around(this.now).before) this.now = Math.min(this.now + this.speed, source.last);
      if (source.ended && this.now >= source.last) this.end();
    }
  }

  /** Runs to the step of a link, and then chooses the link's agent. */
  private hurry(source: Live, goal: { step: number; agent: number }): void {
    this.now = source.last;
    if (source.last < goal.step && !source.over && !source.error) return void source.advance(goal.step - source.last, HURRY_MS);
    this.goal = undefined;
    this.play(false);
    this.choose(goal.agent);
  }

  private end(): void {
    this.play(false);
    this.say(`The end, at step ${show(this.source.last)}`);
  }

  private population(): string {
    return this.frame ? `, ${counted(this.frame.id.length, "agent")}` : "";
  }

  private showPanels(legend: ReturnType<Arena["draw"]>): void {
    const { source } = this;
    this.marks = events(source);
    this.timeline.draw(source, this.now, this.marks);
    this.chapters.update(source, this.marks, this.now);
    this.plots?.update(this.frame, this.now);
    this.tree?.update(this.frame);
    this.panel.update(source, this.frame, this.chosen);
    this.pick();
    this.heat.update();
    by("status").textContent = this.goal ? `going to step ${show(this.goal.step)} …` : source.status();
    const skipped = this.skipped > 0 ? `${counted(Math.round(this.skipped), "step")} skipped` : "";
    by("clock").replaceChildren(
      element("span", { text: `step ${show(Math.floor(Math.min(this.now, source.last)))} of ${show(source.last)}` }),
      element("span", { text: [this.population().slice(2), skipped].filter(Boolean).join(", ") }),
    );
    this.tools?.update(this.now);
    if (!this.playing && !this.goal) for (const each of this.running()) each.look();
    if (source instanceof Live) this.twin.caption(source, this.now);
    by("look-follow").setAttribute("aria-pressed", String(this.arena.follow));
    by("look-full").setAttribute("aria-pressed", String(document.fullscreenElement !== null));
    this.notice.about(source, this.now, this.arena.scene.lost, (live, seed) => this.start(live.world, live.changes, seed), () => this.play(true));
    if (legend) this.legend.update(source, this.arena, this.colors.current, legend, this.chosen >= 0);
  }

  /** Rings the picked agents, and lists them. */
  private pick(): void {
    const { frame, selection, arena } = this;
    if (!selection.active) arena.picked.clear();
    if (!frame || (!selection.active && by("agents").hidden)) return;
    const picked = selection.of(frame);
    if (selection.active) arena.picked = new Set(picked.map((i) => frame.id[i]!));
    this.table.update(frame, picked, this.chosen);
  }

  /** Announces a text to screen readers. */
  private say(text: string): void {
    by("said").textContent = text;
  }

  private keepLink(): void {
    if (this.goal) return;
    const { source } = this;
    const [kind, index] = by<HTMLSelectElement>("world").value.split(" ");
    const live = source instanceof Live ? { live: source.world.source, seed: source.seed, changes: source.changes } : NOTHING;
    // A link cannot lead to a step of a live world that is running or was edited by hand.
    const step = this.playing || !Number.isFinite(this.now) || (source instanceof Live && source.edited) ? undefined : Math.floor(this.now);
    const link: Link = { ...live, run: kind === "run" ? Number(index) : undefined, threads: this.threads || undefined, step, color: this.colors.current.name, filter: this.selection.text || undefined, view: this.arena.view(source) };
    if (this.chosen >= 0) link.agent = this.chosen;
    history.replaceState(null, "", `#${writeLink(link)}`);
  }
}
