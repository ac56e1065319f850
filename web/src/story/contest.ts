// Scene 5: the reader's feelings against evolution's, in one arena; how many worlds of several each wins.
import type { Coloring } from "../color";
import { show, styleColor } from "../element";
import { Chart } from "./chart";
import evidence from "./evidence.json";
import { bindKnobs } from "./knob";
import { openStage, type Scene, type Worlds } from "./scene";
import { Stage } from "./stage";

const STEPS = 20_480;
const MORE = 4; // worlds besides the first
const PIECE = 256; // steps between two looks at a world that runs
const [BLUE, ORANGE] = [0, 3]; // their places among the distinct colors
const FEELINGS = ["species.blue.reward.meal_coef", "species.blue.genome.action.initial_mean"];

/** The chance that a fair coin falls heads at least `wins` times of `worlds`. */
export function luck(wins: number, worlds: number): number {
  let [sum, ways] = [0, 1]; // ways to choose i of the worlds
  for (let i = 0; i <= worlds; i++) {
    if (i >= wins) sum += ways;
    ways = (ways * (worlds - i)) / (i + 1);
  }
  return sum / 2 ** worlds;
}

export function contest(section: HTMLElement, worlds: Worlds): Scene {
  const coloring: Coloring = { name: "side", label: "side", scale: "distinct", value: (_, frame, i) => (frame.species[i] === 0 ? BLUE : ORANGE) };
  const stage = new Stage(section, worlds.contest!, { scene: "contest", speed: 4, coloring });
  const most = stage.value("species.blue.population.capacity");
  const lines = new Chart(section.querySelector("#contest-lines")!, { low: 0, high: STEPS, label: "steps" }, { low: 0, high: most, label: "alive" });
  const { surface } = evidence;
  const range = { low: surface.low, high: surface.high };
  const map = new Chart(section.querySelector("#contest-map")!, { ...range, label: "a meal feels like" }, { ...range, label: "moving feels like" });
  const score = section.querySelector<HTMLElement>("#contest-score")!;
  const buttons = ["one", "more"].map((name) => section.querySelector<HTMLButtonElement>(`#contest-${name}`)!);
  let course: [number, number, number][] = []; // step, blue, orange
  let results: [number, number][] = []; // blue and orange at the end of each world
  let busy = false;

  stage.onBegin = () => (course = []);
  stage.onMoment = ({ frame }) => {
    const blue = frame.species.reduce((sum, each) => sum + (each === 0 ? 1 : 0), 0);
    if (frame.step > (course[course.length - 1]?.[0] ?? -1)) course.push([frame.step, blue, frame.id.length - blue]);
  };
  stage.onWords = () => {
    const [blue, orange] = [styleColor("--blue"), styleColor("--orange")];
    lines.begin();
    lines.line(course.map(([step, count]) => [step, count]), blue);
    lines.line(course.map(([step, , count]) => [step, count]), orange);
    for (const each of buttons) each.disabled = busy;
    buttons[1]!.disabled ||= results.length === 0;
    if (results.length > 0) drawMap();
    const running = busy ? `World ${results.length + 1}: step ${show(stage.live.last)} of ${show(STEPS)}. ` : "";
    score.textContent = running + verdict(results) || "No world yet.";
  };
  const drawMap = () => {
    map.canvas.hidden = false;
    map.begin();
    const { value } = surface;
    const side = (surface.high - surface.low) / value.length;
    const top = Math.max(...value.flat());
    value.forEach((row, a) =>
      row.forEach((fit, f) => {
        const light = Math.round(12 + (76 * Math.max(fit, 0)) / top);
        const [x, y] = [surface.low + f * side, surface.low + a * side];
        map.box(x, y, x + side, y + side, `hsl(260 45% ${light}%)`);
      }),
    );
    const place = (x: number, y: number): [number, number] => [clip(x), clip(y)];
    const clip = (each: number) => Math.min(Math.max(each, surface.low), surface.high);
    const mark = (words: string, x: number, y: number, color: string) => {
      const [px, py] = place(x, y);
      map.dot(px, py, "#ffffff", 8);
      map.dot(px, py, color, 6);
      map.text(words, px + (px > 4 ? -0.6 : 0.6), py + 0.3, "#ffffff", px > 4 ? "right" : "left");
    };
    mark("evolution", stage.value("species.orange.reward.meal_coef"), stage.value("species.orange.genome.action.initial_mean"), styleColor("--orange"));
    mark("you", stage.value(FEELINGS[0]!), stage.value(FEELINGS[1]!), styleColor("--blue"));
  };
  const some = async (count: number) => {
    busy = true;
    for (let i = 0; i < count; i++) {
      if (stage.live.last > 0) stage.begin(stage.seed + 1);
      while (stage.live.last < STEPS && !stage.live.over && !stage.live.error) await stage.runTo(Math.min(stage.live.last + PIECE, STEPS));
      const end = course[course.length - 1];
      if (end && !stage.live.error) results.push([end[1], end[2]]);
    }
    busy = false;
  };
  const clear = () => {
    results = [];
    busy = false;
    map.canvas.hidden = true;
  };
  buttons[0]!.addEventListener("click", () => {
    clear();
    stage.begin(1);
    void some(1);
  });
  buttons[1]!.addEventListener("click", () => void some(MORE));
  const read = bindKnobs(section, stage, () => {
    clear();
    stage.begin(1);
  });
  section.addEventListener("reset", clear);
  Object.assign(stage, { results: () => results, luck });
  return {
    section,
    stage,
    open: async (place) => {
      clear();
      await openStage(stage, place);
      read();
      const end = course[course.length - 1];
      if (end && stage.live.last >= STEPS) results = [[end[1], end[2]]];
    },
  };
}

function verdict(results: [number, number][]): string {
  if (results.length === 0) return "";
  const [blue, orange] = results[results.length - 1]!;
  const last = `Blue ${blue}, orange ${orange}: ${blue > orange ? "you win" : blue < orange ? "evolution wins" : "a draw"}.`;
  if (results.length === 1) return last;
  const decided = results.filter(([a, b]) => a !== b);
  const wins = decided.filter(([a, b]) => a > b).length;
  const better = wins * 2 >= decided.length;
  const chance = better ? luck(wins, decided.length) : luck(decided.length - wins, decided.length);
  return `${last} You win ${wins} of ${decided.length} worlds. Equal feelings would do ${better ? "as well or better" : "as badly or worse"} by luck in ${show(100 * chance, 0)} of 100 tries.`;
}
