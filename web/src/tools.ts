// Tools for a live world, apart from its settings: editing by hand, a snapshot, a second world, and saving files.
import { csvOf, save } from "./csv";
import { by, element, option, show } from "./element";
import { Live } from "./live";
import { configFile, refusal } from "./settings";
import type { Source } from "./source";
import type { Setting } from "./types";

export class Tools {
  private readonly host = by<HTMLDivElement>("world-panel");
  private readonly edit = element("select");
  private readonly back = element("button");
  private readonly refused = element("p", { class: "problem" });
  private readonly kept = element("p", { class: "quiet" });
  private readonly digest = element("p");
  private readonly live: Live | undefined;

  constructor(
    private readonly source: Source,
    beside: (setting: Setting, value: string) => void,
    alone: () => void,
  ) {
    this.digest.id = "digest";
    const heading = element("h2", { text: "World", class: "unseen" });
    const live = source instanceof Live ? source : undefined;
    this.live = live;
    if (!live) {
      this.host.replaceChildren(heading, element("p", { text: "A recorded world cannot be changed. Choose a live world above." }), element("h3", { text: "digest" }), this.digest);
      return;
    }
    this.refused.setAttribute("role", "alert");
    this.edit.id = "edit";
    this.back.id = "back";
    this.back.addEventListener("click", () => live.act({ type: "back" }));
    const keep = this.button("keep", "Keep it as it is now", () => live.act({ type: "keep" }));
    this.host.replaceChildren(
      heading,
      element("h3", { text: "by hand" }),
      element("label", {}, "A click in the arena ", this.edit),
      this.refused,
      element("p", { text: "An added agent has a founder's energy, new genes and a new network. After a change by hand, no config reproduces this world.", class: "quiet" }),
      element("h3", { text: "snapshot" }),
      element("div", { class: "row" }, keep, this.back),
      this.kept,
      element("h3", { text: "files" }),
      element("div", { class: "row" }, ...this.files(live)),
      element("h3", { text: "side by side" }),
      ...this.pair(live, beside, alone),
      element("h3", { text: "digest" }),
      this.digest,
    );
    this.edit.append(option("choose", "chooses an agent"));
    live.layout.types.slice(0, live.layout.species.length + live.layout.foods.length).forEach((name, type) => {
      this.edit.append(option(String(type), `adds ${type < live.layout.species.length ? "" : "food "}${name}`));
    });
    this.edit.append(option("remove", "removes what is there"));
    this.update(live.last);
  }

  /** Makes the chosen edit; returns false if a click should choose an agent instead. */
  click(source: Source, x: number, y: number, pixel: number): boolean {
    if (!this.live || source !== this.live || this.edit.value === "choose") return false;
    if (this.edit.value === "remove") this.live.act({ type: "remove", x, y, slack: 3 * pixel });
    else this.live.act({ type: "add", kind: Number(this.edit.value), x, y });
    return true;
  }

  update(now: number): void {
    const digest = this.source.digest();
    const known = digest !== "" && (!this.source.live || now >= this.source.last);
    const digestText = `digest ${digest}${this.live?.edited ? ", changed by hand" : ""}`;
    this.digest.textContent = known ? digestText : "Pause at the newest step to see the digest of the state.";
    if (!this.live) return;
    this.refused.textContent = this.live.refused;
    this.back.disabled = this.live.kept < 0;
    this.back.textContent = this.live.kept < 0 ? "Go back" : `Go back to step ${show(this.live.kept)}`;
    this.kept.textContent = this.live.kept < 0 ? "Nothing is kept yet." : "";
  }

  private pair(live: Live, beside: (setting: Setting, value: string) => void, alone: () => void): HTMLElement[] {
    const { settings } = live.world;
    const [choice, value, wrong] = [element("select"), element("input"), element("p", { class: "problem" })];
    [choice.id, value.id] = ["twin-setting", "twin-value"];
    choice.append(...settings.map((setting) => option(setting.path, setting.path)));
    const chosen = () => settings.find((setting) => setting.path === choice.value)!;
    const fill = () => (value.value = live.changes.get(choice.value) ?? String(chosen().value));
    choice.value = settings.find((setting) => setting.path.endsWith("energy.basic_cost"))?.path ?? choice.value;
    choice.addEventListener("change", fill);
    fill();
    choice.setAttribute("aria-label", "The setting that differs");
    value.setAttribute("aria-label", "Its value in the second world");
    wrong.setAttribute("role", "alert");
    const begin = this.button("twin-begin", "Begin both", () => {
      wrong.textContent = refusal(chosen(), value.value);
      if (!wrong.textContent) beside(chosen(), value.value);
    });
    const end = this.button("twin-end", "One world again", alone);
    const explanation = "The world begins again, next to a copy of it with the same seed and this setting changed.";
    return [element("p", { text: explanation, class: "quiet" }), choice, element("div", { class: "row" }, value, begin, end), wrong];
  }

  private files(live: Live): HTMLElement[] {
    const name = `${live.world.name}-s${live.seed}`;
    const lives = (ended: boolean) => [...live.lives.all()].filter((life) => life.death >= 0 === ended).sort((a, b) => a.id - b.id);
    return [
      this.button("save-config", "Config", () => save(`${live.world.name}.toml`, configFile(live.world, live.changes))),
      this.button("save-living", "The living", () => save(`${name}-living.csv`, csvOf(live, live.seed, lives(false)))),
      this.button("save-ended", "Lives that ended", () => save(`${name}-ended.csv`, csvOf(live, live.seed, lives(true)))),
    ];
  }

  private button(id: string, text: string, act: () => void): HTMLButtonElement {
    const made = element("button", { text });
    made.id = id;
    made.addEventListener("click", act);
    return made;
  }
}
