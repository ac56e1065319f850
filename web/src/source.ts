// The interface shared by everything that the page can show: records and live worlds.
import type { Bites } from "./bites";
import type { Lives } from "./lives";
import type { Series } from "./series";
import type { Frame, Layout, AgentProbe, Place } from "./types";
import type { Earned } from "./windows";

/** A source of moments: records, or a world that runs. */
export interface Source {
  readonly layout: Layout;
  readonly title: string; // for the names of its files
  readonly seed: number;
  readonly seeds: number[]; // of all worlds in its run
  readonly runs: { run: string; seeds: number[] }[]; // further runs, whose curves are added to the plots
  readonly others: readonly { run: string; seed: number; series: Series }[]; // other worlds, as far as they have been read; of this run if `run` is ""
  readonly live: boolean;
  readonly obstacles: Place[][]; // their corners
  readonly first: number;
  readonly last: number;
  readonly spacing: number; // steps between two moments; 0 if there are none
  readonly ended: boolean; // whether no moment will follow the last one
  readonly lives: Lives;
  readonly series: Series;
  readonly loaded: boolean; // whether all lives recorded so far are known
  readonly relawed: number; // the step after which genes follow another law than in the layout; Infinity if there is none
  /** Reads the series of the run's other seeds, and of further runs. */
  readOthers(): void;
  /** The moments at or before `step` and after it, as far as they are known; requests missing ones. */
  around(step: number): { before?: Frame; after?: Frame };
  /** Passes the moments after a step to `take`, in order, until it returns false. A run reads all its parts for this. */
  moments(after: number, take: (frame: Frame) => boolean): Promise<void>;
  readonly bites: Bites | undefined; // places of meals; records do not have them
  agentProbe(): AgentProbe | undefined;
  /** The reward of an agent in each window of its life; undefined if it is not known. */
  earned(id: number): Earned[] | undefined;
  status(): string;
  /** The world's digest, or "" if it is not known. */
  digest(): string;
}
