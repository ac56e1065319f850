// What the page shows: records, or a live world.
import type { Bites } from "./bites";
import type { Lives } from "./lives";
import type { Series } from "./series";
import type { Frame, Layout, AgentProbe, Place } from "./types";
import type { Earned } from "./windows";

/** Where moments come from: records, or a world that runs. */
export interface Source {
  readonly layout: Layout;
  readonly title: string; // of its files
  readonly seed: number;
  readonly seeds: number[]; // of all worlds of its run
  readonly others: readonly { seed: number; series: Series }[]; // of the run, as far as they are read
  readonly live: boolean;
  readonly obstacles: Place[][]; // their corners
  readonly first: number;
  readonly last: number;
  readonly spacing: number; // steps between two moments; 0 where it has none
  readonly ended: boolean; // whether no moment comes after the last one
  readonly lives: Lives;
  readonly series: Series;
  readonly loaded: boolean; // whether all lives that are recorded so far are known
  readonly relawed: number; // the step from which on genes mutate by another law than the layout says; Infinity if they never do
  /** Reads the numbers of the run's other seeds. */
  readOthers(): void;
  /** The moments at or before `step` and after it, where they are known; requests the others. */
  around(step: number): { before?: Frame; after?: Frame };
  /** Shows the known moments after a step, in their order, until `take` returns false. A run reads all its parts for this. */
  moments(after: number, take: (frame: Frame) => boolean): Promise<void>;
  readonly bites: Bites | undefined; // where meals were eaten; records do not have it
  agentProbe(): AgentProbe | undefined;
  /** What an agent earned in each window of its life; undefined where nobody knows. */
  earned(id: number): Earned[] | undefined;
  status(): string;
  /** The world's digest, or "" where it is not known. */
  digest(): string;
}
