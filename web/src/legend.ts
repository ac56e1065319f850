// The legend of the arena: the color scale, and a sign for each kind of thing drawn there.
import type { Arena } from "./arena";
import type { Coloring, Painted } from "./color";
import { by, element, show } from "./element";
import type { Source } from "./source";

const SVG = "http://www.w3.org/2000/svg";
const BODY = "#8a929b"; // fill of an agent in the signs

type Part = [name: string, attributes: Record<string, string | number>];

/** A sign of 18 by 18 pixels; a color that begins with "--" is a variable of the page's style. */
function sign(...parts: Part[]): SVGSVGElement {
  const made = document.createElementNS(SVG, "svg");
  for (const [key, value] of Object.entries({ width: 18, height: 18, viewBox: "-9 -9 18 18", "aria-hidden": "true" })) made.setAttribute(key, String(value));
  for (const [name, attributes] of parts) {
    const part = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) {
      if (String(value).startsWith("--")) part.style.setProperty(key, `var(${value})`);
      else part.setAttribute(key, String(value));
    }
    made.append(part);
  }
  return made;
}

const disc = (radius: number, fill: string): Part => ["circle", { r: radius, fill }];
const ring = (radius: number, stroke: string, width = 1.8): Part => ["circle", { r: radius, fill: "none", stroke, "stroke-width": width }];
const line = (stroke: string): Part => ["line", { x1: -8, y1: 4, x2: 8, y2: -4, stroke, "stroke-width": 2 }];
const square = (fill: string): Part => ["rect", { x: -6, y: -6, width: 12, height: 12, fill }];
const MOUTH: Part = ["path", { d: "M-4.6 -4.6 A6.5 6.5 0 0 1 4.6 -4.6", fill: "none", stroke: "--mouth", "stroke-width": 2 }];
const EYE: Part = ["circle", { cy: -3, r: 1.4, fill: "#0d0d0d" }];

/** The signs of a world with their meanings, including those of the chosen agent if there is one. */
function signs(source: Source, arena: Arena, chosen: boolean): [SVGSVGElement, string][] {
  const { layout } = source;
  const entries: [SVGSVGElement, string][] = layout.foods.map((food) => [sign(disc(4.5, food.color)), `food ${food.name}`]);
  entries.push([sign(disc(6.5, BODY), MOUTH, EYE), "agent: red mouth, dark dot ahead"]);
  if (layout.species.length > 1) layout.species.forEach(({ name, color }, i) => entries.push(i === 0 ? [sign(disc(6, BODY)), `${name}: no ring`] : [sign(disc(5, BODY), ring(7, color)), name]));
  entries.push([sign(ring(5, "--quiet", 2.5)), "not known"], [sign(line("--wall")), "wall"]);
  if (source.obstacles.length > 0) entries.push([sign(square(layout.obstacle_color)), "obstacle"]);
  if (layout.species.some((each) => each.smells.length > 0)) entries.push([sign(["circle", { r: 8, fill: "--quiet", opacity: 0.35 }]), "where it is smelled"]);
  if (arena.marked.size > 0) entries.push([sign(disc(4, BODY), ring(7, "--branch")), "of the chosen branch of the tree"]);
  if (arena.picked.size > 0) entries.push([sign(disc(4, BODY), ring(7, "--picked")), "picked out by filter or rectangle; at most 20 have trails and rays"]);
  if (!chosen) return entries;
  entries.push([sign(disc(4, BODY), ring(7, "--mark")), "chosen agent"], [sign(disc(4, BODY), ring(7, "--kin")), "its near kin"]);
  if (arena.showRays) entries.push([sign(line("--wall"), ["circle", { cx: 7, cy: -4, r: 2.2, fill: "--wall" }]), "ray, in the color of what it sees"]);
  if (arena.showTrail) entries.push([sign(["path", { d: "M-8 5 Q-2 -8 2 0 T8 -5", fill: "none", stroke: "--mark", "stroke-width": 1.6 }]), "where it came from"]);
  if (layout.species.some((each) => each.smells.length > 0)) entries.push([sign(disc(2.5, "--mark")), "nose"]);
  return entries;
}

export class Legend {
  private readonly host = by<HTMLDivElement>("legend");
  private readonly scale = element("div", { class: "scale" });
  private readonly folded = element("details");
  private readonly list = element("ul");
  private shown = "";

  constructor() {
    this.folded.append(element("summary", { text: "All signs" }), this.list);
    this.folded.open = matchMedia("(min-width: 761px)").matches;
    this.host.replaceChildren(this.scale, this.folded);
  }

  update(source: Source, arena: Arena, coloring: Coloring, legend: Painted["legend"], chosen: boolean): void {
    const key = [source.layout.types, source.obstacles.length, coloring.name, coloring.label, legend.low, legend.high, chosen, arena.showRays, arena.showTrail, arena.marked.size > 0, arena.picked.size > 0].join();
    if (key === this.shown) return;
    this.shown = key;
    this.scale.replaceChildren(element("strong", { text: `Color: ${coloring.label}` }), ...this.colors(source, coloring, legend));
    this.list.replaceChildren(...signs(source, arena, chosen).map(([each, text]) => element("li", {}, each, ` ${text}`)));
  }

  private colors(source: Source, coloring: Coloring, { low, high, stops }: Painted["legend"]): Node[] {
    if (coloring.scale === "ramp" || coloring.scale === "diverging") {
      const bar = element("i", { class: "ramp" });
      bar.style.background = `linear-gradient(90deg, ${stops.join(", ")})`;
      const end = coloring.ends ? " and more" : "";
      return [element("span", {}, `${show(low)}${low < 0 ? " and less" : ""} `, bar, ` ${show(high)}${end}`)];
    }
    const { foods, species, meals } = source.layout;
    const key = coloring.scale === "food" ? [...foods, ...species].filter(({ name }) => meals.includes(name)) : (coloring.key ?? []);
    return key.map(({ name, color }) => element("span", {}, sign(disc(5.5, color)), ` ${name}`));
  }
}
