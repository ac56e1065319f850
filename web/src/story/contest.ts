// Scene 5: the reader's feelings compete with evolution's in one arena. The side with more descendants wins, in one world or several.
import type { Coloring } from "../color";
import { element, show, styleColor } from "../element";
import { saveResult } from "./card";
import { Chart } from "./chart";
import evidence from "./evidence.json";
import { bindKnobs } from "./knob";
import { openStage, type Scene, type Worlds } from "./scene";
import { Stage } from "./stage";

const STEPS = 20_480;
const MORE = 4; // worlds besides the first
const FITTEST = Math.max(...evidence.surface.value.flat());
const [TEAL, PURPLE] = [7, 8]; // indices of distinct colors that no feeling has
const LEAST = 40; // the plot's axis reaches at least this many descendants
const SPAN = 8; // range of a feeling, on the sliders and on the map
const FEELINGS = ["species.you.reward.meal_coef", "species.you.genome.action.initial_mean"];

/** The number of descendants each side has had by the end of a world. */
interface End {
  seed: number;
  you: number;
  evolution: number;
}

/** The probability that a fair coin lands heads at least `wins` times in `worlds` tosses. */
export function luck(wins: number, worlds: number): number {
  let [sum, ways] = [0, 1]; // the number of ways to choose i of the worlds
  for (let i = 0; i <= worlds; i++) {
    if (i >= wins) sum += ways;
    ways = (ways * (worlds - i)) / (i + 1);
  }
  return sum / 2 ** worlds;
}

