// One plot over time: its title, the values under the cursor, its files, and its use by mouse, touch and keyboard.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { save } from "./csv";
import { element, show, styleColor } from "./element";
import { dragByFinger } from "./finger";
import { savePicture, type Key } from "./plotfile";

const DRAG = 5; // pixels; less is a click
const OUTSIDE = -10; // pixels: the position of a cursor that is not on the chart
const CLOSER = 2; // factor by which a key narrows the range of steps

/** What a plot shows. If its lines change, `Plot.remake` has to be called. */
export interface Content {
  title: string;
  unit: string;
  file: string; // last part of the names of its files
  height: number;
  lines: Key[]; // those with a name; if there are several, a dot for each follows the title
  notes(): Key[]; // further explanations in a saved picture
  series(): uPlot.Series[];
  bands(): uPlot.Band[];
  data(): uPlot.AlignedData;
  under?(chart: uPlot): void; // draws behind the lines
  yRange?: uPlot.Range.Function;
  values(row: number): string; // for the readout under the cursor
  csv(): string;
  empty(): string; // message while there is nothing to see; "" otherwise
}

/** State shared by all plots: the range of steps, and the moment shown. */
export interface View {
  zoom: [number, number] | undefined;
  now: number;
  setZoom(zoom: [number, number] | undefined): void;
  seek(step: number): void;
  file(name: string): string;
  world: string; // its run and seed, for saved pictures
}

export class Plot {
  chart!: uPlot;
  judge?: (at: number) => void;
  readonly parts: HTMLElement[];
  private readonly readout = element("p", { class: "readout" });
  private readonly frame = element("div", { class: "plot" });
  private readonly empty = element("p", { class: "empty" });
  private dragged = false; // whether the mouse press before a click was a drag
  private former = 0; // moment before the first click of a double click
  private marked = NaN;

  constructor(
    readonly content: Content,
    private readonly view: View,
    verdict?: HTMLElement,
  ) {
    const { title, unit, lines } = content;
    const heading = element("h3", { class: "plot-title" }, `${title} [${unit}]`);
    if (lines.length > 1) heading.append(...lines.flatMap((line) => [" ", dotted(line)]));
    const head = element("div", { class: "plot-head" }, heading, this.button("CSV", () => save(view.file(`${content.file}.csv`), content.csv())), this.button("PNG", () => void this.picture()));
    this.frame.append(this.empty);
    this.parts = [head, ...(verdict ? [verdict] : []), this.readout, this.frame];
    this.remake();
  }

  /** Makes the chart again after its lines have changed. */
  remake(): void {
    const width = this.chart?.width ?? 300;
    this.chart?.destroy();
    this.chart = new uPlot(this.options(width, 1), this.content.data(), this.frame);
    this.bind();
  }

  update(width: number, grown: boolean): void {
    const { chart, content, view } = this;
    const resized = chart.width !== width;
    if (resized) {
      chart.setSize({ width, height: content.height });
      this.readout.style.minHeight = "";
    }
    if (grown) chart.setData(content.data());
    else if (view.now !== this.marked || resized) chart.redraw(false);
    this.marked = view.now;
    const empty = content.empty();
    this.empty.hidden = empty === "";
    this.empty.textContent = empty;
    this.read();
  }

  /** Shows the range of steps chosen for all plots. */
  rescale(): void {
    this.chart.setData(this.chart.data);
  }

  /** Shows the values of the row under the cursor or, without a cursor, of the moment shown. */
  private read(): void {
    const { chart, content, view } = this;
    const steps = chart.data[0];
    const row = chart.cursor.idx ?? (steps as number[]).findLastIndex((step) => step <= view.now);
    const step = steps[row];
    const text = step === undefined ? "" : `step ${show(step)}: ${content.values(row)}`;
    if (this.readout.textContent !== text) {
      this.readout.textContent = text;
      // A longer text wraps. A shorter one after it must not move the chart away from under the cursor.
      this.readout.style.minHeight = `${Math.max(this.readout.offsetHeight, parseFloat(this.readout.style.minHeight) || 0)}px`;
    }
    const { over } = chart;
    over.setAttribute("aria-valuemin", String(steps[0] ?? 0));
    over.setAttribute("aria-valuemax", String(steps[steps.length - 1] ?? 0));
    over.setAttribute("aria-valuenow", String(step ?? 0));
    over.setAttribute("aria-valuetext", text || "nothing yet");
  }

