// Scene 5: the reader's feelings compete with evolution's in one arena. The side with more descendants wins, in one world or several.
import type { Coloring } from "../color";
import { counted, element, show, styleColor } from "../element";
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

  stage.onBegin = () => {
    course = [];
    if (results.length > 0) stage.notes.set("worlds", String(results.length + 1)); // for the link: earlier worlds count too
  };
  stage.onMoment = ({ frame }) => {
    if (frame.step <= (course[course.length - 1]?.[0] ?? -1)) return;
    const born = [0, 0];
    for (const { parent, species } of stage.live.lives.all()) if (parent >= 0) born[species]!++;
    course.push([frame.step, born[0]!, born[1]!]);
  };
  const able = () => {
    buttons[0]!.setAttribute("aria-disabled", String(busy)); // unlike `disabled`, this keeps the focus
    buttons[1]!.setAttribute("aria-disabled", String(busy || stage.running || results.length === 0));
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
    const [, you, evolution] = course[course.length - 1] ?? [0, 0, 0];
    const running = stage.running ? `World ${stage.seed}, step ${show(stage.live.last)} of ${show(stage.aim)}: you have ${you} descendants, evolution ${evolution}. ` : "";
    score.textContent = running + verdict(results, stage.running) || "No world yet.";
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
    stage.notes.delete("worlds");
    results = [];
    busy = false;
  };
  const play = () => {
    clear();
    stage.begin(1);
    const view = stage.host.querySelector(".view")!;
    (view.getBoundingClientRect().top < 0 ? view : score).scrollIntoView({ block: "nearest" }); // so that both are on a phone's screen
    void some(1);
  };
  buttons[0]!.addEventListener("click", () => busy || play());
  buttons[1]!.addEventListener("click", () => busy || stage.running || results.length === 0 || void some(MORE));
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
    const [meal, moving] = FEELINGS.map((path) => show(stage.value(path)));
    const about = `To my creatures, teal, a meal feels like ${meal} and moving like ${moving}.`;
    saveResult(headline(results, "I", "me"), about, [stage.arena.scene.canvas, map.canvas]);
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
      return { caption: `Descendants if a meal feels like ${meal} and moving like ${moving} to your half:`, head: ["world", "you", "evolution"], rows };
    },
    open: async (place) => {
      clear();
      const thisTurn = turn;
      const last = place.seed ?? stage.first;
      const worlds = Math.max(Math.min(Number(place.notes.get("worlds") ?? 1), last), 1);
      for (let seed = last - worlds + 1; seed <= last; seed++) {
        await openStage(stage, seed < last ? { ...place, seed, step: STEPS, digest: "" } : place, read);
        if (thisTurn !== turn) return;
        note();
      }
    },
  };
}

/** How the last world ended, unless the next one runs already, the score, and how likely a fair coin reaches it. */
function verdict(results: End[], running: boolean): string {
  const end = results[results.length - 1];
  if (!end) return "";
  const last = running ? "" : `World ${end.seed}: you have ${end.you} descendants, evolution ${end.evolution}. `;
  const [won, lost] = tally(results);
  const drawn = results.length - won - lost;
  const score = `${last}${headline(results, "You", "you")}${drawn > 0 && results.length > 1 ? `, with ${counted(drawn, "draw")}` : ""}.`;
  if (results.length === 1 && !running) return `${score} One world may be luck.`;
  if (results.length === 1 || won + lost === 0) return score;
  const chance = 100 * luck(Math.max(won, lost), won + lost);
  return `${score} A coin does as ${won >= lost ? "well or better" : "badly or worse"} in ${chance < 1 ? "less than 1" : show(chance, 0)} of 100 tries.`;
}

/** The score in words: with "I" and "me" for a picture, with "You" and "you" for the page. */
function headline(results: End[], subject: string, object: string): string {
  const [won, lost] = tally(results);
  if (won === lost) return `${subject} drew with evolution, ${won} : ${lost}`;
  return won > lost ? `${subject} beat evolution ${won} : ${lost}` : `Evolution beat ${object} ${lost} : ${won}`;
}

/** The numbers of worlds won by the reader and by evolution. */
const tally = (results: End[]): [number, number] => [results.filter((end) => end.you > end.evolution).length, results.filter((end) => end.you < end.evolution).length];
