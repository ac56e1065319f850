// Scene 6: the reader draws how a feeling went; then what was measured, and what chance does to genes that nothing selects.
import { show, styleColor } from "../element";
import { Chart } from "./chart";
import evidence from "./evidence.json";
import { addressOf, copyAddress } from "./link";
import type { Scene } from "./scene";

const { course } = evidence;
const LAST = course.step.length - 1;
const KEPT = 11; // points of a guess in a link
const NUDGE = 0.25; // that a key moves the pen by

export function chance(section: HTMLElement): Scene {
  const chart = new Chart(
    section.querySelector("canvas.chart")!,
    { low: 0, high: course.step[LAST]!, label: "steps" },
    { low: -2, high: 10, label: "mean feeling" },
  );
  const [real, drift] = ["real", "drift"].map((name) => section.querySelector<HTMLButtonElement>(`#chance-${name}`)!) as [HTMLButtonElement, HTMLButtonElement];
  const answer = section.querySelector<HTMLElement>("#chance-answer")!;
  const food = section.querySelector<HTMLInputElement>("#chance-food")!;
  const link = section.querySelector<HTMLAnchorElement>("#chance-link")!;
  let guess: number[] = [];
  let shown = 0; // 1 with the measured course, 2 with what chance does too
  const gene = () => (food.checked ? course.meal : course.moving);
  const measured = () => gene().mean;
  const points = (values: number[]) => values.map((value, i): [number, number] => [course.step[i]!, value]);

  const { canvas } = chart;
  const draw = () => {
    chart.begin();
    if (shown >= 2) chart.area(points(course.chance.low), points(course.chance.high), styleColor("--before"));
    if (shown >= 1) chart.line(points(measured()), styleColor("--mark"), 3);
    if (guess.length > 0) {
      chart.line(points(guess), styleColor("--ink"), 2, [6, 4]);
      chart.dot(course.step[guess.length - 1]!, guess[guess.length - 1]!, styleColor("--ink"));
    } else chart.dot(0, measured()[0]!, styleColor("--mark"), 6);
    const whole = guess.length > LAST;
    canvas.classList.toggle("shown", shown > 0);
    real.disabled = !whole;
    drift.disabled = shown < 1;
    answer.textContent = words(whole);
    const kept = Array.from({ length: KEPT }, (_, i) => guess[Math.round((i * LAST) / (KEPT - 1))]);
    const notes = new Map([["gene", food.checked ? "meal" : "moving"]]);
    if (whole) notes.set("guess", kept.map((value) => show(value, 2).replace("−", "-")).join("_"));
    link.href = addressOf({ scene: "chance", seed: 1, step: 0, digest: "", changes: new Map(), notes });
  };
  const words = (whole: boolean): string => {
    if (!whole) return guess.length > 0 ? "Go on to the right end." : "Draw first.";
    if (shown === 0) return "Now look.";
    const off = guess.reduce((sum, value, i) => sum + Math.abs(value - measured()[i]!), 0) / guess.length;
    const first = `You are off by ${show(off, 1)} on average. It ended at ${show(measured()[LAST], 1)}.`;
    if (shown === 1) return first;
    return `${first} Of 100 genes that do nothing, some ${show(100 * gene().p, 0)} go so far, up or down (p = ${gene().p.toFixed(2)}).`;
  };
  const put = (step: number, level: number) => {
    const value = Math.min(Math.max(level, chart.y.low), chart.y.high);
    const to = Math.round((step / course.step[LAST]!) * LAST);
    const from = Math.min(guess.length, to);
    const begin = guess[from - 1] ?? measured()[0]!;
    for (let i = from; i <= to; i++) guess[i] = begin + ((value - begin) * (i - from + 1)) / (to - from + 1);
    draw();
  };
  /** What is shown stays until Reset: a finger scrolls over it. Of several fingers the first draws. */
  const draws = (event: PointerEvent) => shown === 0 && event.isPrimary && event.buttons === 1;
  canvas.addEventListener("pointerdown", (event) => {
    if (!draws(event)) return;
    canvas.setPointerCapture(event.pointerId);
    const [step] = chart.place(event);
    guess.length = Math.min(guess.length, Math.round((step / course.step[LAST]!) * LAST));
    put(...chart.place(event));
  });
  canvas.addEventListener("pointermove", (event) => draws(event) && put(...chart.place(event)));
  canvas.addEventListener("keydown", (event) => {
    if (shown > 0) return;
    const at = guess.length - 1;
    const value = guess[at] ?? measured()[0]!;
    if (event.key === "ArrowRight" && at < LAST) put(course.step[at + 1]!, value);
    else if (event.key === "ArrowLeft" && guess.length > 0) guess.pop();
    else if (event.key === "ArrowUp" || event.key === "ArrowDown") {
      const next = value + (event.key === "ArrowUp" ? NUDGE : -NUDGE);
      if (at < 0) put(0, next);
      else guess[at] = Math.min(Math.max(next, chart.y.low), chart.y.high);
    } else return;
    event.preventDefault();
    draw();
  });
  const forget = () => {
    [guess, shown] = [[], 0];
    draw();
  };
  real.addEventListener("click", () => ([shown] = [1]) && draw());
  drift.addEventListener("click", () => ([shown] = [2]) && draw());
  section.querySelector("#chance-reset")!.addEventListener("click", forget);
  food.addEventListener("change", forget);
  link.addEventListener("click", (event) => {
    event.preventDefault();
    history.replaceState(null, "", link.href);
    copyAddress(link);
  });
  new ResizeObserver(draw).observe(canvas);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  section.addEventListener("theme", draw);
  return {
    section,
    open: (place) => {
      food.checked = place.notes.get("gene") === "meal";
      forget();
      const kept = place.notes.get("guess")?.split("_") ?? [];
      kept.forEach((value, i) => put((i * course.step[LAST]!) / (KEPT - 1), Number(value)));
      return Promise.resolve();
    },
  };
}
