// One world of the article on its canvas. It plays while visible, can be restarted or run to a step, and has a link.
import { Arena } from "../arena";
import type { Coloring } from "../color";
import { element, show } from "../element";
import { Live } from "../live";
import type { Actions, Moment } from "../live.worker";
import { save } from "../csv";
import { command, refusal } from "../settings";
import type { Frame, Life, LiveWorld } from "../types";
import { addressOf, copyAddress, type Place, SHORT } from "./link";
import { hideStill, showStill } from "./still";

const PICTURE_MS = 12; // of work between two pictures, for a world that plays
const RUN_MS = 100; // of work between two updates, for a world that runs to a step
const WORDS_MS = 150; // between two updates of the text
export const CALM = matchMedia("(prefers-reduced-motion: reduce)");

export interface Camera {
  scene: string; // the id of its section
  speed: number; // steps per picture
  coloring: Coloring;
  chosen?: number; // the agent followed from the start
  first?: number; // seed of its first world; undefined for 1
  autoplay?: boolean; // whether it plays as soon as it is visible
  rays?: boolean;
  threads?: number; // 0 or undefined lets the worker choose
  trace?: boolean; // whether the path of the chosen agent is recorded
}

export class Stage {
  live!: Live;
  changes = new Map<string, string>();
  seed: number;
  playing = false;
  seen = false; // whether its arena is on the screen
  frame: Frame | undefined;
  chosen: number;
  actions: Actions | undefined; // of the chosen agent, if the reader drives it
  notes = new Map<string, string>();
  edited = false; // whether the world can no longer be reproduced from its config and notes
  pictures = 0;
  onBegin: () => void = () => {};
  onMoment: (moment: Moment) => void = () => {};
  onPicture: () => void = () => {};
  onWords: () => void = () => {};
  readonly arena: Arena;
  readonly ink: CanvasRenderingContext2D; // overlay of the arena, in pixels of the page
  readonly play = button("Play", "main");
  readonly again = Object.assign(button("Reset"), { title: "Begin again with the first world and every slider as it was at first" });
  readonly bar = element("div", { class: "bar" });
  private readonly clock = element("span", { class: "clock" });
  private readonly same = element("a", { class: "permalink", text: "link" });
  private readonly mark = element("code", { class: "digest" });
  private readonly how = element("p", { class: "how" });
  private readonly fault = element("p", { class: "fault" }, element("span"), " ");
  private goal: { step: number; done: () => void } | undefined;
  private wanted = "";
  private wordsDue = 0;
  private near = false; // whether any part of its section is on the screen

  constructor(
    readonly host: HTMLElement,
    public world: LiveWorld,
    readonly camera: Camera,
  ) {
    const canvas = host.querySelector<HTMLCanvasElement>("canvas.world")!;
    const above = element("canvas", { class: "ink" });
    above.setAttribute("aria-hidden", "true");
    canvas.after(above);
    this.arena = new Arena(canvas);
    this.arena.showRays = camera.rays ?? false;
    this.arena.showTrail = false;
    this.ink = above.getContext("2d")!;
    this.chosen = camera.chosen ?? -1;
    this.seed = this.first;
    this.play.addEventListener("click", () => (this.running ? this.stop() : this.setPlaying(!this.playing)));
    this.again.addEventListener("click", () => this.reset());
    this.same.addEventListener("click", (event) => {
      event.preventDefault();
      void this.copy();
    });
    this.bar.append(this.play, this.again, this.clock, this.same, this.mark);
    this.how.hidden = this.fault.hidden = true;
    const retry = button("Try again");
    retry.addEventListener("click", () => this.begin());
    this.fault.setAttribute("role", "alert");
    this.fault.append(retry);
    above.after(this.fault);
    const near = new IntersectionObserver((entries) => (this.near = entries[entries.length - 1]!.isIntersecting));
    near.observe(host.closest("section")!);
    (host.querySelector(".meters") ?? host.querySelector(".view"))!.after(this.bar, this.how);
  }

