// The rectangle dragged in the scatter plot of two genes, which picks the agents whose points are inside.
import { element, show, styleColor } from "./element";
import type { Life } from "./types";

const STILL = 4; // pixels that a click may move; a click removes the rectangle
const RIM = 0.97; // of the axis: points from here on, which may be beyond it, are drawn at the rim

/** What the scatter plot shows: two genes of a species, each from -limit to limit. */
export interface Scatter {
  canvas: HTMLCanvasElement;
  species: number;
  genes: [number, number];
  limit: number;
}

type Range = [number, number];

export class Brush {
  /** Called when the set of picked agents changes. */
  changed = (): void => undefined;
  private area: { species: number; genes: [number, number]; x: Range; y: Range } | undefined;
  private scatter: Scatter | undefined;
  private from: [number, number] | undefined; // where the drag began, in pixels of the canvas
  private readonly seen = new WeakSet<HTMLCanvasElement>();

  get active(): boolean {
    return this.area !== undefined;
  }

  /** Draws the rectangle after the scatter plot; removes it if the axes or the species have changed. */
  drawn(scatter: Scatter): void {
    this.scatter = scatter;
    if (!this.seen.has(scatter.canvas)) this.attach(scatter.canvas);
    const { area } = this;
    if (!area) return;
    if (String([area.species, area.genes]) !== String([scatter.species, scatter.genes])) return this.clear();
    const { canvas, limit } = scatter;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    const share = (value: number) => (Math.min(Math.max(value / limit, -1), 1) + 1) / 2;
    const [left, right, top, bottom] = [share(area.x[0]) * width, share(area.x[1]) * width, (1 - share(area.y[1])) * height, (1 - share(area.y[0])) * height];
    const pen = canvas.getContext("2d")!;
    pen.fillStyle = pen.strokeStyle = styleColor("--picked");
    pen.globalAlpha = 0.15;
    pen.fillRect(left, top, right - left, bottom - top);
    pen.globalAlpha = 1;
    pen.strokeRect(left + 0.5, top + 0.5, Math.max(right - left - 1, 1), Math.max(bottom - top - 1, 1));
  }

  clear(): void {
    if (!this.area) return;
    this.area = undefined;
    this.changed();
  }

  holds(life: Life | undefined): boolean {
    const { area } = this;
    if (!area || !life || life.species !== area.species) return false;
    const [x, y] = [life.genome[area.genes[0]]!, life.genome[area.genes[1]]!];
    return x >= area.x[0] && x <= area.x[1] && y >= area.y[0] && y <= area.y[1];
  }

  /** The rectangle in words, with the names of genes; "" for none. */
  text(names: string[]): string {
    if (!this.area) return "";
    const { genes, x, y } = this.area;
    const range = (gene: number, [low, high]: Range) => {
      if (low === -Infinity) return high === Infinity ? `any ${names[gene]}` : `${names[gene]} up to ${show(high, 3)}`;
      return `${names[gene]} ${high === Infinity ? `from ${show(low, 3)}` : `${show(low, 3)} to ${show(high, 3)}`}`;
    };
    return `${range(genes[0], x)}, ${range(genes[1], y)}`;
  }

  private attach(canvas: HTMLCanvasElement): void {
    this.seen.add(canvas);
    canvas.classList.add("brushed");
    canvas.after(element("p", { class: "quiet", text: "Drag a rectangle to ring its agents in the arena and list them in the panel Agents; a click removes it. With the keyboard, use the filter there." }));
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.from = [event.offsetX, event.offsetY];
    });
    canvas.addEventListener("pointermove", (event) => {
      if (this.from && far(this.from, event)) this.span(this.from, [event.offsetX, event.offsetY]);
    });
    canvas.addEventListener("pointerup", (event) => {
      if (this.from && !far(this.from, event)) this.clear();
      this.from = undefined;
    });
    canvas.addEventListener("pointercancel", () => (this.from = undefined));
  }

  /** Sets the rectangle between two pixels of the canvas. */
  private span(from: [number, number], to: [number, number]): void {
    if (!this.scatter) return;
    const { canvas, species, genes, limit } = this.scatter;
    const range = (a: number, b: number, size: number): Range => {
      const [low, high] = [Math.min(a, b), Math.max(a, b)].map((each) => (2 * each) / size - 1) as Range;
      return [low <= -RIM ? -Infinity : low * limit, high >= RIM ? Infinity : high * limit];
    };
    const { clientWidth: width, clientHeight: height } = canvas;
    this.area = { species, genes, x: range(from[0], to[0], width), y: range(height - from[1], height - to[1], height) };
    this.changed();
  }
}

const far = ([x, y]: [number, number], event: PointerEvent) => Math.hypot(event.offsetX - x, event.offsetY - y) >= STILL;

/** The page has one scatter plot, and so one rectangle. */
export const brush = new Brush();
