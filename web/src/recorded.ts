// The read-only settings of a recorded run: first those that differ from its preset, then all of them.
import { element } from "./element";
import type { RunIndex } from "./types";

/** Makes the elements of the settings panel for a recorded run. */
export function recordedSettings({ base, changed, all }: RunIndex["settings"]): HTMLElement[] {
  const heading = element("h2", { text: "Settings", class: "unseen" });
  const about = changed.length > 0 ? `This run differs from ${base} in:` : `This run has the settings of ${base}.`;
  const differences = element("dl", {}, ...changed.flatMap(([path, value, before]) => [element("dt", { text: path }), element("dd", { text: `${value}, not ${before}` })]));
  const search = Object.assign(element("input"), { type: "search", placeholder: "find a setting" });
  search.setAttribute("aria-label", "find a setting");
  const rows = all.map(([path, value, meaning]) => element("div", {}, element("dt", { text: `${path} = ${value}` }), element("dd", { text: meaning })));
  search.oninput = () => rows.forEach((row, i) => (row.hidden = !all[i]!.some((text) => text.includes(search.value.trim().toLowerCase()))));
  const allSettings = element("details", {}, element("summary", { text: `All ${all.length} settings` }), search, element("dl", {}, ...rows));
  const hint = element("p", { text: "The settings of a recorded run can only be read. To change some, choose a live world above." });
  return [heading, element("p", { text: about }), differences, allSettings, hint];
}
