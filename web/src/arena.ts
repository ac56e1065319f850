// Draws one moment of a world: walls, foods, agents, and the marks of the chosen agent.
import { bodyOf } from "./body";
import { type Coloring, foodColors, pack, paint, type Painted, parse, speciesColor, typeColor, UNKNOWN } from "./color";
import { styleColor } from "./element";
import { castRays } from "./rays";
import { Scene } from "./scene";
import { noses } from "./smells";
import type { Source } from "./source";
import { Trails } from "./trails";
import type { Frame, Layout, Place, Species } from "./types";

/** Center x, center y, and the zoom relative to the view of the whole arena. */
export type View = [number, number, number];

const MOST_FOLLOWED = 20; // picked agents that have trails and rays
const FAINT = 0.1; // intensity of a smell at the rim of its drawn halo, relative to its source
const HALO = 0x10000000; // the alpha of the halo, in a packed color

/** The cosine of half the angle of a mouth. */
const mouthOf = (species: Species) => Math.cos((species.mouth_degrees * Math.PI) / 180);
/** The direction of the middle of a mouth. */
const middleOf = (species: Species) => (species.mouth_center_degrees * Math.PI) / 180;

export class Arena {
  readonly scene: Scene;
  showRays = true;
  showTrail = true;
  rings = true; // around all species but the first
  ringColor = ""; // name of the rings' color in the page's style; "" for the color of each species
  follow = false;
  marked = new Set<number>(); // agents of the branch chosen in the tree
  picked = new Set<number>(); // agents that match the filter and the rectangle of the scatter plot
  under: ((scene: Scene) => void) | undefined; // draws below everything else
  drawMilliseconds = 0; // spent by the page on the last frame
  private colors = new Uint32Array(256);
  private readonly trails = new Trails();
  private fitted = false;
  private moved = false; // whether the user chose a view other than the whole arena

  constructor(canvas: HTMLCanvasElement) {
    this.scene = new Scene(canvas);
  }

  /** Shows the whole arena. */
  fit(source: Source): void {
    const { width, height } = source.layout.arena;
    [this.scene.centerX, this.scene.centerY] = [width / 2, height / 2];
    this.scene.zoom = this.whole(source);
    this.fitted = true;
    this.moved = false;
  }

  /** The current view; undefined for the whole arena. */
  view(source: Source): View | undefined {
    return this.moved ? [this.scene.centerX, this.scene.centerY, this.scene.zoom / this.whole(source)] : undefined;
  }

  look(source: Source, [x, y, zoom]: View): void {
    [this.scene.centerX, this.scene.centerY, this.scene.zoom] = [x, y, zoom * this.whole(source)];
    this.fitted = this.moved = true;
  }

  /** Zooms by `factor`, then moves the view so that the place under pixel `from` of the page ends up under `to`. */
  drag(from: Place, to: Place, factor = 1): void {
    const { scene } = this;
    const [x, y] = scene.toWorld(...from);
    scene.zoom = Math.min(Math.max(scene.zoom * factor, 0.02), 60);
    const [nowX, nowY] = scene.toWorld(...to);
    scene.centerX += x - nowX;
    scene.centerY += y - nowY;
    this.moved = true;
  }

  private whole(source: Source): number {
    const { width, height } = source.layout.arena;
    const { canvas } = this.scene;
    return 0.96 * Math.min(canvas.width / width, canvas.height / height);
  }

  draw(source: Source, frame: Frame | undefined, coloring: Coloring, chosen: number): Painted["legend"] | undefined {
    const begun = performance.now();
    const view = this.view(source);
    if (this.scene.resize() || !this.fitted) {
      if (view) this.look(source, view);
      else this.fit(source);
    }
    const [background, ink] = [parse(styleColor("--ground")), pack(parse(styleColor("--wall")))];
    this.scene.begin();
    this.under?.(this.scene);
    for (const corners of source.obstacles) this.scene.polygon(corners, pack(parse(source.layout.obstacle_color)));
    for (const [ax, ay, bx, by] of source.layout.arena.walls) this.scene.line(ax, ay, bx, by, ink);
    const legend = frame ? this.drawFrame(source, frame, coloring, chosen) : undefined;
    this.scene.end([background[0] / 255, background[1] / 255, background[2] / 255]);
    this.drawMilliseconds = performance.now() - begun;
    return legend;
  }

  /** The id of the agent at a place in the world, or -1. */
  pick(source: Source, frame: Frame, x: number, y: number): number {
    let [best, nearest] = [Infinity, -1];
    for (let i = 0; i < frame.id.length; i++) {
      const radius = bodyOf(source, frame, i).radius + 4 / this.scene.zoom;
      const distance = (frame.x[i]! - x) ** 2 + (frame.y[i]! - y) ** 2;
      if (distance < Math.min(best, radius * radius)) [best, nearest] = [distance, frame.id[i]!];
    }
    return nearest;
  }

  forgetTrails(): void {
    this.trails.forget();
  }

