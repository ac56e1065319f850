// A plot as a picture: redrawn at twice its size on screen, with its title and a key to its colors.
import uPlot from "uplot";
import { save } from "./csv";
import { styleColor } from "./element";

const TIMES = 2;
const PAD = 12; // pixels of the page
const LINE = 18; // height of a line of text

/** A color and its meaning. */
export interface Key {
  label: string;
  color: string; // a variable of the page's style if it begins with "--"
}

/** The place of each key, wrapped into lines of a width. */
function placed(pen: CanvasRenderingContext2D, keys: Key[], width: number): { key: Key; x: number; line: number }[] {
  let [x, line] = [0, 0];
  return keys.map((key) => {
    const needed = pen.measureText(`● ${key.label}`).width + 14;
    if (x > 0 && x + needed > width) [x, line] = [0, line + 1];
    const place = { key, x, line };
    x += needed;
    return place;
  });
}

/** A title wrapped into lines of a width. */
function wrapped(pen: CanvasRenderingContext2D, text: string, width: number): string[] {
  const lines = [""];
  for (const word of text.split(" ")) {
    const longer = `${lines[lines.length - 1]!} ${word}`.trim();
    if (pen.measureText(longer).width > width) lines.push(word);
    else lines[lines.length - 1] = longer;
  }
  return lines;
}

/** Draws a chart on a canvas of its own; a chart is drawn a moment after it is made. */
async function drawn(options: uPlot.Options, data: uPlot.AlignedData): Promise<HTMLCanvasElement> {
  const host = document.createElement("div");
  const chart = await new Promise<uPlot>((resolve) => {
    new uPlot({ ...options, cursor: { show: false }, hooks: { ...options.hooks, draw: [...(options.hooks?.draw ?? []), resolve] } }, data, host);
  });
  const canvas = chart.ctx.canvas;
  chart.destroy();
  return canvas;
}

/** Saves a plot; `made` returns its options, enlarged by a factor, and its data. */
export async function savePicture(name: string, title: string, keys: Key[], made: (times: number) => readonly [uPlot.Options, uPlot.AlignedData]): Promise<void> {
  const [options, data] = made(TIMES / devicePixelRatio); // the chart itself multiplies by the screen's ratio
  const chart = await drawn(options, data);
  const width = chart.width / TIMES;
  const canvas = document.createElement("canvas");
  const pen = canvas.getContext("2d")!;
  const [bold, plain] = ["600 13px system-ui, sans-serif", "12px system-ui, sans-serif"];
  pen.font = bold;
  const titles = wrapped(pen, title, width);
  pen.font = plain;
  const places = placed(pen, keys, width);
  const above = PAD + LINE * (titles.length + (places.length > 0 ? places[places.length - 1]!.line + 1 : 0));
  [canvas.width, canvas.height] = [chart.width + 2 * PAD * TIMES, chart.height + (above + PAD) * TIMES];
  pen.fillStyle = styleColor("--card");
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.setTransform(TIMES, 0, 0, TIMES, PAD * TIMES, PAD * TIMES);
  pen.textBaseline = "top";
  const ink = styleColor("--ink");
  pen.fillStyle = ink;
  pen.font = bold;
  titles.forEach((text, i) => pen.fillText(text, 0, i * LINE));
  pen.font = plain;
  for (const { key, x, line } of places) {
    const y = (titles.length + line) * LINE;
    pen.fillStyle = key.color.startsWith("--") ? styleColor(key.color) : key.color;
    pen.fillText("●", x, y);
    pen.fillStyle = ink;
    pen.fillText(` ${key.label}`, x + pen.measureText("●").width, y);
  }
  pen.setTransform(1, 0, 0, 1, 0, 0);
  pen.drawImage(chart, PAD * TIMES, above * TIMES);
  const blob = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve));
  if (blob) save(name, blob);
}