  /** Begins the world if there is none yet; called when it becomes visible or is used before that. */
  ensure(): void {
    if (this.live) return;
    this.begin();
    if (this.camera.autoplay && !CALM.matches) this.setPlaying(true);
  }

  /** Begins the world, with the changes to its config. */
  begin(seed = this.seed): void {
    this.live?.close();
    this.finish();
    this.how.hidden = this.fault.hidden = true;
    [this.seed, this.frame, this.edited, this.actions, this.wanted] = [seed, undefined, false, undefined, ""];
    this.chosen = this.camera.chosen ?? -1;
    this.notes = new Map();
    this.live = new Live(this.world, new Map(this.changes), seed, this.camera.threads ?? 0);
    this.live.chosen = this.chosen;
    this.live.onMoment = (moment) => {
      this.onMoment(moment);
      this.unseen();
    };
    this.arena.forgetTrails();
    this.arena.fit(this.live);
    this.wordsDue = 0;
    this.onBegin();
  }

  /** Begins again with the scene's config and the first seed. */
  reset(): void {
    this.changes.clear();
    this.setPlaying(false);
    this.begin(this.first);
    this.host.closest("section")!.dispatchEvent(new CustomEvent("reset"));
  }

  /** The reason why a value of a setting is refused, or "". */
  refuses(path: string, value: string): string {
    const setting = this.setting(path);
    return setting ? refusal(setting, value) : `${path}: is no setting that this scene can change`;
  }

  /** Changes settings of the next world. Returns the reason if the value is refused, or "". */
  set(paths: string[], value: string): string {
    for (const path of paths) {
      const wrong = this.refuses(path, value);
      if (wrong) return wrong;
      const setting = this.setting(path)!;
      if (setting.choices.length > 0 ? value === setting.value : Number(value) === Number(setting.value)) this.changes.delete(path);
      else this.changes.set(path, value);
    }
    return "";
  }

  /** The value of a setting in this world. */
  value(path: string): number {
    return Number(this.changes.get(path) ?? this.setting(path)?.value);
  }

  private setting(path: string) {
    return this.world.settings.find((each) => each.path === path);
  }

  setPlaying(on: boolean): void {
    this.playing = on;
    this.label();
  }

  private label(): void {
    const moves = this.playing || this.running;
    this.play.textContent = moves ? "Pause" : "Play";
    this.play.setAttribute("aria-pressed", String(moves));
  }

  /** Runs to a step as fast as possible. Resolves once the world is there and its digest is known, or if it cannot continue. */
  runTo(step: number, wanted = ""): Promise<void> {
    this.ensure();
    this.setPlaying(false);
    this.finish();
    this.wanted = wanted;
    this.wordsDue = 0;
    return new Promise((done) => {
      this.goal = { step, done };
      this.label();
    });
  }

  /** Stops a run to a step at the current step. */
  stop(): void {
    this.wanted = "";
    this.finish();
  }

  /** The seed of its first world. */
  get first(): number {
    return this.camera.first ?? 1;
  }

  get running(): boolean {
    return this.goal !== undefined;
  }

  /** The step to which the world is running; -1 if there is none. */
  get aim(): number {
    return this.goal?.step ?? -1;
  }

  /** The current place, for a link. */
  place(): Place {
    return { scene: this.camera.scene, seed: this.seed, step: this.live.last, digest: this.live.digest(), changes: this.changes, notes: this.notes };
  }

  life(id = this.chosen): Life | undefined {
    return this.live.lives.get(id);
  }

  /** Advances and draws; called for every animation frame. */
  picture(): void {
    if (this.near) this.ensure();
    if (!this.live) return;
    this.move();
    if (!this.near) return;
    this.frame = this.live.around(Infinity).before;
    if (this.seen) this.draw();
    if (performance.now() < this.wordsDue) return;
    this.wordsDue = performance.now() + WORDS_MS;
    this.words(); // even if the arena is off screen, since a chart, a button or an answer may be visible
  }

