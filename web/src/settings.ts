// The settings of a live world, each with its meaning, unit and range. Refusals have the same wording as on the command line.
import { by, element, option, show } from "./element";
import type { Live } from "./live";
import type { LiveWorld, Setting } from "./types";

/** The error message for a value, worded as by `hedon run --set`; "" if it is valid. */
export function refusal(setting: Setting, text: string): string {
  const shown = setting.choices.length > 0 ? JSON.stringify(text) : text;
  const wrong = `${setting.path} = ${shown}: must be ${setting.allowed}`;
  if (setting.choices.length > 0) return setting.choices.includes(text) ? "" : wrong;
  if (typeof setting.value === "boolean") return text === "true" || text === "false" ? "" : wrong;
  const value = Number(text);
  if (text.trim() === "" || !Number.isFinite(value) || (setting.whole && !/^-?\d+$/.test(text.trim()))) return wrong;
  const { ge, gt, le, lt } = setting;
  const inside =
    (ge === null || value >= ge) && (gt === null || value > gt) && (le === null || value <= le) && (lt === null || value < lt);
  return inside ? "" : wrong;
}

/** The command that runs the same world with the same digest; it omits changes made while the world ran. */
export function command(world: LiveWorld, changes: Map<string, string>, seed: number, steps: number): string {
  const words = ["hedon run", world.source];
  if (world.fidelity !== "corrected") words.push(`--fidelity ${world.fidelity}`);
  words.push(`--seeds ${seed}`, `--steps ${Math.max(steps, 1)}`);
  for (const [path, value] of changes) words.push(`--set ${path}=${value}`);
  return words.join(" ");
}

/** The same world as a config file. */
export function configFile(world: LiveWorld, changes: Map<string, string>): string {
  const quoted = new Set(world.settings.filter((setting) => setting.choices.length > 0).map((setting) => setting.path));
  const written = (path: string, value: string) => (quoted.has(path) ? JSON.stringify(value) : value);
  if (world.toml) return changedLines(world.toml, changes, written);
  const lines = [`preset = "${world.source}"`, `fidelity = "${world.fidelity}"`];
  for (const [path, value] of changes) lines.push(`${path} = ${written(path, value)}`);
  return lines.join("\n") + "\n";
}

/** A complete config with some values changed; each setting has a line of its own below the name of its table. */
function changedLines(toml: string, changes: Map<string, string>, written: (path: string, value: string) => string): string {
  let table = "";
  const line = (text: string): string => {
    const name = /^\[(.*)\]$/.exec(text);
    if (name) table = `${name[1]}.`;
    const row = /^([\w-]+) = \{([^}]*)\}/.exec(text);
    if (row) {
      const number = (whole: string, each: string) => {
        const changed = changes.get(`${table}${row[1]}.${each}`);
        return changed === undefined ? whole : `${each} = ${changed}`;
      };
      return text.replace(row[0], `${row[1]} = {${row[2]!.replace(/([\w-]+) = [^,]+/g, number)}}`);
    }
    const key = /^([\w-]+) = /.exec(text);
    const value = key ? changes.get(table + key[1]) : undefined;
    return value === undefined ? text : `${key![1]} = ${written(table + key![1], value)}`;
  };
  return toml.split("\n").map(line).join("\n");
}

const PAUSE_MS = 400; // from the last move of a slider until the world takes its value

export class Settings {
  private readonly changes = new Map<string, string>();
  private readonly host = by<HTMLDivElement>("settings");
  private readonly problem = element("p", { class: "problem" });
  private readonly restart = element("button", { text: "Start again with these", class: "main" });
  private readonly wrong = new Map<string, string>();
  private readonly due = new Map<string, ReturnType<typeof setTimeout>>();
  private readonly seed = Object.assign(element("input"), { type: "number", min: "0", step: "1" });

  constructor(
    private readonly live: Live,
    start: (changes: Map<string, string>, seed: number) => void,
  ) {
    const { world } = live;
    this.seed.value = String(live.seed);
    this.problem.setAttribute("role", "alert");
    this.restart.id = "restart";
    this.restart.onclick = () => start(new Map(this.changes), Math.max(0, Math.floor(Number(this.seed.value)) || 0));
    const search = Object.assign(element("input"), { type: "search", placeholder: "find a setting" });
    search.setAttribute("aria-label", "Find a setting");
    const list = element("div");
    for (const [name, settings] of grouped(world.settings)) {
      const box = element("details", {}, element("summary", { text: name }));
      box.open = settings.some(({ path }) => live.changes.has(path));
      for (const setting of settings) box.append(this.row(setting, live.changes.get(setting.path)));
      list.append(box);
    }
    search.oninput = () => filter(list, search.value);
    this.host.replaceChildren(
      element("h2", { text: "Settings", class: "unseen" }),
      element("p", { text: `${world.name}: ${world.description}` }),
      element("label", { class: "setting" }, element("span", { text: "seed" }), this.seed),
      this.restart,
      this.problem,
      element("p", { text: "A change takes effect at once if the running world can take it. Other changes need a new start.", class: "quiet" }),
      search,
      list,
    );
  }

