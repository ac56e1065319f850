// After the last scene: other worlds to change, with pictures, videos, configs and links of them.
import { type Coloring, ramp } from "../color";
import { save } from "../csv";
import { by, styleColor } from "../element";
import { configFile } from "../settings";
import { Chart } from "./chart";
import { bindKnobs } from "./knob";
import { openStage, type Scene, type Worlds } from "./scene";
import { Stage } from "./stage";

const VIDEO_MS = 8000; // length of a video
const PICTURE_WIDTH = 1600; // minimum width of a picture [pixel]
const APART = 16; // steps between two points of the chart
const ABOUT: Record<string, string> = {
  predators: "Predators (ringed) eat prey. Both learn, and what the sight of the other feels like evolves.",
  poison: "Violet food costs energy. Poison can even feel good to a newborn.",
  seasons: "A year has 8,192 steps. Food grows twice as fast in summer, about step 2,048, and not at all in winter, about 6,144.",
  pitfalls: "Triangles hurt all that touch them.",
};

export function sandbox(section: HTMLElement, worlds: Worlds): Scene {
  const coloring: Coloring = { name: "energy", label: "energy", scale: "ramp", low: 0, value: (_, frame, i) => frame.energy[i]! };
  const stage = new Stage(section, worlds.predators!, { scene: "sandbox", autoplay: true, speed: 2, coloring });
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
  stage.onBegin = () => {
    course = [];
    stage.notes.set("world", name);
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
  by("sandbox-scale").style.background = `linear-gradient(to right, ${[0, 0.25, 0.5, 0.75, 1].map((share) => ramp(share, 1)).join()})`;
  section.querySelector("#sandbox-picture")!.addEventListener("click", () => {
    stage.ensure();
    const { scene } = stage.arena;
    const draw = () => stage.arena.draw(stage.live, stage.frame, coloring, stage.chosen);
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
      await openStage(stage, place, read);
    },
  };
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
