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
  const said = new URLSearchParams(text);
  const pairs = said.getAll("set").filter((each) => each.indexOf("=") > 0);
  const view = said.get("view")?.split(",").map(Number);
  return {
    live: said.get("live") ?? undefined,
    run: whole(said.get("world")),
    seed: whole(said.get("seed")),
    threads: whole(said.get("threads")),
    step: whole(said.get("step")),
    agent: whole(said.get("agent")),
    color: said.get("color") ?? undefined,
    filter: said.get("filter") ?? undefined,
    view: view?.length === 3 && view.every(Number.isFinite) && view[2]! > 0 ? (view as View) : undefined,
    changes: new Map(pairs.map((each) => [each.slice(0, each.indexOf("=")), each.slice(each.indexOf("=") + 1)])),
  };
}

export function writeLink(link: Link): string {
  const said = new URLSearchParams();
  const { changes, view, run, ...rest } = link;
  if (run !== undefined) said.set("world", String(run));
  for (const [name, value] of Object.entries(rest)) if (value !== undefined) said.set(name, String(value));
  for (const [path, value] of changes) said.append("set", `${path}=${value}`);
  if (view) said.set("view", view.map((each) => Number(each.toPrecision(5))).join());
  return said.toString();
}
