// What the rays of an agent hit at a recorded moment, computed from positions.
import { bodyOf } from "./body";
import type { Source } from "./source";
import type { Frame } from "./types";

export interface Ray {
  x0: number;
  y0: number;
  x1: number;
  y1: number;
  type: number; // index into the layout's types; -1 if it hits nothing
  share: number; // distance of the hit, relative to the ray's length
}

/** Distance along a ray from (ox, oy) in direction (dx, dy) to a disc, or Infinity. */
function toDisc(ox: number, oy: number, dx: number, dy: number, x: number, y: number, radius: number): number {
  const [px, py] = [x - ox, y - oy];
  const along = px * dx + py * dy;
  const rest = radius * radius - (px * px + py * py - along * along);
  if (rest < 0) return Infinity;
  const root = Math.sqrt(rest);
  if (along + root < 0) return Infinity;
  return Math.max(along - root, 0);
}

function toWall(ox: number, oy: number, dx: number, dy: number, [ax, ay, bx, by]: number[]): number {
  const [ex, ey] = [bx! - ax!, by! - ay!];
  const cross = dx * ey - dy * ex;
  if (Math.abs(cross) < 1e-12) return Infinity;
  const [px, py] = [ax! - ox, ay! - oy];
  const along = (px * ey - py * ex) / cross;
  const share = (px * dy - py * dx) / cross;
  return along >= 0 && share >= 0 && share <= 1 ? along : Infinity;
}

/** Casts the rays of agent `i` of a frame, from right to left. Heading 0 is up; positive is counterclockwise. */
export function castRays(source: Source, frame: Frame, i: number): Ray[] {
  const { layout, obstacles } = source;
  const species = bodyOf(source, frame, i);
  const { count, spread_degrees: spread, length } = species.rays;
  const body = species.radius;
  const [x, y] = [frame.x[i]!, frame.y[i]!];
  const foodType = layout.species.length;
  const wall = foodType + layout.foods.length; // obstacles follow it
  const sides = obstacles.flatMap((corners) => corners.map((corner, c) => [...corner, ...corners[(c + 1) % corners.length]!]));
  const reach = body + length;
  const rays: Ray[] = [];
  for (let r = 0; r < count; r++) {
    const turn = count === 1 ? 0 : -spread + (2 * spread * r) / (count - 1);
    const angle = frame.angle[i]! + (turn * Math.PI) / 180;
    const [dx, dy] = [-Math.sin(angle), Math.cos(angle)];
    let [best, type] = [reach, -1];
    const consider = (at: number, hit: number) => {
      if (at < best && at >= 0) [best, type] = [Math.max(at, body), hit];
    };
    for (let j = 0; j < frame.id.length; j++) {
      const other = frame.species[j]!;
      if (j === i || !species.sees.includes(other)) continue;
      const { radius } = bodyOf(source, frame, j);
      if (Math.abs(frame.x[j]! - x) > reach + radius || Math.abs(frame.y[j]! - y) > reach + radius) continue;
      consider(toDisc(x, y, dx, dy, frame.x[j]!, frame.y[j]!, radius), other);
    }
    for (let f = 0; f < frame.foodX.length; f++) {
      const kind = frame.foodKind[f]!;
      if (!species.sees.includes(foodType + kind)) continue;
      consider(toDisc(x, y, dx, dy, frame.foodX[f]!, frame.foodY[f]!, layout.foods[kind]!.radius), foodType + kind);
    }
    for (const segment of layout.arena.walls) consider(toWall(x, y, dx, dy, segment), wall);
    for (const side of species.sees.includes(wall + 1) ? sides : []) consider(toWall(x, y, dx, dy, side), wall + 1);
    rays.push({ x0: x + body * dx, y0: y + body * dy, x1: x + best * dx, y1: y + best * dy, type, share: (best - body) / length });
  }
  return rays;
}
