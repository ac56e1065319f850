// What the noses of an agent smell, computed from positions.
import { bodyOf } from "./body";
import type { Source } from "./source";
import type { Frame, Place } from "./types";

/** The positions of the noses of agent `i` of a frame: one ahead, or two, with the right one first. */
export function noses(source: Source, frame: Frame, i: number): Place[] {
  const species = bodyOf(source, frame, i);
  const turns = species.noses.count === 1 ? [0] : [-species.noses.degrees, species.noses.degrees];
  return turns.map((turn) => {
    const angle = frame.angle[i]! + (turn * Math.PI) / 180;
    return [frame.x[i]! - species.radius * Math.sin(angle), frame.y[i]! + species.radius * Math.cos(angle)];
  });
}

/** The intensity at each nose of agent `i` in each of its channels: the sum over all sources, at most 1. */
export function smell(source: Source, frame: Frame, i: number): number[][] {
  const { layout } = source;
  const species = bodyOf(source, frame, i);
  return noses(source, frame, i).map(([x, y]) => {
    const sums = new Array<number>(species.smells.length).fill(0);
    const add = (type: number, sx: number, sy: number) => {
      const channel = species.smells.indexOf(type);
      if (channel >= 0) sums[channel]! += Math.exp(-species.noses.decay * Math.hypot(sx - x, sy - y));
    };
    for (let j = 0; j < frame.id.length; j++) if (j !== i) add(frame.species[j]!, frame.x[j]!, frame.y[j]!);
    for (let f = 0; f < frame.foodX.length; f++) add(layout.species.length + frame.foodKind[f]!, frame.foodX[f]!, frame.foodY[f]!);
    return sums.map((sum) => Math.min(sum, 1));
  });
}
