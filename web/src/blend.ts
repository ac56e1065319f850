// Interpolates between two frames, so that agents move smoothly in a replay.
import type { Frame } from "./types";

/** The moment at `step`. Frames that are far apart are not blended, since agents would float through walls. */
export function blend(before: Frame, after: Frame | undefined, step: number): Frame {
  if (!after || step <= before.step || after.step - before.step > 128) return before;
  const share = (step - before.step) / (after.step - before.step);
  const mixed = { ...before, step, x: before.x.slice(), y: before.y.slice(), angle: before.angle.slice() };
  let j = 0;
  for (let i = 0; i < before.id.length; i++) {
    while (j < after.id.length && after.id[j]! < before.id[i]!) j++;
    if (after.id[j] !== before.id[i]) continue;
    mixed.x[i]! += share * (after.x[j]! - before.x[i]!);
    mixed.y[i]! += share * (after.y[j]! - before.y[i]!);
    const turn = after.angle[j]! - before.angle[i]!;
    mixed.angle[i]! += share * (turn - Math.round(turn / (2 * Math.PI)) * 2 * Math.PI);
  }
  return mixed;
}
