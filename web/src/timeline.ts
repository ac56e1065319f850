// The time line: population over time, births and deaths, events, and a mark at the moment shown.
import { drift } from "./drift";
import { show, styleColor } from "./element";
import { columnOf } from "./series";
import type { Source } from "./source";
import type { Event } from "./types";

const PAD = 6;

/** The events that get a mark, derived from the series. */
export function events(source: Source): Event[] {
  const { step } = source.series;
  const [alive, generation] = [source.series.get("alive"), source.series.get("generation_max")];
  const marks: Event[] = [];
  let next = 10;
  let most = 0;
  for (let i = 0; i < step.length; i++) {
    if (alive[i] === 0 && (i === 0 || alive[i - 1]! > 0)) marks.push({ step: step[i]!, text: "died out" });
    if (generation[i]! >= next) {
      marks.push({ step: step[i]!, text: `first agent of generation ${next}` });
      while (next <= generation[i]!) next = next < 100 ? next + 10 : next + 100;
    }
    most = Math.max(most, alive[i]!);
  }
  const peak = alive.indexOf(most);
  if (peak > 0) marks.push({ step: step[peak]!, text: `most agents alive: ${most}` });
  const least = alive.reduce((a, b) => Math.min(a, b), Infinity);
  const trough = alive.indexOf(least);
  if (least > 0 && trough > 0 && trough < step.length - 1) marks.push({ step: step[trough]!, text: `fewest agents alive: ${least}` });
  return [...marks, ...departures(source)];
}

/** The step from which each reward weight is outside its drift band, if it still is at the end. */
function departures(source: Source): Event[] {
  const { layout, series } = source;
  const marks: Event[] = [];
  for (const species of layout.species) {
    const owner = layout.species.length > 1 ? `${species.name}: ` : "";
    species.genes.forEach((g, i) => {
      const gene = layout.genes[g]!;
      const band = gene.role === "reward" ? drift(source, species, i) : "";
      if (typeof band === "string") return;
      const means = series.get(columnOf(layout, species, `${gene.name}_mean`));
      const inside = series.step.findLastIndex((_, at) => band.low[at] == null || !(means[at]! < band.low[at]! || means[at]! > band.high[at]!));
      const step = series.step[inside + 1];
      if (step !== undefined) marks.push({ step, text: `${owner}${gene.title}: outside drift from here on` });
    });
  }
  return marks;
}

export class Timeline {
  constructor(
    private readonly canvas: HTMLCanvasElement,
    seek: (step: number) => void,
    private readonly range: () => [number, number],
  ) {
    const go = (event: PointerEvent) => {
      const box = canvas.getBoundingClientRect();
      const share = (event.clientX - box.left - PAD) / (box.width - 2 * PAD);
      const [first, last] = range();
      seek(first + Math.min(Math.max(share, 0), 1) * (last - first));
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      go(event);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons & 1) go(event);
    });
  }

  draw(source: Source, now: number, marks: Event[]): void {
    const { canvas } = this;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
    if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
    const pen = canvas.getContext("2d")!;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    const [first, last] = this.range();
    const toX = (step: number) => PAD + ((step - first) / Math.max(last - first, 1)) * (width - 2 * PAD);
    this.curve(pen, source, toX, height);
    pen.fillStyle = styleColor("--mark");
    for (const mark of marks) {
      pen.beginPath();
      pen.moveTo(toX(mark.step), 8);
      pen.lineTo(toX(mark.step) - 4, 1);
      pen.lineTo(toX(mark.step) + 4, 1);
      pen.fill();
    }
    pen.fillRect(toX(now) - 1, 0, 2, height);
    canvas.title = marks.map((mark) => `step ${show(mark.step)}: ${mark.text}`).join("\n");
    canvas.setAttribute("aria-valuemin", String(Math.round(first)));
    canvas.setAttribute("aria-valuemax", String(Math.round(last)));
    canvas.setAttribute("aria-valuenow", String(Math.round(now)));
  }

  private curve(pen: CanvasRenderingContext2D, source: Source, toX: (step: number) => number, height: number): void {
    const { step } = source.series;
    const [alive, births, deaths] = ["alive", "births", "deaths"].map((name) => source.series.get(name));
    const most = alive!.reduce((a, b) => Math.max(a, b), 1);
    const busiest = births!.reduce((a, b, i) => Math.max(a, b, deaths![i]!), 1);
    pen.fillStyle = styleColor("--curve");
    pen.beginPath();
    pen.moveTo(toX(step[0] ?? 0), height);
    step.forEach((each, i) => pen.lineTo(toX(each), height - (alive![i]! / most) * (height - 12)));
    pen.lineTo(toX(step[step.length - 1] ?? 0), height);
    pen.fill();
    for (const [values, color] of [[births!, "--birth"], [deaths!, "--death"]] as const) {
      pen.strokeStyle = styleColor(color);
      pen.beginPath();
      step.forEach((each, i) => pen.lineTo(toX(each), height - (values[i]! / busiest) * (height - 12) * 0.6));
      pen.stroke();
    }
  }
}