  private options(width: number, times: number): uPlot.Options {
    const { content, view } = this;
    const size = (pixels: number) => pixels * times;
    const font = `${size(12)}px system-ui, sans-serif`;
    const axis: uPlot.Axis = { stroke: () => styleColor("--quiet"), grid: { stroke: "#8882", width: size(1) }, ticks: { show: false }, size: size(52), gap: size(5), space: size(30), font, labelFont: font, values: (_, places) => places.map((each) => show(each, 3)) };
    const series = content.series().map((each) => ({ ...each, width: size(each.width ?? 1), dash: each.dash?.map(size), points: { show: false } }));
    const main = (i: number) => series[i - 1]?.label !== undefined;
    return {
      width: size(width),
      height: size(content.height),
      padding: [size(10), size(32), 0, 0], // half of the last step's label extends to the right of the plot
      legend: { show: false },
      cursor: {
        y: false,
        sync: { key: "time", filters: { pub: (type) => type === "mousemove" || type === "mouseleave", sub: () => true } },
        drag: { x: true, y: false, setScale: false, dist: DRAG, click: () => undefined },
        points: { show: ((_: uPlot, i: number) => main(i) && element("div")) as uPlot.Cursor.Points["show"] },
      },
      scales: { x: { time: false, range: (_, low, high) => view.zoom ?? [low, high] }, ...(content.yRange ? { y: { range: content.yRange } } : {}) },
      series: [{ label: "step" }, ...series],
      bands: content.bands(),
      axes: [{ ...axis, size: size(30), label: "step", labelSize: size(16), space: size(50) }, axis],
      hooks: {
        drawAxes: [(chart) => content.under?.(chart)],
        draw: [(chart) => this.markNow(chart, times)],
        setCursor: [() => this.chart && this.read()],
        setSelect: [(chart) => this.select(chart)],
      },
    };
  }

  /** Zooms to a range of steps if the mouse was dragged far enough. */
  private select(chart: uPlot): void {
    const { left, width } = chart.select;
    if (width < DRAG) return;
    this.dragged = true;
    chart.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    this.view.setZoom([chart.posToVal(left, "x"), chart.posToVal(left + width, "x")]);
  }

  private bind(): void {
    const { chart, view } = this;
    const { over } = chart;
    over.tabIndex = 0;
    over.setAttribute("role", "slider");
    over.setAttribute("aria-label", `${this.content.title} at a step`);
    over.addEventListener("mousedown", () => (this.dragged = false), true);
    over.addEventListener("click", (event) => {
      const step = chart.posToVal(chart.cursor.left ?? -1, "x");
      if (this.dragged || !Number.isFinite(step)) return;
      if (event.detail < 2) this.former = view.now;
      view.seek(step);
    });
    over.addEventListener("dblclick", () => {
      view.setZoom(undefined);
      view.seek(this.former);
    });
    over.addEventListener("keydown", (event) => this.key(event));
    over.addEventListener("blur", () => point(chart, OUTSIDE));
    dragByFinger(over);
  }

  private key(event: KeyboardEvent): void {
    const { chart, view } = this;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const steps = chart.data[0] as number[];
    const { min, max } = chart.scales.x as { min: number; max: number };
    const [first, last] = [steps.findIndex((step) => step >= min), steps.findLastIndex((step) => step <= max)];
    if (first < 0 || last < first) return;
    const at = chart.cursor.idx ?? Math.min(Math.max(steps.findLastIndex((step) => step <= view.now), first), last);
    const row = { ArrowLeft: at - (event.shiftKey ? 10 : 1), ArrowRight: at + (event.shiftKey ? 10 : 1), Home: first, End: last }[event.key];
    const pointAt = (row: number) => point(chart, chart.valToPos(steps[row]!, "x"));
    if (row !== undefined) pointAt(Math.min(Math.max(row, first), last));
    else if (event.key === "Enter") view.seek(steps[at]!);
    else if (event.key === "+" || event.key === "-") {
      const half = ((max - min) / 2) * (event.key === "+" ? 1 / CLOSER : CLOSER);
      view.setZoom([steps[at]! - half, steps[at]! + half]);
      queueMicrotask(() => pointAt(at)); // the chart applies its new range at the end of this task
    } else return;
    event.preventDefault();
    event.stopPropagation(); // elsewhere these keys control the world
  }

  private markNow(chart: uPlot, times: number): void {
    const x = chart.valToPos(this.view.now, "x", true);
    const { left, width } = chart.bbox;
    if (!(x >= left && x <= left + width)) return; // otherwise it would cover the labels of the axis
    chart.ctx.fillStyle = styleColor("--mark");
    chart.ctx.fillRect(x - times, chart.bbox.top, 2 * times, chart.bbox.height);
  }

  private async picture(): Promise<void> {
    const { content, chart, view } = this;
    const title = `${content.title} [${content.unit}] (${view.world})`;
    const keys = [...(content.lines.length > 1 ? content.lines : []), ...content.notes()];
    const made = (times: number) => [this.options(chart.width, times), content.data()] as const;
    await savePicture(view.file(`${content.file}.png`), title, keys, made);
  }

  private button(text: string, act: () => void): HTMLButtonElement {
    const button = element("button", { text, class: "file" });
    button.setAttribute("aria-label", `${text} of ${this.content.title}`);
    button.onclick = act;
    return button;
  }
}

/** Puts the cursor of all charts at a place in one of them; the type of `setCursor` lacks its `publish` argument. */
function point(chart: uPlot, left: number): void {
  const move = chart.setCursor as (to: { left: number; top: number }, fire: boolean, publish: boolean) => void;
  move({ left, top: left < 0 ? left : chart.over.clientHeight / 2 }, true, true);
}

function dotted({ label, color }: Key): HTMLElement {
  const dot = element("b", { text: "●" });
  dot.style.color = color.startsWith("--") ? `var(${color})` : color;
  return element("span", {}, dot, ` ${label}`);
}
