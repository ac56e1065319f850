// The panel with a table of all living agents. Clicking a header sorts it, a line of text filters it, and it can be saved as CSV.
import { brush } from "./brush";
import { csvTable, save } from "./csv";
import { by, counted, element, show, table } from "./element";
import type { Selection } from "./selection";
import type { Measure } from "./measure";
import type { Source } from "./source";
import type { Frame } from "./types";

const MOST_ROWS = 200; // shown at once
const DIGITS = 3; // of non-integers

interface Row {
  id: number;
  values: number[];
}

export class AgentTable {
  private readonly host = by<HTMLDivElement>("agents");
  private readonly filter = element("input");
  private readonly problem = element("p", { class: "problem" });
  private readonly count = element("p");
  private readonly area = element("p");
  private readonly areaText = element("span");
  private readonly names = element("details", {}, element("summary", { text: "Names for the filter" }), element("div"));
  private readonly head = element("thead");
  private readonly body = element("tbody");
  private columns: Measure[] = [];
  private rows: Row[] = [];
  private source!: Source;
  private frame: Frame | undefined;
  private by = "id"; // the column it is sorted by
  private down = false; // whether the largest value comes first
  private key = "";

  constructor(
    private readonly selection: Selection,
    private readonly changed: () => void,
    private readonly choose: (id: number) => void,
  ) {
    Object.assign(this.filter, { id: "filter", type: "search", placeholder: "age > 5000 and reward < 0", autocomplete: "off", spellcheck: false });
    this.filter.setAttribute("aria-describedby", "filter-problem");
    [this.problem.id, this.count.id, this.area.id] = ["filter-problem", "agents-count", "agents-area"];
    for (const each of [this.problem, this.count]) each.setAttribute("role", "status");
    this.filter.oninput = () => {
      selection.write(this.filter.value);
      changed();
    };
    const remove = element("button", { text: "Remove the rectangle" });
    remove.onclick = () => brush.clear();
    this.area.append(this.areaText, " ", remove);
    const csv = element("button", { text: "Save as CSV" });
    csv.id = "save-agents";
    csv.onclick = () => this.save();
    const scroll = element("div", { class: "agents" }, element("table", {}, this.head, this.body));
    scroll.tabIndex = 0; // so that it can be scrolled from the keyboard
    scroll.setAttribute("role", "region");
    scroll.setAttribute("aria-label", "Table of agents");
    this.host.replaceChildren(
      element("h2", { text: "Agents", class: "unseen" }),
      element("label", {}, "Filter ", this.filter),
      this.problem, this.area, this.count, element("div", { class: "row" }, csv), this.names, scroll,
    );
    this.body.onclick = (event) => {
      const row = this.rows[[...this.body.rows].indexOf((event.target as Element).closest("tr")!)];
      if (row) this.choose(row.id);
    };
    this.body.onkeydown = (event) => this.move(event);
  }

  /** Switches to another source. */
  open(source: Source): void {
    this.source = source;
    this.columns = this.selection.measures.filter(({ column }) => column);
    if (!this.columns.some(({ name }) => name === this.by)) [this.by, this.down] = ["id", false];
    this.names.lastElementChild!.replaceChildren(table(this.selection.measures.map(({ name, meaning }) => [name, meaning])));
    this.filter.value = this.selection.text;
    this.key = "";
    this.body.replaceChildren();
    this.head.replaceChildren(element("tr", {}, ...this.columns.map((column) => this.header(column))));
  }

  /** Sets the text of the filter, for example from a link. */
  write(text: string): void {
    this.filter.value = text;
    this.selection.write(text);
  }

  /** Fills the table with the picked agents of a frame; `picked` holds their indices in it. */
  update(frame: Frame | undefined, picked: number[], chosen: number): void {
    if (this.host.hidden || !frame) return;
    const { selection, source } = this;
    const key = [frame.step, source.lives.size, source.last, chosen, this.by, this.down, selection.text, picked.join()].join("|");
    if (key === this.key) return;
    [this.key, this.frame] = [key, frame];
    this.problem.textContent = selection.problem;
    this.filter.setAttribute("aria-invalid", String(selection.problem !== ""));
    this.area.hidden = !brush.active;
    this.areaText.textContent = `In the rectangle of the scatter plot: ${brush.text(this.geneNames())}.`;
    this.rows = this.sorted(picked.map((i) => ({ id: frame.id[i]!, values: this.columns.map(({ value }) => value(source.lives.get(frame.id[i]!), frame, i)) })));
    const matching = selection.active ? `${show(this.rows.length)} of ${counted(frame.id.length, "agent")} match and are ringed in the arena.` : `${counted(frame.id.length, "agent")} alive.`;
    const shown = this.rows.length > MOST_ROWS ? ` The first ${MOST_ROWS} are listed.` : "";
    this.count.textContent = matching + shown;
    this.fill(chosen);
  }

