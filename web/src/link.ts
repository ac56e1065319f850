// The link of the page, which leads another person to the same moment of the same world.
import type { View } from "./arena";

export interface Link {
  live?: string; // the source of a live world
  run?: number; // or a world of the run
  seed?: number;
  threads?: number;
  step?: number;
  agent?: number;
  color?: string;
  filter?: string; // of the Agents panel
  view?: View;
  changes: Map<string, string>; // of settings, by path
}

function whole(text: string | null): number | undefined {
  return text !== null && /^\d{1,15}$/.test(text) ? Number(text) : undefined;
}

export function readLink(text: string): Link {
  const params = new URLSearchParams(text);
  const pairs = params.getAll("set").filter((each) => each.indexOf("=") > 0);
  const view = params.get("view")?.split(",").map(Number);
  return {
    live: params.get("live") ?? undefined,
    run: whole(params.get("world")),
    seed: whole(params.get("seed")),
    threads: whole(params.get("threads")),
    step: whole(params.get("step")),
    agent: whole(params.get("agent")),
    color: params.get("color") ?? undefined,
    filter: params.get("filter") ?? undefined,
    view: view?.length === 3 && view.every(Number.isFinite) && view[2]! > 0 ? (view as View) : undefined,
    changes: new Map(pairs.map((each) => [each.slice(0, each.indexOf("=")), each.slice(each.indexOf("=") + 1)])),
  };
}

export function writeLink(link: Link): string {
  const params = new URLSearchParams();
  const { changes, view, run, ...rest } = link;
  if (run !== undefined) params.set("world", String(run));
  for (const [name, value] of Object.entries(rest)) if (value !== undefined) params.set(name, String(value));
  for (const [path, value] of changes) params.append("set", `${path}=${value}`);
  if (view) params.set("view", view.map((each) => Number(each.toPrecision(5))).join());
  return params.toString();
}