export function contest(section: HTMLElement, worlds: Worlds): Scene {
  const coloring: Coloring = { name: "side", label: "side", scale: "distinct", value: (_, frame, i) => (frame.species[i] === 0 ? TEAL : PURPLE) };
  const stage = new Stage(section, worlds.contest!, { scene: "contest", speed: 4, coloring });
  const lines = new Chart(section.querySelector("#contest-lines")!, { low: 0, high: STEPS, label: "steps" }, { low: 0, high: LEAST, label: "descendants" });
  stage.arena.rings = false; // the sides differ only in color
  stage.play.hidden = true; // every world here counts: Begin runs it to its end, unless Reset stops it
  const range = { low: -SPAN, high: SPAN };
  const map = new Chart(section.querySelector("#contest-map")!, { ...range, label: "a meal feels like" }, { ...range, label: "moving feels like" });
  const measured = section.querySelector<HTMLElement>("#contest-measured")!; // the map with its text, shown after the first result
  const score = section.querySelector<HTMLElement>("#contest-score")!;
  const table = section.querySelector("table")!;
  const share = section.querySelector<HTMLButtonElement>("#contest-picture")!;
  const buttons = ["one", "more"].map((name) => section.querySelector<HTMLButtonElement>(`#contest-${name}`)!);
  let course: [number, number, number][] = []; // step, your descendants, evolution's
  let results: End[] = [];
  let busy = false;
  let turn = 0; // incremented when worlds begin or are discarded, so that code waiting for an earlier world stops

  stage.onBegin = () => (course = []);
  stage.onMoment = ({ frame }) => {
    if (frame.step <= (course[course.length - 1]?.[0] ?? -1)) return;
    const born = [0, 0];
    for (const { parent, species } of stage.live.lives.all()) if (parent >= 0) born[species]!++;
    course.push([frame.step, born[0]!, born[1]!]);
  };
  const able = () => {
    buttons[0]!.setAttribute("aria-disabled", String(busy)); // unlike `disabled`, this keeps the focus
    buttons[1]!.setAttribute("aria-disabled", String(busy || results.length === 0));
  };
  stage.onWords = () => {
    const [yours, its] = [styleColor("--you"), styleColor("--evolution")];
    lines.x.high = Math.max(STEPS, stage.live.last); // a link may lead further
    lines.y.high = Math.max(LEAST, ...course.map(([, ...born]) => Math.max(...born)));
    lines.begin();
    lines.line(course.map(([step, count]) => [step, count]), yours);
    lines.line(course.map(([step, , count]) => [step, count]), its);
    able();
    if (results.length > 0) measured.hidden = false;
    if (!measured.hidden) drawMap();
    const running = stage.running ? `World of seed ${stage.seed}: step ${show(stage.live.last)} of ${show(stage.aim)}. ` : "";
    score.textContent = running + verdict(results) || "No world yet.";
    table.hidden = share.hidden = results.length === 0;
    const cells = ({ seed, you, evolution }: End) => [seed, you, evolution].map((value) => element("td", { text: String(value) }));
    table.tBodies[0]!.replaceChildren(...results.map((end) => element("tr", {}, ...cells(end))));
  };
  const drawMap = () => {
    map.begin();
    const { value, low, high } = evidence.surface;
    const step = (high - low) / (value.length - 1); // between two grid points of the fitted surface
    const edge = (i: number) => Math.min(Math.max(low + (i - 0.5) * step, -SPAN), SPAN);
    value.forEach((row, a) =>
      row.forEach((fit, f) => map.box(edge(f), edge(a), edge(f + 1), edge(a + 1), `hsl(260 45% ${Math.round(12 + (76 * Math.max(fit, 0)) / FITTEST)}%)`)),
    );
    const evolution = [stage.value("species.evolution.reward.meal_coef"), stage.value("species.evolution.genome.action.initial_mean")] as const;
    const you = [stage.value(FEELINGS[0]!), stage.value(FEELINGS[1]!)] as const;
    const left = you[0] < evolution[0]; // so that their names point away from each other
    map.named("evolution", ...evolution, styleColor("--evolution"), left ? "right" : "left");
    map.named("you", ...you, styleColor("--you"), left ? "left" : "right");
  };
  const some = async (count: number) => {
    const thisTurn = ++turn;
    busy = true;
    able();
    for (let i = 0; i < count; i++) {
      if (stage.live.last > 0) stage.begin(stage.seed + 1);
      await stage.runTo(STEPS);
      if (thisTurn !== turn) return;
      note();
    }
    busy = false;
  };
  /** Records the result of the world if it has ended. */
  const note = () => {
    const end = course[course.length - 1];
    if (end && !stage.live.error && (stage.live.last >= STEPS || stage.live.over)) results.push({ seed: stage.seed, you: end[1], evolution: end[2] });
  };
  const clear = () => {
    turn++;
    results = [];
    busy = false;
  };
  const play = () => {
    clear();
    stage.begin(1);
    stage.host.querySelector(".view")!.scrollIntoView({ block: "nearest" }); // on a phone the arena is below the button
    void some(1);
  };
  buttons[0]!.addEventListener("click", () => busy || play());
  buttons[1]!.addEventListener("click", () => busy || results.length === 0 || void some(MORE));
  const read = bindKnobs(section, stage, () => {
    clear();
    stage.begin(1);
  });
  map.canvas.addEventListener("click", (event) => {
    map.place(event).forEach((value, i) => {
      const knob = section.querySelector<HTMLInputElement>(`input[data-path="${FEELINGS[i]}"]`)!;
      knob.value = String(value); // the slider takes the nearest value it has
      stage.set([FEELINGS[i]!], knob.value);
    });
    read();
    play();
  });
  share.addEventListener("click", () => {
    const [won, lost] = tally(results);
    const headline = won > lost ? `I beat evolution ${won} : ${lost}` : won < lost ? `Evolution beat me ${lost} : ${won}` : `I drew with evolution, ${won} : ${lost}`;
    saveResult(headline, [stage.arena.scene.canvas, map.canvas]);
  });
  section.addEventListener("reset", () => {
    clear();
    measured.hidden = true; // the next reader guesses too
  });
  section.querySelector("#contest-top")!.textContent = show(FITTEST, 1);
  Object.assign(stage, { results: () => results, course: () => course, luck });
  return {
    section,
    stage,
    numbers: () => {
      const played = results.length > 0;
      const [meal, moving] = FEELINGS.map((path) => (played ? show(stage.value(path)) : "____"));
      const blank = Array.from({ length: 1 + MORE }, (_, i) => [String(i + 1), "", ""]);
      const rows = played ? results.map(({ seed, you, evolution }) => [seed, you, evolution].map(String)) : blank;
      return { caption: `Descendants if a meal feels like ${meal} and moving like ${moving} to your half:`, head: ["seed", "you", "evolution"], rows };
    },
    open: async (place) => {
      clear();
      const thisTurn = turn;
      await openStage(stage, place, read);
      if (thisTurn === turn) note();
    },
  };
}

/** How the last world ended, and the probability that a fair coin does as well in the worlds that had a winner. */
function verdict(results: End[]): string {
  if (results.length === 0) return "";
  const { you, evolution } = results[results.length - 1]!;
  const last = `You have ${you} descendants, evolution ${evolution}: ${you > evolution ? "you win" : you < evolution ? "evolution wins" : "a draw"}.`;
  if (results.length === 1) return last;
  const [won, lost] = tally(results);
  const counts = `${last} ${won} won, ${lost} lost, ${results.length - won - lost} drawn.`;
  if (won + lost === 0) return counts;
  const chance = 100 * luck(Math.max(won, lost), won + lost);
  return `${counts} A coin does that or ${won >= lost ? "better" : "worse"} in ${chance < 1 ? "less than 1" : show(chance, 0)} of 100 tries.`;
}

/** The numbers of worlds won by the reader and by evolution. */
const tally = (results: End[]): [number, number] => [results.filter((end) => end.you > end.evolution).length, results.filter((end) => end.you < end.evolution).length];
