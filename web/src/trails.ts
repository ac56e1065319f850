// The trails of agents: the last places of each followed agent, drawn as lines that fade.
import { pack, parse } from "./color";
import { styleColor } from "./element";
import type { Scene } from "./scene";
import type { Frame } from "./types";

const LENGTH = 240; // places kept per agent

type Spot = [step: number, x: number, y: number];

export class Trails {
  private places = new Map<number, Spot[]>(); // by agent

  forget(): void {
    this.places.clear();
  }

  /** Adds the positions of the agents at these indices of a frame, and forgets all other agents. */
  note(frame: Frame, followed: number[]): void {
    const kept = new Map<number, Spot[]>();
    for (const i of followed) {
      let spots = this.places.get(frame.id[i]!) ?? [];
      const last = spots[spots.length - 1];
      if (last && last[0] > frame.step) spots = [];
      if (!last || last[0] !== frame.step) spots.push([frame.step, frame.x[i]!, frame.y[i]!]);
      if (spots.length > LENGTH) spots.shift();
      kept.set(frame.id[i]!, spots);
    }
    this.places = kept;
  }

  /** Draws the trail of an agent in a color of the page's style. */
  draw(scene: Scene, id: number, color: string): void {
    const spots = this.places.get(id) ?? [];
    const [r, g, b] = parse(styleColor(color));
    for (let i = 1; i < spots.length; i++) {
      const [[, ax, ay], [, bx, by]] = [spots[i - 1]!, spots[i]!];
      scene.line(ax, ay, bx, by, pack([r, g, b], Math.round((180 * i) / spots.length)));
    }
  }
}