  private row(setting: Setting, changed: string | undefined): HTMLElement {
    const initial = String(setting.value);
    const input = setting.choices.length > 0 ? element("select") : Object.assign(element("input"), { inputMode: "decimal" as const });
    for (const choice of setting.choices) input.append(option(choice, choice));
    input.value = changed ?? initial;
    input.dataset.path = setting.path;
    const name = setting.path.slice(setting.path.indexOf(".") + 1);
    const row = element("label", { class: "setting" }, element("span", { text: name }), input);
    const slider = range(setting);
    const take = (text: string) => {
      input.value = text;
      this.take(setting, text, initial, row);
      this.act(setting, text, row);
    };
    input.addEventListener("input", () => {
      if (slider) slider.value = String(toSlider(setting, Number(input.value)));
      take(input.value);
    });
    if (slider) {
      slider.value = String(toSlider(setting, Number(input.value)));
      slider.setAttribute("aria-label", setting.path);
      slider.addEventListener("input", () => take(fromSlider(setting, Number(slider.value))));
      row.append(slider);
    }
    row.append(element("small", { text: `${setting.meaning}; ${setting.allowed}` }), element("small", { class: "when" }));
    if (changed !== undefined) this.take(setting, changed, initial, row);
    return row;
  }

  private take(setting: Setting, text: string, initial: string, row: HTMLElement): void {
    const wrong = refusal(setting, text);
    if (wrong) this.wrong.set(setting.path, wrong);
    else this.wrong.delete(setting.path);
    if (text === initial) this.changes.delete(setting.path);
    else this.changes.set(setting.path, text);
    row.classList.toggle("changed", text !== initial);
    row.classList.toggle("wrong", wrong !== "");
    this.problem.textContent = [...this.wrong.values()].join("\n");
    this.restart.disabled = this.wrong.size > 0;
  }

  /** Continues the world with the value, shortly after its last change, or shows that the value requires a restart. */
  private act(setting: Setting, text: string, row: HTMLElement): void {
    const when = row.querySelector(".when")!;
    clearTimeout(this.due.get(setting.path));
    when.textContent = "";
    if (refusal(setting, text)) return;
    if (!setting.at_once) {
      when.textContent = "matters from the beginning: start again";
      return;
    }
    const done = async () => {
      const refused = await this.live.change(setting.path, text);
      when.textContent = refused ? `${refused}: start again` : `acts since step ${show(this.live.last)}`;
    };
    this.due.set(setting.path, setTimeout(() => void done(), PAUSE_MS));
  }
}

function grouped(settings: Setting[]): Map<string, Setting[]> {
  const groups = new Map<string, Setting[]>();
  for (const setting of settings) {
    const name = setting.path.slice(0, setting.path.indexOf("."));
    groups.set(name, [...(groups.get(name) ?? []), setting]);
  }
  return groups;
}

function filter(list: HTMLElement, text: string): void {
  for (const box of list.querySelectorAll("details")) {
    let any = false;
    for (const row of box.querySelectorAll<HTMLElement>(".setting")) {
      row.hidden = !(box.firstChild!.textContent + " " + row.textContent).toLowerCase().includes(text.toLowerCase());
      any ||= !row.hidden;
    }
    box.hidden = !any;
    if (text) box.open = any;
  }
}

/** A slider from a tenth to ten times the world's value, within the allowed range. */
function range(setting: Setting): HTMLInputElement | undefined {
  if (typeof setting.value !== "number" || setting.value <= 0) return undefined;
  return Object.assign(element("input", { class: "slider" }), { type: "range", min: "-1", max: "1", step: "0.02" });
}

const toSlider = (setting: Setting, value: number): number => Math.log10(Math.max(value, 1e-9) / (setting.value as number));

function fromSlider(setting: Setting, at: number): string {
  let value = (setting.value as number) * 10 ** at;
  if (Math.abs(at) < 0.01) return String(setting.value);
  value = Math.min(Math.max(value, setting.ge ?? -Infinity), setting.le ?? Infinity);
  return setting.whole ? String(Math.round(value)) : String(Number(value.toPrecision(3)));
}
