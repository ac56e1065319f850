// A scene of the article: its section, its stage, and how it opens at a place.
import type { LiveWorld } from "../types";
import type { Numbers } from "./handout";
import type { Place } from "./link";
import type { Stage } from "./stage";

export type Worlds = Record<string, LiveWorld>;

export interface Scene {
  section: HTMLElement;
  stage?: Stage;
  /** Shows the place of a link. By default the page begins the world and runs it to the step. */
  open?: (place: Place) => Promise<unknown>;
  /** What happened in its world, for the handout. */
  numbers?: () => Numbers;
}

/**
 * Begins the world of a link and runs it to its step; `begun` is called between the two, to show what the link changes.
 * A link with an invalid value changes nothing. Resolves to false if another world has begun in the meantime.
 */
export async function openStage(stage: Stage, place: Place, begun: () => void = () => {}): Promise<boolean> {
  for (const [path, value] of place.changes) {
    const wrong = stage.refuses(path, value);
    if (wrong) throw new Error(wrong);
  }
  stage.changes.clear();
  for (const [path, value] of place.changes) stage.set([path], value);
  stage.begin(place.seed ?? stage.first);
  begun();
  const { live } = stage;
  await stage.runTo(place.step, place.digest);
  return live === stage.live;
}