  private drawFrame(source: Source, frame: Frame, coloring: Coloring, chosen: number): Painted["legend"] {
    const { layout } = source;
    const mouths = layout.species.map(mouthOf);
    const middles = layout.species.map(middleOf);
    if (this.colors.length < frame.id.length) this.colors = new Uint32Array(frame.id.length * 2);
    const { colors, legend } = paint(coloring, source, frame, this.colors);
    const at = frame.id.indexOf(chosen);
    this.followed(source, frame, at);
    const foods = foodColors(layout);
    const unknown = pack(parse(styleColor("--quiet")));
    this.drawSmells(layout, frame, foods);
    for (let f = 0; f < frame.foodX.length; f++) {
      const kind = frame.foodKind[f]!;
      this.scene.disc(frame.foodX[f]!, frame.foodY[f]!, layout.foods[kind]!.radius, foods[kind]!);
    }
    const ring = this.ringColor ? pack(parse(styleColor(this.ringColor))) : undefined;
    for (let i = 0; i < frame.id.length; i++) {
      const species = frame.species[i]!;
      const body = bodyOf(source, frame, i);
      const [mouth, middle] = body.sets.length > 0 ? [mouthOf(body), middleOf(body)] : [mouths[species]!, middles[species]!];
      const { radius } = body;
      const known = colors[i] !== UNKNOWN;
      this.scene.disc(frame.x[i]!, frame.y[i]!, radius, known ? colors[i]! : unknown, frame.angle[i]!, mouth, known ? 0 : 0.3, middle);
      if (species > 0 && this.rings) this.scene.disc(frame.x[i]!, frame.y[i]!, radius * 1.14, ring ?? speciesColor(layout, species), 0, 2, 0.16);
    }
    if (this.picked.size > 0) this.ring(source, frame, this.picked, "--picked", 1.45);
    if (this.marked.size > 0) this.ring(source, frame, this.marked, "--branch", 1.5);
    if (at >= 0) this.markKin(source, frame, at);
    return legend;
  }

  /** Draws a halo around everything that a species smells, as far as the smell reaches. */
  private drawSmells(layout: Layout, frame: Frame, foods: number[]): void {
    const reach = layout.types.map((_, type) =>
      Math.max(0, ...layout.species.filter((each) => each.smells.includes(type)).map((each) => Math.log(1 / FAINT) / each.noses.decay)),
    );
    if (reach.every((each) => each === 0)) return;
    const halo = (type: number, x: number, y: number, color: number) => {
      if (reach[type]! > 0) this.scene.disc(x, y, reach[type]!, (color & 0xffffff) | HALO);
    };
    for (let i = 0; i < frame.id.length; i++) halo(frame.species[i]!, frame.x[i]!, frame.y[i]!, speciesColor(layout, frame.species[i]!));
    for (let f = 0; f < frame.foodX.length; f++) halo(layout.species.length + frame.foodKind[f]!, frame.foodX[f]!, frame.foodY[f]!, foods[frame.foodKind[f]!]!);
  }

  /** Draws trails and rays of the chosen agent and of some picked agents. */
  private followed(source: Source, frame: Frame, at: number): void {
    if (at >= 0 && this.follow) [this.scene.centerX, this.scene.centerY] = [frame.x[at]!, frame.y[at]!];
    const others: number[] = [];
    for (let i = 0; this.picked.size > 0 && i < frame.id.length && others.length < MOST_FOLLOWED; i++) {
      if (i !== at && this.picked.has(frame.id[i]!)) others.push(i);
    }
    const all = at >= 0 ? [...others, at] : others;
    if (all.length === 0) return this.trails.forget();
    this.trails.note(frame, all);
    for (const i of all) {
      if (this.showTrail) this.trails.draw(this.scene, frame.id[i]!, i === at ? "--mark" : "--picked");
      if (this.showRays) this.drawRays(source, frame, i);
    }
  }

  private drawRays(source: Source, frame: Frame, at: number): void {
    const { layout } = source;
    const [nothing, wall] = [pack(parse(styleColor("--quiet")), 110), styleColor("--wall")];
    for (const ray of castRays(source, frame, at)) {
      const color = ray.type < 0 ? nothing : pack(parse(typeColor(layout, ray.type) || wall));
      this.scene.line(ray.x0, ray.y0, ray.x1, ray.y1, color);
      if (ray.type >= 0) this.scene.disc(ray.x1, ray.y1, 1.4, color);
    }
  }

  /** Draws rings around some agents, in a color of the page's style. */
  private ring(source: Source, frame: Frame, ids: Set<number>, name: string, size: number): void {
    const color = pack(parse(styleColor(name)));
    for (let i = 0; i < frame.id.length; i++) {
      if (ids.has(frame.id[i]!)) this.scene.disc(frame.x[i]!, frame.y[i]!, bodyOf(source, frame, i).radius * size, color, 0, 2, 0.16);
    }
  }

  private markKin(source: Source, frame: Frame, at: number): void {
    const radius = (i: number) => bodyOf(source, frame, i).radius;
    const [mark, kin] = [pack(parse(styleColor("--mark"))), pack(parse(styleColor("--kin")))];
    const chosen = frame.id[at]!;
    for (let i = 0; i < frame.id.length; i++) {
      const related = i !== at && source.lives.kin(chosen, frame.id[i]!, 2);
      if (related) this.scene.disc(frame.x[i]!, frame.y[i]!, radius(i) * 1.35, kin, 0, 2, 0.14);
    }
    this.scene.disc(frame.x[at]!, frame.y[at]!, radius(at) * 1.6, mark, 0, 2, 0.16);
    if (source.layout.species[frame.species[at]!]!.smells.length === 0) return;
    for (const [x, y] of noses(source, frame, at)) this.scene.disc(x, y, 2, mark);
  }
}