  private geneNames(): string[] {
    return this.source.layout.genes.map(({ name }) => name);
  }

  private header(column: Measure): HTMLElement {
    const sort = element("button", { text: column.name, title: column.meaning });
    const head = element("th", {}, sort);
    head.scope = "col";
    head.dataset.column = column.name;
    head.setAttribute("aria-sort", column.name === this.by ? (this.down ? "descending" : "ascending") : "none");
    sort.onclick = () => {
      this.down = column.name === this.by ? !this.down : column.name !== "id" && !column.words;
      this.by = column.name;
      for (const each of this.head.querySelectorAll("th")) each.setAttribute("aria-sort", each === head ? (this.down ? "descending" : "ascending") : "none");
      this.changed();
    };
    return head;
  }

  /** Sorts by the chosen column. Unknown values come last, and ties are in the order of ids. */
  private sorted(rows: Row[]): Row[] {
    const c = this.columns.findIndex(({ name }) => name === this.by);
    const sign = this.down ? -1 : 1;
    return rows.sort((a, b) => {
      const [x, y] = [a.values[c]!, b.values[c]!];
      if (Number.isNaN(x) !== Number.isNaN(y)) return Number.isNaN(x) ? 1 : -1;
      return sign * (x - y) || a.id - b.id;
    });
  }

  /** Reuses the existing row elements, so that the one that is focused or being touched stays in place. */
  private fill(chosen: number): void {
    const { rows, columns, body } = this;
    const shown = Math.min(rows.length, MOST_ROWS);
    while (body.rows.length > shown) body.deleteRow(-1);
    while (body.rows.length < shown) body.append(this.row());
    for (let r = 0; r < shown; r++) {
      const [{ id, values }, row] = [rows[r]!, body.rows[r]!];
      columns.forEach(({ words }, c) => {
        const text = words?.[values[c]!] ?? show(values[c], DIGITS);
        const cell = (c === 0 ? row.cells[0]!.firstElementChild : row.cells[c]) as HTMLElement;
        if (cell.textContent !== text) cell.textContent = text;
      });
      row.cells[0]!.firstElementChild!.setAttribute("aria-label", `Agent ${id}`);
      row.classList.toggle("chosen", id === chosen);
    }
  }

  private row(): HTMLElement {
    const choose = element("button", { class: "link" });
    choose.tabIndex = this.body.rows.length === 0 ? 0 : -1; // the Tab key stops here once; arrow keys move between rows
    return element("tr", {}, element("td", {}, choose), ...this.columns.slice(1).map(({ words }) => element("td", { class: words ? "word" : "" })));
  }

  private move(event: KeyboardEvent): void {
    const buttons = [...this.body.querySelectorAll("button")];
    const at = buttons.indexOf(event.target as HTMLButtonElement);
    const to = { ArrowUp: at - 1, ArrowDown: at + 1, Home: 0, End: buttons.length - 1 }[event.key];
    if (at < 0 || to === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    const next = buttons[Math.min(Math.max(to, 0), buttons.length - 1)]!;
    [buttons[at]!.tabIndex, next.tabIndex] = [-1, 0];
    next.focus();
  }

  /** Saves all picked agents, in the order of the table, at full precision. */
  private save(): void {
    if (!this.frame) return;
    const text = (value: number, { words }: Measure) => words?.[value] ?? (Number.isNaN(value) ? "" : String(value));
    const lines = this.rows.map(({ values }) => values.map((value, c) => text(value, this.columns[c]!)));
    save(`agents-step-${Math.floor(this.frame.step)}.csv`, csvTable(this.columns.map(({ name }) => name), lines));
  }
}