  /** Draws the newest moment, whether or not the arena is visible. */
  show(): void {
    this.frame = this.live.around(Infinity).before;
    this.draw();
    this.words();
  }

  private draw(): void {
    const { ink, arena } = this;
    arena.draw(this.live, this.frame, this.camera.coloring, this.chosen);
    const { clientWidth, clientHeight } = ink.canvas;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    [ink.canvas.width, ink.canvas.height] = [clientWidth * ratio, clientHeight * ratio];
    ink.scale(ratio, ratio);
    this.onPicture();
    this.pictures++;
  }

  /** The pixel of the canvas at a place in the world. */
  at(x: number, y: number): [number, number] {
    const box = this.ink.canvas.getBoundingClientRect();
    const [px, py] = this.arena.scene.toPage(x, y);
    return [px - box.left, py - box.top];
  }

  /** Advances toward the goal or, if the world plays, by the steps of one picture. */
  move(): void {
    const { live, goal } = this;
    if (goal) {
      if (live.error || live.over || live.last >= goal.step) {
        if (live.error || live.digest()) this.finish();
        else live.look();
      } else {
        const steps = this.ahead(goal.step - live.last);
        live.advance(steps, RUN_MS, { trace: this.camera.trace, actions: this.actions });
      }
    } else if (this.playing && this.seen) this.advance(this.camera.speed);
    else live.look();
  }

  /** Advances toward the goal while the page is hidden and has no animation frames. */
  unseen(): void {
    if (document.hidden && this.goal) this.move();
  }

  /** Runs some steps with the actions of the reader; scenes may override it. */
  advance(steps: number): boolean {
    return this.live.advance(steps, PICTURE_MS, { trace: this.camera.trace, actions: this.actions });
  }

  /** How many of the steps left to a goal to run at once; a scene that steers in between takes fewer. */
  ahead(left: number): number {
    return left;
  }

  private finish(): void {
    const { goal } = this;
    this.goal = undefined;
    this.label();
    goal?.done();
  }

  private words(): void {
    const { live } = this;
    const digest = live.digest();
    if (live.over && this.playing) this.setPlaying(false);
    this.fault.hidden = live.error === "";
    if (live.error && live.last === 0) showStill(this.fault.parentElement!, this.camera.scene);
    else hideStill(this.fault.parentElement!);
    if (live.error && !this.fault.firstElementChild!.textContent!.includes(live.error)) this.fault.firstElementChild!.textContent = `This world stopped: ${live.error}.`;
    this.clock.textContent = `step ${show(live.last)}${live.over ? ", all dead" : ""}`;
    this.same.href = addressOf(this.place());
    this.mark.textContent = digest ? digest.slice(0, SHORT) : "";
    const same = this.wanted !== "" && digest.startsWith(this.wanted);
    if (digest && this.wanted && this.running === false) this.mark.textContent += same ? ", as in the link" : `, in the link ${this.wanted}`;
    this.onWords();
  }

  /** Copies the link. Pauses the world first, since a running world has no digest. */
  private async copy(): Promise<void> {
    const { live } = this;
    if (this.playing && !this.running) await this.runTo(live.last);
    if (live !== this.live) return; // another world has begun in the meantime
    const address = addressOf(this.place());
    history.replaceState(null, "", address);
    copyAddress(this.same);
    const config = button("Save the config", "link");
    config.addEventListener("click", () => save(`${this.world.name}.toml`, this.world.toml));
    const same = element("code", { text: command(this.world, this.changes, this.seed, this.live.last) });
    const intro = this.edited ? "You steered, so only the link reproduces this world. It began as " : "The same world on a command line: ";
    this.how.replaceChildren(intro, same, " ", config);
    this.how.hidden = false;
  }
}

export function button(text: string, kind = ""): HTMLButtonElement {
  return Object.assign(element("button", { text, class: kind }), { type: "button" });
}
