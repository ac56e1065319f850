// One world of the article on its canvas: it plays while it is seen, begins again, runs to a step, and has a link.
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

const PICTURE_MS = 12; // of work for a world that plays, between two pictures
const RUN_MS = 100; // of work for a world that runs to a step, between two looks at it
const WORDS_MS = 150; // between two looks at the words
export const CALM = matchMedia("(prefers-reduced-motion: reduce)");

export interface Camera {
  scene: string; // the id of its section
  speed: number; // steps per picture
  coloring: Coloring;
  chosen?: number; // the agent that is followed from the start
  autoplay?: boolean; // whether it moves as soon as it is seen
  rays?: boolean;
  threads?: number; // 0 or nothing for as many as help
  trace?: boolean; // whether the path of the chosen agent is noted
}

export class Stage {
  live!: Live;
  changes = new Map<string, string>();
  seed = 1;
  playing = false;
  seen = false; // whether its arena is on the screen
  frame: Frame | undefined;
  chosen: number;
  actions: Actions | undefined; // of the chosen agent, if a person drives it
  notes = new Map<string, string>();
  edited = false; // whether no config and notes give this world
  pictures = 0;
  onBegin: () => void = () => {};
  onMoment: (moment: Moment) => void = () => {};
  onPicture: () => void = () => {};
  onWords: () => void = () => {};
  readonly arena: Arena;
  readonly ink: CanvasRenderingContext2D; // above the arena, in pixels of the page
  readonly play = button("Play", "main");
  readonly again = Object.assign(button("Reset"), { title: "Begin again: the first world, with every slider as at first" });
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

  /** Begins the world if there is none yet: when it comes into sight, or is used before. */
  ensure(): void {
    if (this.live) return;
    this.begin();
    if (this.camera.autoplay && !CALM.matches) this.setPlaying(true);
  }

  /** Begins the world, with what differs from its config. */
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

  /** Begins again as the scene's config and the first seed have it. */
  reset(): void {
    this.changes.clear();
    this.setPlaying(false);
    this.begin(1);
    this.host.closest("section")!.dispatchEvent(new CustomEvent("reset"));
  }

  /** Why a value of a setting is refused, or "". */
  refuses(path: string, value: string): string {
    const setting = this.setting(path);
    return setting ? refusal(setting, value) : `${path}: is no setting that this scene can change`;
  }

  /** Another value of a setting, for the next world. Returns why it is refused, or "". */
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

  /** Runs to a step as fast as it can; resolves when it is there and its digest is known, or when it cannot go on. */
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

  /** Ends a run to a step where it is. */
  stop(): void {
    this.wanted = "";
    this.finish();
  }

  get running(): boolean {
    return this.goal !== undefined;
  }

  /** The step that it runs to; -1 if to none. */
  get aim(): number {
    return this.goal?.step ?? -1;
  }

  /** Where it is. */
  place(): Place {
    return { scene: this.camera.scene, seed: this.seed, step: this.live.last, digest: this.live.digest(), changes: this.changes, notes: this.notes };
  }

  life(id = this.chosen): Life | undefined {
    return this.live.lives.get(id);
  }

  /** Once for each picture of the page. */
  picture(): void {
    if (this.near) this.ensure();
    if (!this.live) return;
    this.move();
    if (!this.near) return;
    this.frame = this.live.around(Infinity).before;
    if (this.seen) this.draw();
    if (performance.now() < this.wordsDue) return;
    this.wordsDue = performance.now() + WORDS_MS;
    this.words(); // also where the arena is out of sight: a chart, a button or an answer may be in it
  }

  /** Draws the newest moment, wherever the arena is. */
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

  /** Pixels of the canvas of a place in the world. */
  at(x: number, y: number): [number, number] {
    const box = this.ink.canvas.getBoundingClientRect();
    const [px, py] = this.arena.scene.toPage(x, y);
    return [px - box.left, py - box.top];
  }

  /** Goes on to its goal, or, if it plays, by the steps of a picture. */
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

  /** Goes on to its goal while the page is hidden, and has no pictures to go on by. */
  unseen(): void {
    if (document.hidden && this.goal) this.move();
  }

  /** Some steps, as the person who drives it tells; a scene may do it in another way. */
  advance(steps: number): boolean {
    return this.live.advance(steps, PICTURE_MS, { trace: this.camera.trace, actions: this.actions });
  }

  /** How many of the steps that are left to a goal it runs at once; a scene that steers on the way takes fewer. */
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

  /** Copies the link. A world that plays rests first, since only then it has a digest. */
  private async copy(): Promise<void> {
    const { live } = this;
    if (this.playing && !this.running) await this.runTo(live.last);
    if (live !== this.live) return; // another began since
    const address = addressOf(this.place());
    history.replaceState(null, "", address);
    copyAddress(this.same);
    const config = button("Save the config", "link");
    config.addEventListener("click", () => save(`${this.world.name}.toml`, this.world.toml));
    const same = element("code", { text: command(this.world, this.changes, this.seed, this.live.last) });
    const said = this.edited ? "You steered, so only the link has this world. It began as " : "The same world on a command line: ";
    this.how.replaceChildren(said, same, " ", config);
    this.how.hidden = false;
  }
}

export function button(text: string, kind = ""): HTMLButtonElement {
  return Object.assign(element("button", { text, class: kind }), { type: "button" });
}
