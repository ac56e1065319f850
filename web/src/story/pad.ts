// A plot into which the reader draws a guess from left to right, with a pointer or the arrow keys.
import type { Chart } from "./chart";

const NUDGE = 0.05; // share of the plot's height by which a key moves the pen

export class Pad {
  guess: number[] = []; // levels at equally spaced points, from the left
  shut = false; // whether it accepts no more drawing, so that a finger scrolls over it

  /** Makes a pad with `points` points. The guess starts at the level `begin`; `draw` is called after each change. */
  constructor(
    readonly chart: Chart,
    readonly points: number,
    readonly begin: () => number,
    readonly draw: () => void,
  ) {
    const { canvas } = chart;
    /** Whether a pointer draws: of several fingers, only the first. */
    const draws = (event: PointerEvent) => !this.shut && event.isPrimary && event.buttons === 1;
    canvas.addEventListener("pointerdown", (event) => {
      if (!draws(event)) return;
      canvas.setPointerCapture(event.pointerId);
      const [x, y] = chart.place(event);
      this.guess.length = Math.min(this.guess.length, this.index(x));
      this.put(x, y);
    });
    canvas.addEventListener("pointermove", (event) => draws(event) && this.put(...chart.place(event)));
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  get whole(): boolean {
    return this.guess.length >= this.points;
  }

  /** The guess as points of the plot. */
  line(): [number, number][] {
    const { low, high } = this.chart.x;
    return this.guess.map((value, i) => [low + (i * (high - low)) / (this.points - 1), value]);
  }

  clear(): void {
    this.guess = [];
    this.draw();
  }

  /** Extends the guess to a place in a straight line. */
  put(x: number, level: number): void {
    const { low, high } = this.chart.y;
    const value = Math.min(Math.max(level, low), high);
    const to = this.index(x);
    const from = Math.min(this.guess.length, to);
    const begin = this.guess[from - 1] ?? this.begin();
    for (let i = from; i <= to; i++) this.guess[i] = begin + ((value - begin) * (i - from + 1)) / (to - from + 1);
    this.draw();
  }

  private index(x: number): number {
    const { low, high } = this.chart.x;
    return Math.round(((x - low) / (high - low)) * (this.points - 1));
  }

  private key(event: KeyboardEvent): void {
    if (this.shut) return;
    const { low, high } = this.chart.y;
    const at = this.guess.length - 1;
    const value = this.guess[at] ?? this.begin();
    if (event.key === "ArrowRight" && !this.whole) this.guess.push(value);
    else if (event.key === "ArrowLeft" && at >= 0) this.guess.pop();
    else if (event.key === "ArrowUp" || event.key === "ArrowDown") {
      const next = value + (event.key === "ArrowUp" ? 1 : -1) * NUDGE * (high - low);
      this.guess[Math.max(at, 0)] = Math.min(Math.max(next, low), high);
    } else return;
    event.preventDefault();
    this.draw();
  }
}
