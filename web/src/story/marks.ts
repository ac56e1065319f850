// Rings where creatures died, and lines between newborns and their parents, drawn above an arena.
import { styleColor } from "../element";
import type { Moment } from "../live.worker";
import type { Life, Place } from "../types";
import type { Stage } from "./stage";

const FADE = 300; // steps until a mark has faded

/** The recent deaths and births, for as long as their marks are visible. */
export class Marks {
  readonly deaths: { step: number; place: Place; color: string }[] = [];
  readonly births: { step: number; child: number; parent: number }[] = [];
  private places = new Map<number, Place>(); // of living creatures, at the last moment

  constructor(
    private readonly stage: Stage,
    private readonly color: (life: Life) => string,
  ) {}

  clear(): void {
    this.deaths.length = this.births.length = 0;
    this.places.clear();
  }

  note({ frame, dead, lives }: Moment): void {
    for (const life of dead) {
      const place = this.places.get(life.id);
      if (place) this.deaths.push({ step: life.death, place, color: this.color(life) });
    }
    for (const { id, parent, birth: step } of lives) if (parent >= 0 && !this.places.has(id)) this.births.push({ step, child: id, parent });
    this.places = new Map(Array.from(frame.id, (id, i) => [id, [frame.x[i]!, frame.y[i]!]]));
    for (const list of [this.deaths, this.births]) while (list.length > 0 && list[0]!.step < frame.step - FADE) list.shift();
  }

  draw(): void {
    const { stage, places } = this;
    const { ink, arena, frame, live } = stage;
    if (!frame) return;
    const age = (step: number) => Math.min(Math.max(frame.step - step, 0) / FADE, 1);
    const radius = live.layout.species[0]!.radius * arena.scene.zoom * (ink.canvas.clientWidth / arena.scene.canvas.width);
    for (const { step, place, color } of this.deaths) {
      ink.globalAlpha = 1 - age(step);
      [ink.strokeStyle, ink.lineWidth] = [color, 3];
      ink.beginPath();
      ink.arc(...stage.at(...place), radius * (1 + age(step)), 0, 2 * Math.PI);
      ink.stroke();
    }
    for (const { step, child, parent } of this.births) {
      const [from, to] = [places.get(parent), places.get(child)];
      if (!from || !to) continue;
      ink.globalAlpha = 1 - age(step);
      [ink.strokeStyle, ink.lineWidth] = [styleColor("--birth"), 3];
      ink.beginPath();
      ink.moveTo(...stage.at(...from));
      ink.lineTo(...stage.at(...to));
      ink.stroke();
    }
    ink.globalAlpha = 1;
  }
}
