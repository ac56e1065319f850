// Small plots for the article, on a canvas: axes with units, lines, dots, and the place under a pointer.
import { show, styleColor } from "../element";

export interface Axis {
  low: number;
  high: number;
  label: string;
}

const [LEFT, BOTTOM, TOP, RIGHT] = [46, 34, 10, 10]; // pixels around the plot
const GAP = 9; // pixels between the numbers and the axis, on which a dot may lie
const NAME = 12; // pixels between the middle of a dot and its name
const SPOT = 8; // radius of a dot with a name [pixel]

export class Chart {
  private readonly ink: CanvasRenderingContext2D;

  constructor(
    readonly canvas: HTMLCanvasElement,
    public x: Axis,
    public y: Axis,
  ) {
    this.ink = canvas.getContext("2d")!;
  }

  /** Clears the plot and draws the axes. */
  begin(): void {
    const { ink, canvas, x, y } = this;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    [canvas.width, canvas.height] = [canvas.clientWidth * ratio, canvas.clientHeight * ratio];
    ink.setTransform(ratio, 0, 0, ratio, 0, 0);
    ink.font = "12px system-ui, sans-serif";
    const [quiet, rule] = [styleColor("--quiet"), styleColor("--rule")];
    const zero = Math.min(Math.max(0, y.low), y.high);
    this.line([[x.low, zero], [x.high, zero]], rule, 1);
    this.line([[x.low, y.low], [x.low, y.high]], rule, 1);
    ink.fillStyle = quiet;
    const write = (text: string, px: number, py: number, align: CanvasTextAlign) => {
      ink.textAlign = align;
      ink.fillText(text, px, py);
    };
    const { clientWidth: width, clientHeight: height } = canvas;
    for (const value of y.label ? new Set([y.low, zero, y.high]) : []) write(show(value), LEFT - GAP, this.py(value) + 4, "right");
    write(show(x.low), LEFT, height - BOTTOM + 15, "left");
    write(show(x.high), width - RIGHT, height - BOTTOM + 15, "right");
    write(x.label, (LEFT + width - RIGHT) / 2, height - 5, "center");
    ink.save();
    ink.translate(11, (TOP + height - BOTTOM) / 2);
    ink.rotate(-Math.PI / 2);
    write(y.label, 0, 0, "center");
    ink.restore();
  }

  line(points: [number, number][], color: string, width = 2, dash: number[] = []): void {
    const { ink } = this;
    ink.beginPath();
    for (const [x, y] of points) ink.lineTo(this.px(x), this.py(y));
    [ink.strokeStyle, ink.lineWidth] = [color, width];
    ink.setLineDash(dash);
    ink.stroke();
    ink.setLineDash([]);
  }

  dot(x: number, y: number, color: string, radius = 4): void {
    this.ink.beginPath();
    this.ink.arc(this.px(x), this.py(y), radius, 0, 2 * Math.PI);
    this.ink.fillStyle = color;
    this.ink.fill();
  }

  box(x0: number, y0: number, x1: number, y1: number, color: string): void {
    const [left, top] = [Math.floor(this.px(x0)), Math.floor(this.py(y1))]; // whole pixels, so that no gaps are visible
    this.ink.fillStyle = color;
    this.ink.fillRect(left, top, Math.ceil(this.px(x1)) - left, Math.ceil(this.py(y0)) - top);
  }

  text(words: string, x: number, y: number, color: string, align: CanvasTextAlign = "left"): void {
    this.ink.fillStyle = color;
    this.ink.textAlign = align;
    this.ink.fillText(words, this.px(x), this.py(y));
  }

  /** Draws a dot with its name on one side, or on the other if there is no room. Both stay within the axes. */
  named(words: string, x: number, y: number, color: string, side: "left" | "right"): void {
    const { ink } = this;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const px = Math.min(Math.max(this.px(x), LEFT + SPOT), width - RIGHT - SPOT);
    const py = Math.min(Math.max(this.py(y), TOP + SPOT), height - BOTTOM - SPOT);
    for (const [radius, fill] of [[SPOT, "#ffffff"], [SPOT - 2, color]] as const) {
      ink.beginPath();
      ink.arc(px, py, radius, 0, 2 * Math.PI);
      ink.fillStyle = fill;
      ink.fill();
    }
    const room = ink.measureText(words).width + NAME;
    const left = side === "left" ? px - room > LEFT : px + room > width - RIGHT;
    ink.textAlign = left ? "right" : "left";
    const at = [px + (left ? -NAME : NAME), py + 4] as const;
    [ink.strokeStyle, ink.lineWidth, ink.lineJoin] = ["#14171c", 3, "round"]; // so that it is legible on any color
    ink.strokeText(words, ...at);
    ink.fillStyle = "#ffffff";
    ink.fillText(words, ...at);
  }

  /** The coordinates of an event, limited to the axes. */
  place(event: MouseEvent): [number, number] {
    const box = this.canvas.getBoundingClientRect();
    const { x, y } = this;
    const across = (event.clientX - box.left - LEFT) / (box.width - LEFT - RIGHT);
    const up = 1 - (event.clientY - box.top - TOP) / (box.height - TOP - BOTTOM);
    return [within(x.low + across * (x.high - x.low), x), within(y.low + up * (y.high - y.low), y)];
  }

  private px(x: number): number {
    return LEFT + ((x - this.x.low) / (this.x.high - this.x.low)) * (this.canvas.clientWidth - LEFT - RIGHT);
  }

  private py(y: number): number {
    return TOP + (1 - (y - this.y.low) / (this.y.high - this.y.low)) * (this.canvas.clientHeight - TOP - BOTTOM);
  }
}

const within = (value: number, { low, high }: Axis) => Math.min(Math.max(value, low), high);
