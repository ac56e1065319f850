// A second world next to the first, in step with it: the same config and seed, with one setting changed.
import { Arena } from "./arena";
import { type Coloring, colorings, type Painted } from "./color";
import { by, show } from "./element";
import { Live } from "./live";
import type { Setting } from "./types";

export class Twin {
  live: Live | undefined;
  private arena: Arena | undefined;
  private setting: Setting | undefined;
  private value = "";
  private colors: Coloring[] = [];

  /** Starts the second world; the first must be at its beginning. */
  open(first: Live, setting: Setting, value: string): void {
    this.close();
    this.live = new Live(first.world, new Map([...first.changes, [setting.path, value]]), first.seed, first.wanted);
    [this.setting, this.value, this.colors] = [setting, value, colorings(this.live)];
    by("view").classList.add("two");
    for (const id of ["scene-twin", "caption", "caption-twin"]) by(id).hidden = false;
    this.arena ??= new Arena(by<HTMLCanvasElement>("scene-twin"));
  }

  close(): void {
    this.live?.close();
    this.live = undefined;
    by("view").classList.remove("two");
    for (const id of ["scene-twin", "caption", "caption-twin"]) by(id).hidden = true;
  }

  /** Draws the second world with the view and the color scale of the first. */
  draw(first: Arena, now: number, coloring: Coloring, legend: Painted["legend"] | undefined): void {
    const { live, arena } = this;
    if (!live || !arena) return;
    const matching = this.colors.find((each) => each.name === coloring.name) ?? coloring;
    arena.draw(live, live.around(now).before, { ...matching, low: legend?.low, high: legend?.high }, -1);
    [arena.scene.centerX, arena.scene.centerY, arena.scene.zoom] = [first.scene.centerX, first.scene.centerY, first.scene.zoom];
  }

  caption(first: Live, now: number): void {
    if (!this.live || !this.setting) return;
    const { path, value } = this.setting;
    by("caption").textContent = summary(first, path, first.changes.get(path) ?? String(value), now);
    by("caption-twin").textContent = summary(this.live, path, this.value, now);
  }
}

function summary(live: Live, path: string, value: string, now: number): string {
  const frame = live.around(now).before;
  if (!frame) return live.status();
  const energy = frame.energy.reduce((sum, each) => sum + each, 0) / frame.id.length;
  return `${path} = ${value}: ${show(frame.id.length)} agents, mean energy ${show(energy, 1)}`;
}
