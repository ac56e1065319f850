// After the last scene: other worlds to change, with pictures, videos, configs and links of them.
import { type Coloring, diverging, ramp } from "../color";
import { save } from "../csv";
import { by, element, option, styleColor } from "../element";
import { configFile } from "../settings";
import { Chart } from "./chart";
import { bindKnobs } from "./knob";
import { openStage, type Scene, type Worlds } from "./scene";
import { Stage } from "./stage";

const VIDEO_MS = 8000; // length of a video
const PICTURE_WIDTH = 1600; // minimum width of a picture [pixel]
const APART = 16; // steps between two points of the chart
const COLORED = 0.5; // feelings at and beyond this value have the same color
const [FOOD, MOVING] = ["food.normal.gene.initial_mean", "genome.action.initial_mean"];
const STOPS = [0, 0.25, 0.5, 0.75, 1]; // of a color scale
const ABOUT: Record<string, string> = {
  predators: "Predators (ringed) eat prey. Both learn, and what the sight of the other feels like evolves.",
  poison: "Violet food costs energy. Poison can even feel good to a newborn.",
  seasons: "A year has 8,192 steps. Food grows twice as fast in summer, about step 2,048, and not at all in winter, about 6,144.",
  pitfalls: "Triangles hurt all that touch them.",
};

export function sandbox(section: HTMLElement, worlds: Worlds): Scene {
  const feeling = (name: string, label: string, gene: (species: number) => number): Coloring => ({
    name, label, scale: "diverging", low: -COLORED, high: COLORED, value: (life) => life?.genome[gene(life.species)] ?? NaN,
  });
  const colorings: [Coloring, ...Coloring[]] = [
    { name: "energy", label: "energy", scale: "ramp", low: 0, value: (_, frame, i) => frame.energy[i]! },
    feeling("food", "how its food feels", (species) => stage.world.layout.species[species]!.reward.meals[0]!.gene),
    feeling("moving", "how moving feels", () => stage.world.layout.genes.findIndex(({ input }) => input === "action")),
  ];
  const stage: Stage = new Stage(section, worlds.predators!, { scene: "sandbox", autoplay: true, speed: 2, coloring: colorings[0] });
  stage.arena.ringColor = "--ink"; // a predator's own color is too close to amber
  const chart = new Chart(section.querySelector("canvas.chart")!, { low: 0, high: 1000, label: "steps" }, { low: 0, high: 10, label: "alive (gray: food)" });
  const reads: (() => void)[] = [];
  let course: [step: number, food: number, ...alive: number[]][] = [];
  let name = "predators";

  const choose = (next: string) => {
    name = next;
    stage.world = worlds[name]!;
    for (const each of section.querySelectorAll<HTMLElement>("button[data-world]")) each.setAttribute("aria-pressed", String(each.dataset.world === name));
    for (const each of section.querySelectorAll<HTMLElement>(".knobs")) each.hidden = each.dataset.world !== name;
    section.querySelector("#sandbox-about")!.textContent = ABOUT[name]!;
  };
  const select = section.querySelector<HTMLSelectElement>("#sandbox-color")!;
  const color = (next: string) => {
    const coloring = colorings.find((each) => each.name === next) ?? colorings[0];
    const feels = coloring.scale === "diverging";
    const [low, high] = feels ? ["bad (blue)", "good (orange)"] : ["little (blue)", "much (amber)"];
    [by("sandbox-low").textContent, by("sandbox-high").textContent] = [low, high];
    const stops = STOPS.map((share) => (feels ? diverging(2 * share - 1, 1) : ramp(share, 1)));
    by("sandbox-scale").style.background = `linear-gradient(to right, ${stops.join()})`;
    select.value = coloring.name;
    stage.camera.coloring = coloring;
    stage.notes.set("color", coloring.name);
  };
  stage.onBegin = () => {
    course = [];
    stage.notes.set("world", name);
    color(select.value);
  };
  stage.onMoment = ({ frame: { step, species, foodX } }) => {
    const last = course[course.length - 1]?.[0];
    if (last !== undefined && step < last + APART) return;
    const alive = stage.world.layout.species.map((_, s) => species.reduce((sum, each) => sum + (each === s ? 1 : 0), 0));
    course.push([step, foodX.length, ...alive]);
  };
  stage.onWords = () => {
    chart.x.high = Math.max(1000, stage.live.last);
    chart.y.high = course.reduce((most, [, ...counts]) => Math.max(most, ...counts), 10);
    chart.begin();
    stage.world.layout.species.forEach((_, s) => chart.line(course.map((row) => [row[0], row[s + 2]!]), styleColor(s === 0 ? "--blue" : "--orange")));
    chart.line(course.map(([step, food]) => [step, food]), styleColor("--before"), 1);
  };
  for (const box of section.querySelectorAll<HTMLElement>(".knobs")) {
    choose(box.dataset.world!);
    const paths = [FOOD, MOVING].map((path) => founderPaths(stage, path!));
    box.append(feelingKnob("to founders, food feels like", paths[0]!), feelingKnob("to founders, moving feels like", paths[1]!));
    reads.push(bindKnobs(box, stage, () => stage.begin()));
  }
  choose("predators");
  const read = () => reads[Object.keys(ABOUT).indexOf(name)]!();
  for (const each of section.querySelectorAll<HTMLElement>("button[data-world]")) {
    each.addEventListener("click", () => {
      choose(each.dataset.world!);
      stage.changes.clear();
      read();
      stage.begin(1);
      stage.setPlaying(true);
    });
  }
  section.addEventListener("reset", read);
  select.append(...colorings.map((each) => option(each.name, each.label)));
  select.addEventListener("change", () => color(select.value));
  color("energy");
  section.querySelector("#sandbox-picture")!.addEventListener("click", () => {
    stage.ensure();
    const { scene } = stage.arena;
    const draw = () => stage.arena.draw(stage.live, stage.frame, stage.camera.coloring, stage.chosen);
    scene.enlarged = Math.max(1, PICTURE_WIDTH / scene.canvas.width);
    draw();
    scene.canvas.toBlob((blob) => blob && save(`${name}.png`, blob)); // of the current moment
    scene.enlarged = 1;
    draw();
  });
  section.querySelector("#sandbox-config")!.addEventListener("click", () => save(`${name}.toml`, configFile(stage.world, stage.changes)));
  bindVideo(section.querySelector("#sandbox-video")!, stage, () => name);
  Object.assign(stage, { choose, course: () => course });
  return {
    section,
    stage,
    open: async (place) => {
      const next = place.notes.get("world") ?? "predators";
      if (!Object.hasOwn(ABOUT, next)) throw new Error(`it names the world '${next}': there are ${Object.keys(ABOUT).join(", ")}`);
      choose(next);
      color(place.notes.get("color") ?? "energy");
      await openStage(stage, place, read);
    },
  };
}

