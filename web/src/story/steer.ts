// How the reader steers: keys, or a place to go to, become one of a few commands, and a record of them fits into a link.
import type { Actions } from "../live.worker";

const FULL = 6; // before the sigmoid: 0.998 of the maximum force
const MOST = 2000; // the most runs of one command that fit into a link

/** The commands, with the direction of the left and the right motor: 1 (ahead), 0 or -1 (back). */
const MOTORS: Record<string, [number, number]> = { ".": [0, 0], f: [1, 1], b: [-1, -1], l: [-1, 1], r: [1, -1], q: [0, 1], e: [1, 0] };

/** The actions of each command for motors with these limits; at rest no force acts. */
export function commandsOf(least: number, most: number): Record<string, Actions> {
  const rest = Math.log(-least / most); // sigmoid(rest) = -least / (most - least)
  const action = (way: number) => (way > 0 ? FULL : way < 0 ? -FULL : rest);
  return Object.fromEntries(Object.entries(MOTORS).map(([name, [left, right]]) => [name, [action(left), action(right)]]));
}

/** The command for the keys held down. */
export function ofKeys(keys: Set<string>): string {
  const [up, down, left, right] = ["ArrowUp", "ArrowDown", "ArrowLeft", "ArrowRight"].map((key) => keys.has(key));
  if (left === right) return up === down ? "." : up ? "f" : "b";
  if (up) return left ? "q" : "e";
  return left ? "l" : "r";
}

/** The command that moves an agent toward a place: turn until the place is ahead, then go. Heading 0 is up; positive is left. */
export function toward(x: number, y: number, heading: number, goal: [number, number]): string {
  const [dx, dy] = [goal[0] - x, goal[1] - y];
  const off = Math.atan2(-dx, dy) - heading;
  const turn = Math.atan2(Math.sin(off), Math.cos(off));
  if (Math.abs(turn) < 0.15) return "f";
  if (Math.abs(turn) < 0.7) return turn > 0 ? "q" : "e";
  return turn > 0 ? "l" : "r";
}

/** A sequence of commands with the number of steps of each, as in "f40l3f12". */
export class Track {
  readonly runs: [string, number][] = [];

  add(command: string, steps: number): void {
    const last = this.runs[this.runs.length - 1];
    if (last && last[0] === command) last[1] += steps;
    else if (steps > 0) this.runs.push([command, steps]);
  }

  /** Whether the track is short enough for a link. */
  get fits(): boolean {
    return this.runs.length <= MOST;
  }

  toString(): string {
    return this.runs.map(([command, steps]) => command + steps).join("");
  }

  static of(text: string): Track {
    const track = new Track();
    for (const [, command, steps] of text.matchAll(/([.fblrqe])(\d{1,7})/g)) track.add(command!, Number(steps));
    return track;
  }
}
