// A map over the arena of how often agents were, or ate, in each part of it. Nothing is counted until the map is chosen.
import type { Arena } from "./arena";
import { css, pack, parse } from "./color";
import { by, counted, element, option, show, styleColor } from "./element";
import { quantile } from "./scale";
import type { Scene } from "./scene";
import type { Source } from "./source";
import type { Frame } from "./types";

const CELLS = 40; // along the longer side of the arena
const WITHIN = 0.98; // share of the nonempty cells that are within the scale
const STRONGEST = 215; // alpha of a cell at the end of the scale, out of 255

export class Heat {
  /** The count in each cell, row by row from y = 0. */
  counts = new Float64Array();
  columns = 0;
  size = 1; // side length of a cell [u]
  kind = "";
  moments = 0; // counted so far
  reading = false;
  private rows = 0;
  private source!: Source;
  private seen = -Infinity; // the step of the last moment counted, or the number of meals counted
  private rewinds = 0;
  private most = 0; // the end of the scale
  private turn = 0; // incremented whenever counting restarts, so that late answers are dropped
  private shown = ""; // key of the legend's content
  private readonly list = by<HTMLSelectElement>("heat");
  private readonly legend = by<HTMLDivElement>("heat-scale");

  constructor(private readonly arena: Arena) {
    this.list.onchange = () => this.begin(this.list.value);
  }

  /** Switches to another source; records do not have the places of meals. */
  open(source: Source): void {
    this.source = source;
    const meals = option("meals", source.bites ? "meals" : "meals: not in records");
    meals.disabled = !source.bites;
    this.list.replaceChildren(option("", "no map"), option("positions", "positions"), meals);
    this.begin(meals.disabled && this.kind === "meals" ? "" : this.kind);
  }

  /** Counts what was added since the last update. */
  update(): void {
    const { source, kind } = this;
    if (kind === "") return;
    if (source.lives.rewinds !== this.rewinds) return this.begin(kind);
    if (kind === "meals") {
      source.bites!.after(this.seen, (x, y) => this.count(x, y));
      this.seen = source.bites!.total;
      return this.show();
    }
    if (this.reading) return this.show(); // the count so far
    this.reading = true;
    const { turn } = this;
    const take = (frame: Frame): boolean => {
      if (turn !== this.turn) return false;
      for (let i = 0; i < frame.id.length; i++) this.count(frame.x[i]!, frame.y[i]!);
      this.moments++;
      this.seen = frame.step;
      return true;
    };
    void source.moments(this.seen, take).then(() => {
      if (turn !== this.turn) return;
      this.reading = false;
      this.show();
    });
  }

  private begin(kind: string): void {
    const { width, height } = this.source.layout.arena;
    this.kind = this.list.value = kind;
    this.turn++;
    this.reading = false;
    this.size = Math.max(width, height) / CELLS;
    [this.columns, this.rows] = [Math.ceil(width / this.size), Math.ceil(height / this.size)];
    this.counts = new Float64Array(kind === "" ? 0 : this.columns * this.rows);
    [this.moments, this.most, this.rewinds] = [0, 0, this.source.lives.rewinds];
    this.seen = kind === "meals" ? 0 : -Infinity;
    this.arena.under = kind === "" ? undefined : (scene) => this.draw(scene);
    this.legend.hidden = kind === "";
    this.update();
  }

  private count(x: number, y: number): void {
    const [column, row] = [Math.floor(x / this.size), Math.floor(y / this.size)];
    if (column >= 0 && column < this.columns && row >= 0 && row < this.rows) this.counts[row * this.columns + column]!++;
  }

  private show(): void {
    const { counts, source, moments } = this;
    const total = counts.reduce((sum, each) => sum + each, 0);
    const key = [this.kind, total, moments, this.reading, styleColor("--heat")].join();
    if (key === this.shown) return;
    this.shown = key;
    this.most = quantile([...counts].filter((each) => each > 0), WITHIN) || 0;
    if (moments === 0 && this.kind === "positions" && !this.reading) return this.legend.replaceChildren("No positions are recorded.");
    const what = this.kind === "meals" ? `meals eaten in each square, ${show(total)} in all` : `agents in each square, at ${counted(moments, "moment")} ${source.live ? "seen" : "recorded"}`;
    const bar = element("i", { class: "ramp" });
    const [r, g, b] = parse(styleColor("--heat"));
    bar.style.background = `linear-gradient(90deg, transparent, ${css([r, g, b])})`;
    this.legend.replaceChildren(element("strong", { text: `Map: ${what}` }), element("span", {}, "0 ", bar, ` ${show(this.most)} and more`), ...(this.reading ? ["reading the records …"] : []));
  }

  private draw(scene: Scene): void {
    if (this.most === 0) return;
    const { size, columns } = this;
    const color = parse(styleColor("--heat"));
    this.counts.forEach((count, i) => {
      if (count === 0) return;
      const [x, y] = [(i % columns) * size, Math.floor(i / columns) * size];
      scene.polygon([[x, y], [x + size, y], [x + size, y + size], [x, y + size]], pack(color, Math.round(STRONGEST * Math.min(count / this.most, 1))));
    });
  }
}
