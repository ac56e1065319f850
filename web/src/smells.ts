// What the noses of an agent smell, computed from positions.
import { bodyOf } from "./body";
import type { Source } from "./source";
import type { Frame, Place } from "./types";

/** The positions of the noses of agent `i` of a frame: one ahead, or two, with the right one first. */
export function noses(source: Source, frame: Frame, i: number): Place[] {
  const own = bodyOf(source, frame, i);
  const turns = own.noses.count === 1 ? [0] : [-own.noses.degrees, own.noses.degrees];
  return turns.map((turn) => {
    const angle = frame.angle[i]! + (turn * Math.PI) / 180;
    return [frame.x[i]! - own.radius * Math.sin(angle), frame.y[i]! + own.radius * Math.cos(angle)];
  });
}

/** The intensity at each nose of agent `i` in each of its channels: the sum over all sources, at most 1. */
export function smell(source: Source, frame: Frame, i: number): number[][] {
  const { layout } = source;
  const own = bodyOf(source, frame, i);
  return noses(source, frame, i).map(([x, y]) => {
    const sums = new Array<number>(own.smells.length).fill(0);
    const add = (type: number, sx: number, sy: number) => {
      const channel = own.smells.indexOf(type);
      if (channel >= 0) sums[channel]! += Math.exp(-own.noses.decay * Math.hypot(sx - x, sy - y));
    };
    for (let j = 0; j < frame.id.length; j++) if (j !== i) add(frame.species[j]!, frame.x[j]!, frame.y[j]!);
    for (let f = 0; f < frame.foodX.length; f++) add(layout.species.length + frame.foodKind[f]!, frame.foodX[f]!, frame.foodY[f]!);
    return sums.map((sum) => Math.min(sum, 1));
  });
}
