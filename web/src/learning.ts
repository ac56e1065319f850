// Whether an agent learns: its reward in each window of its life, as bars and as a sentence.
import { element, picture, show, styleColor, surface } from "./element";
import type { Earned } from "./windows";

const HEIGHT = 96;
const MOST = 60; // the last windows are drawn
const LEAST = 4; // windows needed for a comparison

/** The reward per step in each window, over the part in which the agent lived. */
const rates = (windows: Earned[]): number[] => windows.map(({ from, to, reward }) => reward / Math.max(to - from, 1));

/** A sentence that compares the mean of the later half of the windows with the mean of the first half. */
export function verdict(windows: Earned[], length: number): string {
  if (windows.length < LEAST) return `Fills at the end of each window of ${show(length)} steps; a trend takes ${LEAST} windows, it has lived through ${windows.length}.`;
  const all = rates(windows).map((each) => each * length);
  const half = Math.floor(all.length / 2);
  const mean = (part: number[]) => part.reduce((sum, each) => sum + each, 0) / part.length;
  const [early, late] = [mean(all.slice(0, half)), mean(all.slice(-half))];
  const spread = Math.sqrt(mean(all.map((each) => (each - mean(all)) ** 2)));
  const comparison = Math.abs(late - early) < spread / 2 ? "about as much as" : late > early ? "more than" : "less than";
  return `Later half: ${show(late)} per window, ${comparison} in the first half (${show(early)}).`;
}

export class LearningChart {
  readonly canvas = element("canvas", { class: "small" });
  readonly text = element("p", { class: "quiet" });

  draw(windows: Earned[], length: number): void {
    this.text.textContent = verdict(windows, length);
    this.canvas.hidden = windows.length === 0;
    picture(this.canvas, `Reward in each window. ${this.text.textContent}`);
    if (windows.length === 0) return;
    const pen = surface(this.canvas);
    const shown = rates(windows).slice(-MOST).map((each) => each * length);
    const [low, high] = [Math.min(0, ...shown), Math.max(0, ...shown)];
    const range = high - low || 1;
    const [width, height] = [this.canvas.clientWidth, HEIGHT - 30];
    const y = (value: number) => 14 + ((high - value) / range) * height;
    const step = Math.min(width / shown.length, 28);
    shown.forEach((value, i) => {
      pen.fillStyle = styleColor(value < 0 ? "--low" : "--high");
      pen.fillRect(i * step + 1, Math.min(y(0), y(value)), Math.max(step - 2, 1), Math.max(Math.abs(y(value) - y(0)), 1));
    });
    pen.fillStyle = styleColor("--quiet");
    pen.fillRect(0, y(0), width, 1);
    pen.fillText(`${show(high)} reward`, 2, 11);
    pen.fillText(`step ${show(windows[Math.max(windows.length - MOST, 0)]!.from)} to ${show(windows[windows.length - 1]!.to)}`, 2, HEIGHT - 4);
  }
}