/** The paths of a setting of the founders' feelings in this world: one for all, or one for each species. */
function founderPaths({ world }: Stage, path: string): string {
  return world.settings.flatMap((each) => (each.path === path || each.path.endsWith(`.${path}`) ? [each.path] : [])).join(" ");
}

/** A slider for how something feels to founders on average. */
function feelingKnob(label: string, paths: string): HTMLLabelElement {
  const knob = Object.assign(element("input"), { type: "range", min: "-5", max: "5", step: "0.5" });
  knob.dataset.path = paths;
  return element("label", {}, `${label} `, knob, element("output"));
}

function bindVideo(made: HTMLButtonElement, stage: Stage, name: () => string): void {
  if (!("MediaRecorder" in window)) {
    made.hidden = true; // this browser cannot record video
    return;
  }
  made.addEventListener("click", () => {
    stage.ensure();
    const recorder = new MediaRecorder(stage.arena.scene.canvas.captureStream(30));
    const parts: Blob[] = [];
    recorder.ondataavailable = ({ data }) => parts.push(data);
    recorder.onstop = () => {
      save(`${name()}.${recorder.mimeType.includes("mp4") ? "mp4" : "webm"}`, new Blob(parts, { type: recorder.mimeType }));
      [made.disabled, made.textContent] = [false, "Record video"];
    };
    [made.disabled, made.textContent] = [true, "Recording 8 s"];
    stage.setPlaying(true);
    recorder.start();
    setTimeout(() => recorder.stop(), VIDEO_MS);
  });
}
