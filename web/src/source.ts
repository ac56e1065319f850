// What the page shows: records, or a live world.
import type { Lives } from "./lives";
import type { Series } from "./series";
import type { Frame, Layout, AgentProbe, Place } from "./types";

/** Where moments come from: records, or a world that runs. */
export interface Source {
  readonly layout: Layout;
  readonly live: boolean;
  readonly obstacles: Place[][]; // their corners
  readonly first: number;
  readonly last: number;
  readonly lives: Lives;
  readonly series: Series;
  /** The moments at or before `step` and after it, where they are known; asks for what is not. */
  around(step: number): { before?: Frame; after?: Frame };
  agentProbe(): AgentProbe | undefined;
  status(): string;
  /** The world's digest, or "" where it is not known. */
  digest(): string;
}
