// The page: one source of moments, what is chosen, and what is drawn of it 60 times a second.
import { AgentPanel } from "./agent";
import { Arena } from "./arena";
import { blend } from "./blend";
import { type Coloring, colorings } from "./color";
import { by, element, option, show } from "./element";
import { Live } from "./live";
import { Plots } from "./plots";
import { castRays, type Ray } from "./rays";
import { Replay } from "./replay";
import { command, Settings } from "./settings";
import { events, Timeline } from "./timeline";
import { Tools } from "./tools";
import { Twin } from "./twin";
import type { Source } from "./source";
import type { Event, Frame, LiveWorld, Setting } from "./types";

const SPEEDS = [1 / 8, 1 / 4, 1 / 2, 1, 2, 4, 8, 16, 64, 256, 1000]; // steps per picture
const PICTURE_MS = 13; // of work for a live world between two pictures
const PANEL_MS = 200; // between two looks at the panels
const MOST_THREADS = 16; // that the engine has seats for
const HELP = [
  "Click an agent to inspect it. Drag to move, turn the wheel to zoom, 0 shows the whole arena.",
  "Space plays and pauses. ← and → step, with Shift ten at a time. Home and End go to the ends.",
  "+ and − change the speed. F follows the chosen agent, R shows its rays, T its trail. Tab or N chooses the next agent.",
  "A, P, S and W open the panels: agent, plots, settings, world. Esc chooses none.",
];
const PANELS = ["agent", "plots", "settings", "world-panel"];

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
  private coloring!: Coloring;
  private plots: Plots | undefined;
  private tools: Tools | undefined;
  private skipped = 0; // steps between the last two pictures that were not drawn
  private marks: Event[] = [];
  private panelsDue = 0;
  private threads = 0; // of a live world, as the link asks for; 0 for as many as help
  private owed = 0; // part of a step at speeds below 1
  private readonly panel = new AgentPanel((id) => this.choose(id));
  private readonly timeline = new Timeline(by<HTMLCanvasElement>("timeline"), (step) => this.seek(step), () => [this.source.first, this.source.last]);
  private worlds: LiveWorld[] = [];

  async open(): Promise<void> {
    for (const speed of SPEEDS) by("speed").append(option(String(speed), `${speed < 1 ? `1/${1 / speed}` : speed} steps per picture`));
    const told = (await (await fetch("data/page.json")).json()) as { run: boolean; worlds: LiveWorld[] };
    this.worlds = told.worlds;
    const select = by<HTMLSelectElement>("world");
    if (told.run) {
      const index = (await (await fetch("data/run.json")).json()) as { folder: string; seeds: number[] };
      index.seeds.forEach((seed, i) => select.append(option(`run ${i}`, `run ${index.folder}, seed ${seed}`)));
    }
    this.worlds.forEach((world, i) => select.append(option(`live ${i}`, `live: ${world.name}`)));
    const link = new URLSearchParams(location.hash.slice(1));
    const threads = Number(link.get("threads"));
    if (Number.isInteger(threads) && threads >= 1 && threads <= MOST_THREADS) this.threads = threads;
    const wanted = this.worlds.findIndex((world) => world.source === link.get("live"));
    if (wanted >= 0) select.value = `live ${wanted}`;
    else if (link.has("world")) select.value = `run ${link.get("world")}`;
    select.addEventListener("change", () => void this.show(select.value));
    this.bind();
    await this.show(select.value, link);
    requestAnimationFrame(() => this.picture());
  }

  choose(id: number): void {
    this.chosen = id;
    this.arena.forgetTrail();
    this.panel.forget();
    if (this.source instanceof Live) {
      this.source.chosen = id;
      if (!this.playing) this.source.look();
    }
    this.panelsDue = 0;
    if (id >= 0) this.tab("agent");
    this.keepLink();
  }

  /** A click at a place of the world: chooses who is there, or changes the world by hand. */
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

  /** One frame of the records, or one step of a live world, on or back. */
  step(by: number): void {
    this.play(false);
    if (this.source instanceof Live && by > 0 && this.now >= this.source.last) {
      for (const each of this.running()) each.advance(by, 4000);
      this.now = Infinity;
      return;
    }
    const { before, after } = this.source.around(this.now);
    if (by > 0) this.seek(after?.step ?? this.now + by);
    else this.seek(before && before.step < this.now ? before.step : (this.source.around((before?.step ?? 1) - 1).before?.step ?? this.now - 1));
  }

  play(on: boolean): void {
    this.playing = on;
    by("play").textContent = on ? "Pause" : "Play";
    if (!on) for (const each of this.running()) each.look();
  }

  faster(by_: number): void {
    const at = SPEEDS.findIndex((speed) => speed >= this.speed);
    this.setSpeed(SPEEDS[Math.min(Math.max(at + by_, 0), SPEEDS.length - 1)]!);
  }

  tab(name: string): void {
    for (const other of PANELS) {
      by(other).hidden = other !== name;
      by(`tab-${other}`).setAttribute("aria-selected", String(other === name));
    }
    this.panelsDue = 0;
  }

  private async show(name: string, link = new URLSearchParams()): Promise<void> {
    const [kind, index] = name.split(" ");
    const world = this.worlds[Number(index)];
    if (kind === "run") this.watch(await Replay.open(Number(index)));
    else if (world) this.start(world, new Map(), Number(link.get("seed") ?? 1));
    if (link.has("agent")) this.choose(Number(link.get("agent")));
    if (link.has("step") && kind === "run") {
      this.now = Number(link.get("step"));
      this.play(false);
    }
  }

  /** The live worlds that are shown: one, or two side by side. */
  private running(): Live[] {
    return [this.source, this.twin.live].filter((each) => each instanceof Live);
  }

  /** Begins the world again, and beside it the same one with a setting changed. */
  private beside(first: Live, setting: Setting, value: string): void {
    const again = new Live(first.world, first.changes, first.seed, first.wanted);
    this.watch(again);
    this.twin.open(again, setting, value);
    this.tab("world-panel");
  }

  private start(world: LiveWorld, changes: Map<string, string>, seed: number): void {
    this.watch(new Live(world, changes, seed, this.threads));
    new Settings(world, seed, (other, next) => this.start(world, other, next), changes);
    this.setSpeed(4);
  }

  private watch(source: Source): void {
    if (this.source instanceof Live) this.source.close();
    this.twin.close();
    [this.source, this.chosen, this.frame, this.now] = [source, -1, undefined, source.first];
    if (!source.live) by("settings").replaceChildren(element("p", { text: "Settings can be changed in a live world: choose one above." }));
    const colors = colorings(source);
    by("color").replaceChildren(...colors.map((each) => option(each.name, each.label)));
    this.coloring = colors[0]!;
    by("color").onchange = () => {
      this.coloring = colors.find((each) => each.name === by<HTMLSelectElement>("color").value) ?? colors[0]!;
    };
    this.plots = new Plots(source, (step) => this.seek(step));
    const beside = (setting: Setting, value: string) => source instanceof Live && this.beside(source, setting, value);
    this.tools = new Tools(source instanceof Live ? source : undefined, beside, () => this.twin.close());
    this.panel.forget();
    this.setSpeed(4);
    this.arena.fit(source);
    this.play(true);
  }

  private setSpeed(speed: number): void {
    this.speed = speed;
    by<HTMLSelectElement>("speed").value = String(speed);
  }

  private picture(): void {
    this.move();
    const { before, after } = this.source.around(this.now);
    const shown = this.frame?.step;
    this.frame = before && (this.source.live ? before : blend(before, after, this.now));
    if (!this.playing) this.skipped = 0;
    else if (this.frame && shown !== undefined && this.frame.step > shown) this.skipped = this.frame.step - shown - 1;
    const legend = this.arena.draw(this.source, this.frame, this.coloring, this.chosen);
    this.twin.draw(this.arena, this.now, this.coloring, legend);
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
    if (source instanceof Live) {
      const running = this.running();
      const least = Math.min(...running.filter((each) => !each.over).map((each) => each.last), source.over ? Infinity : source.last);
      if (this.playing || this.now > source.last) this.now = Math.min(least, Math.max(...running.map((each) => each.last)));
      if (!this.playing) return;
      this.owed = Math.min(this.owed + this.speed, this.speed + 1);
      if (this.owed < 1) return;
      // Of two worlds the faster one waits for the other.
      for (const each of running) {
        const steps = least + Math.floor(this.owed) - each.last;
        if (steps > 0) each.advance(steps, this.speed >= 256 ? 120 : PICTURE_MS);
      }
      this.owed %= 1;
    } else if (this.playing) {
      const ready = this.frame !== undefined || source.around(this.now).before === undefined;
      if (ready && source.around(this.now).before) this.now = Math.min(this.now + this.speed, source.last);
    }
  }

  private showPanels(legend: ReturnType<Arena["draw"]>): void {
    const { source } = this;
    this.marks = events(source);
    this.timeline.draw(source, this.now, this.marks);
    this.plots?.update(this.frame, this.now);
    this.panel.update(source, this.frame, this.chosen);
    by("status").textContent = source.status();
    const population = this.frame ? `, ${show(this.frame.id.length)} agents` : "";
    const skipped = this.skipped > 0 ? `, ${show(Math.round(this.skipped))} steps skipped` : "";
    by("clock").textContent = `step ${show(Math.floor(this.now))} of ${show(source.last)}${population}${skipped}`;
    this.tools?.update();
    if (!this.playing) for (const each of this.running()) each.look();
    if (source instanceof Live) this.twin.caption(source, this.now);
    by("notice").hidden = !(source instanceof Live && source.error);
    if (source instanceof Live && source.error) by("notice").textContent = source.error;
    if (legend) this.showLegend(legend);
  }

  private showLegend(legend: NonNullable<ReturnType<Arena["draw"]>>): void {
    const bar = element("div", { class: "bar" });
    if (this.coloring.scale === "ramp" || this.coloring.scale === "diverging") {
      bar.append(show(legend.low), element("i"), show(legend.high));
      bar.querySelector("i")!.style.background = `linear-gradient(90deg, ${legend.stops.join(", ")})`;
    }
    const foods = [...(this.coloring.key ?? []), ...this.source.layout.foods].map((each): HTMLElement => {
      const dot = element("b", { text: "●" });
      dot.style.color = each.color;
      return element("span", {}, dot, ` ${each.name}`);
    });
    const { source } = this;
    const digest = source.digest();
    const made: HTMLElement[] = digest && (!source.live || this.now === source.last) ? [element("div", { text: `digest ${digest}${source instanceof Live && source.edited ? ", changed by hand" : ""}` })] : [];
    if (made.length > 0) made[0]!.id = "digest";
    const kernel = source instanceof Live ? [element("div", { text: `${source.fused ? "multiply-adds are fused, as with AVX2 and AVX-512" : "kernel portable"}, ${source.threads > 1 ? `${source.threads} threads` : "1 thread"}` })] : [];
    by("legend").replaceChildren(element("div", { text: this.coloring.label }), bar, element("div", {}, ...foods), ...kernel, ...made);
  }

  private bind(): void {
    by("play").onclick = () => this.play(!this.playing);
    by("step-on").onclick = () => this.step(1);
    by("step-back").onclick = () => this.step(-1);
    by("speed").onchange = () => this.setSpeed(Number(by<HTMLSelectElement>("speed").value));
    for (const name of PANELS) by(`tab-${name}`).onclick = () => this.tab(name);
    by("show-rays").onchange = () => (this.arena.showRays = by<HTMLInputElement>("show-rays").checked);
    by("show-trail").onchange = () => (this.arena.showTrail = by<HTMLInputElement>("show-trail").checked);
    by("theme").onclick = () => {
      const dark = getComputedStyle(document.documentElement).colorScheme.startsWith("dark");
      document.documentElement.dataset.theme = dark ? "light" : "dark";
    };
    by("help-button").onclick = () => this.help();
  }

  /** The rays of an agent of the moment that is shown. */
  rays(i: number): Ray[] {
    return this.frame ? castRays(this.source.layout, this.frame, i, this.source.obstacles) : [];
  }

  help(): void {
    const box = by("help");
    box.hidden = !box.hidden;
    const lines: HTMLElement[] = HELP.map((text) => element("p", { text }));
    const { source } = this;
    if (source instanceof Live) {
      const same = command(source.world, source.changes, source.seed, source.last);
      const said = source.edited ? "It was changed by hand: no command makes the same world. It began as" : "The same world, with the same digest:";
      lines.push(element("p", { text: said }), element("code", { text: same }));
    }
    box.replaceChildren(...lines);
  }

  private keepLink(): void {
    const [kind, index] = by<HTMLSelectElement>("world").value.split(" ");
    const link = new URLSearchParams();
    if (kind === "run") link.set("world", index!);
    else if (this.source instanceof Live) link.set("live", this.source.world.source);
    if (this.source instanceof Live) link.set("seed", String(this.source.seed));
    if (this.threads > 0) link.set("threads", String(this.threads));
    if (Number.isFinite(this.now)) link.set("step", String(Math.floor(this.now)));
    if (this.chosen >= 0) link.set("agent", String(this.chosen));
    history.replaceState(null, "", `#${link}`);
  }
}
