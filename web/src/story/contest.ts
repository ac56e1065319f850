// Scene 6: the reader's feelings against evolution's, in one arena; how many worlds of several each wins.
import type { Coloring } from "../color";
import { element, show, styleColor } from "../element";
import { Chart } from "./chart";
import evidence from "./evidence.json";
import { bindKnobs } from "./knob";
import { openStage, type Scene, type Worlds } from "./scene";
import { Stage } from "./stage";

const STEPS = 20_480;
const MORE = 4; // worlds besides the first
const FITTEST = Math.max(...evidence.surface.value.flat());
const [BLUE, ORANGE] = [0, 3]; // their places among the distinct colors
const SPAN = 8; // of a feeling, on the sliders and on the map
const FEELINGS = ["species.blue.reward.meal_coef", "species.blue.genome.action.initial_mean"];

interface End {
  seed: number;
  blue: number;
  orange: number;
}

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
  stage.arena.rings = false; // the sides differ by color alone
  stage.play.hidden = true; // a world here is one that counts: Begin runs it to its end, or Reset stops it
  const range = { low: -SPAN, high: SPAN };
  const map = new Chart(section.querySelector("#contest-map")!, { ...range, label: "a meal feels like" }, { ...range, label: "moving feels like" });
  const score = section.querySelector<HTMLElement>("#contest-score")!;
  const table = section.querySelector("table")!;
  const buttons = ["one", "more"].map((name) => section.querySelector<HTMLButtonElement>(`#contest-${name}`)!);
  let course: [number, number, number][] = []; // step, blue, orange
  let results: End[] = []; // how many live at the end of each world
  let busy = false;
  let turn = 0; // how often worlds were begun or forgotten: what waited for a world of an earlier turn stops

  stage.onBegin = () => (course = []);
  stage.onMoment = ({ frame }) => {
    const blue = frame.species.reduce((sum, each) => sum + (each === 0 ? 1 : 0), 0);
    if (frame.step > (course[course.length - 1]?.[0] ?? -1)) course.push([frame.step, blue, frame.id.length - blue]);
  };
  const able = () => {
    buttons[0]!.setAttribute("aria-disabled", String(busy)); // so that it keeps the focus
    buttons[1]!.setAttribute("aria-disabled", String(busy || results.length === 0));
  };
  stage.onWords = () => {
    const [blue, orange] = [styleColor("--blue"), styleColor("--orange")];
    lines.x.high = Math.max(STEPS, stage.live.last); // a link may have gone further
    lines.begin();
    lines.line(course.map(([step, count]) => [step, count]), blue);
    lines.line(course.map(([step, , count]) => [step, count]), orange);
    able();
    if (results.length > 0) drawMap();
    const running = stage.running ? `World of seed ${stage.seed}: step ${show(stage.live.last)} of ${show(stage.aim)}. ` : "";
    score.textContent = running + verdict(results) || "No world yet.";
    table.hidden = results.length === 0;
    const cells = ({ seed, blue, orange }: End) => [seed, blue, orange].map((value) => element("td", { text: String(value) }));
    table.tBodies[0]!.replaceChildren(...results.map((end) => element("tr", {}, ...cells(end))));
  };
  const drawMap = () => {
    map.canvas.hidden = false;
    map.begin();
    const { value, low, high } = evidence.surface;
    const apart = (high - low) / (value.length - 1); // of the points that were measured
    const edge = (i: number) => Math.min(Math.max(low + (i - 0.5) * apart, -SPAN), SPAN);
    value.forEach((row, a) =>
      row.forEach((fit, f) => map.box(edge(f), edge(a), edge(f + 1), edge(a + 1), `hsl(260 45% ${Math.round(12 + (76 * Math.max(fit, 0)) / FITTEST)}%)`)),
    );
    const evolution = [stage.value("species.orange.reward.meal_coef"), stage.value("species.orange.genome.action.initial_mean")] as const;
    const you = [stage.value(FEELINGS[0]!), stage.value(FEELINGS[1]!)] as const;
    const near = Math.abs(you[0] - evolution[0]) < 5 && Math.abs(you[1] - evolution[1]) < 1.2; // so that their names would meet
    map.named("evolution", ...evolution, styleColor("--orange"));
    map.named("you", ...you, styleColor("--blue"), !near ? 0 : you[1] > evolution[1] ? 1 : -1);
  };
  const some = async (count: number) => {
    const own = ++turn;
    busy = true;
    able();
    for (let i = 0; i < count; i++) {
      if (stage.live.last > 0) stage.begin(stage.seed + 1);
      await stage.runTo(STEPS);
      if (own !== turn) return;
      note();
    }
    busy = false;
  };
  /** Keeps how the world ended, if it did. */
  const note = () => {
    const end = course[course.length - 1];
    if (end && !stage.live.error && (stage.live.last >= STEPS || stage.live.over)) results.push({ seed: stage.seed, blue: end[1], orange: end[2] });
  };
  const clear = () => {
    turn++;
    results = [];
    busy = false;
    map.canvas.hidden = true;
  };
  buttons[0]!.addEventListener("click", () => {
    if (busy) return;
    clear();
    stage.begin(1);
    void some(1);
  });
  buttons[1]!.addEventListener("click", () => busy || results.length === 0 || void some(MORE));
  const read = bindKnobs(section, stage, () => {
    clear();
    stage.begin(1);
  });
  section.addEventListener("reset", clear);
  section.querySelector("#contest-top")!.textContent = show(FITTEST, 1);
  Object.assign(stage, { results: () => results, luck });
  return {
    section,
    stage,
    open: async (place) => {
      clear();
      const own = turn;
      await openStage(stage, place, read);
      if (own === turn) note();
    },
  };
}

/** How the last world ended, and what a fair coin would have done in all that somebody won. */
function verdict(results: End[]): string {
  if (results.length === 0) return "";
  const { blue, orange } = results[results.length - 1]!;
  const last = `Blue ${blue}, orange ${orange}: ${blue > orange ? "you win" : blue < orange ? "evolution wins" : "a draw"}.`;
  if (results.length === 1) return last;
  const won = results.filter((end) => end.blue > end.orange).length;
  const lost = results.filter((end) => end.blue < end.orange).length;
  const counts = `${last} ${won} won, ${lost} lost, ${results.length - won - lost} drawn.`;
  if (won + lost === 0) return counts;
  const chance = 100 * luck(Math.max(won, lost), won + lost);
  return `${counts} A coin does that or ${won >= lost ? "better" : "worse"} in ${chance < 1 ? "less than 1" : show(chance, 0)} of 100 tries.`;
}
