// The help: keys, how to reproduce the world elsewhere, and how rounding affects that.
import { by, counted, element, show, table } from "./element";
import { Live } from "./live";
import { command } from "./settings";
import type { Source } from "./source";

const KEYS: [string, string][] = [
  ["Space", "plays and pauses"],
  ["← →", "one step back or forward; with Shift, ten steps"],
  ["Home End", "the first and the last step"],
  ["+ −", "faster and slower"],
  ["N", "chooses the next agent, Esc none"],
  ["F R T", "follow the chosen agent, show its rays, its trail"],
  ["0 X", "the whole arena, the full screen"],
  ["A L P S W", "the panels: agent, list of agents, plots, settings, world"],
  ["?", "this help"],
];

const PLOTS: [string, string][] = [
  ["Move over a plot", "shows the values at a step, in all plots"],
  ["Click", "goes to the step"],
  ["Drag", "zooms in time, in all plots; a double click shows all steps again"],
  ["← → Home End", "on a focused plot: the values of another row; Enter goes to its step"],
  ["+ −", "on a focused plot: zoom in and out"],
];

const TOUCH = "Click or tap an agent to choose it. Drag to move; turn the wheel or pinch to zoom.";
const PICKING = "Agents that match the filter in Agents, or are inside a rectangle dragged in the scatter plot of Plots, have rings in the arena. The map of positions or meals shades the arena by how often agents were, or ate, there.";

export function showHelp(source: Source): void {
  const box = by<HTMLDialogElement>("help");
  const close = element("button", { text: "Close" });
  close.onclick = () => box.close();
  const heading = element("h2", { text: "Help" });
  heading.id = "help-title";
  const keys = table(KEYS);
  box.replaceChildren(heading, element("p", { text: TOUCH }), element("p", { text: PICKING }), element("h3", { text: "Keys" }), keys, element("h3", { text: "Plots" }), table(PLOTS), ...thisWorld(source), close);
  box.showModal();
}

function thisWorld(source: Source): HTMLElement[] {
  const lines: HTMLElement[] = [element("h3", { text: "This world" })];
  if (source instanceof Live) {
    const same = command(source.world, source.changes, source.seed, source.last);
    const later = source.acts.map(({ step, path, value }) => element("p", { text: `At step ${show(step)}: ${path} = ${value}` }));
    const intro = source.edited ? "It was changed by hand, so no command reproduces it. It began as" : "This command reproduces the world, with the same digest:";
    const rounding = source.fused
      ? "The engine here fuses multiply-adds, as processors with AVX2 and AVX-512 do: digests are those of the command there."
      : "This browser does not fuse multiply-adds: put HEDON_BACKEND=portable before the command to get the digest of this page.";
    lines.push(element("p", { text: intro }), element("code", { text: same }), ...later, element("p", { text: `${rounding} It runs in ${counted(source.threads, "thread")}, which changes no result.` }));
  }
  if (source.digest()) lines.push(element("p", { text: `Digest of the state: ${source.digest()}` }));
  return lines;
}
