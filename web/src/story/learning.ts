// Scene 2: the creature learns by itself. Shows its meals over time, and its path before and after learning.
import { counted, fixed, show, styleColor } from "../element";
import { Chart } from "./chart";
import { ONE_COLOR } from "./creature";
import { bindGuess } from "./guess";
import { bindKnobs } from "./knob";
import recorded from "./recorded.json";
import { openStage, type Scene, type Worlds } from "./scene";
import { Stage } from "./stage";

const ROUNDS = 80; // windows with learning
const PRINTED = [5, 20, 40, 60, 80]; // the last rounds of each row on the handout
const MEAL = "food.normal.gene.initial_mean";
const MOVING = "genome.action.initial_mean";
const PATH = 500; // length of a path [steps]
const FEW = 5; // the answer compares this many rounds at the start and at the end

export function learning(section: HTMLElement, worlds: Worlds): Scene {
  const stage = new Stage(section, worlds.learning!, { scene: "learning", speed: 2, coloring: ONE_COLOR, chosen: 0, threads: 1, trace: true });
  const window = stage.world.layout.window;
  const steps = ROUNDS * window;
  const chart = new Chart(section.querySelector("canvas.chart")!, { low: 0, high: ROUNDS, label: "rounds of learning" }, { low: 0, high: 40, label: "meals / 1,000 steps" });
  const guess = bindGuess(section);
  const run = section.querySelector<HTMLButtonElement>("#learning-run")!;
  let meals: number[] = [0]; // cumulative meals at the end of each round
  let path: number[] = []; // x, y of every step at the start and at the end
  let turn = 0; // number of worlds begun
  let lastPace = NaN; // speed on the path that ends with the last round [u/step]

  /** Meals per 1,000 steps between two rounds. */
  const rate = (from: number, to: number): number => (1000 * (meals[to]! - meals[from]!)) / ((to - from) * window);
  const draw = () => {
    const rounds = meals.length - 1;
    const points = Array.from({ length: Math.max(rounds - 1, 0) }, (_, i): [number, number] => [i + 2, rate(i, i + 2)]);
    chart.y.high = Math.max(40, ...points.map(([, y]) => y));
    chart.x.high = Math.max(ROUNDS, rounds);
    chart.begin();
    chart.line(points, styleColor("--mark"));
  };
  /** Mean speed on a part of the path [u/step]. */
  const pace = (from: number, to: number): number => {
    let way = 0;
    for (let i = from + 2; i + 1 < to; i += 2) way += Math.hypot(path[i]! - path[i - 2]!, path[i + 1]! - path[i - 1]!);
    return (2 * way) / (to - from);
  };
  const answer = () => {
    const [before, after] = [meals[FEW]!, meals[ROUNDS]! - meals[ROUNDS - FEW]!];
    const ate = (count: number) => (count === 0 ? "nothing" : counted(count, "meal"));
    const times = after / before;
    const more = before > 0 && times > 1 ? `: ${show(times, times < 10 ? 1 : 0)} times as many` : "";
    const hurts = stage.value(MOVING) < 0;
    const guessed = guess.value() && !hurts ? ` You guessed ${guess.value()} times.` : "";
    const moves = `It moves ${fixed(lastPace)} units per step, at first ${fixed(pace(0, 2 * PATH))}.`;
    const moral = hurts ? " It learned what felt good to it. That need not be good for it." : "";
    guess.answer(`It ate ${ate(before)} in its first ${FEW} rounds and ${ate(after)} in its last ${FEW}${more}.${guessed} ${moves}${moral}`);
  };

  stage.onBegin = () => {
    [meals, path, lastPace] = [[0], [], NaN];
    turn++;
    guess.answer("");
  };
  stage.onMoment = ({ frame, ends, trace }) => {
    for (const end of ends) meals[end.step / window] = end.meals[0]!;
    for (let i = 0; i < trace.length; i += 2) {
      path.push(trace[i]!, trace[i + 1]!);
      if (path.length > 4 * PATH) path.splice(2 * PATH, 2);
      if (frame.step - (trace.length - i) / 2 + 1 === steps) lastPace = pace(2 * PATH, path.length);
    }
  };
  stage.onPicture = () => {
    const line = (from: number, to: number, color: string, width: number) => {
      const { ink } = stage;
      ink.beginPath();
      for (let i = from; i + 1 < to; i += 2) ink.lineTo(...stage.at(path[i]!, path[i + 1]!));
      [ink.strokeStyle, ink.lineWidth, ink.lineJoin] = [color, width, "round"];
      ink.stroke();
    };
    line(0, Math.min(2 * PATH, path.length), styleColor("--before"), 2);
    if (path.length > 2 * PATH) line(2 * PATH, path.length, styleColor("--mark"), 2);
  };
  stage.onWords = () => {
    draw();
    const round = Math.min(Math.floor(stage.live.last / window), ROUNDS);
    run.textContent = stage.running ? `Learning: round ${round} of ${ROUNDS}` : stage.live.last >= steps ? "Again, with other luck" : "Let it learn";
    run.setAttribute("aria-disabled", String(stage.running)); // unlike `disabled`, this keeps the focus
    if (meals.length > ROUNDS) answer();
  };
  const learn = async () => {
    if (stage.running) return;
    if (stage.live.last >= steps) stage.begin(stage.seed + 1);
    const thisTurn = turn;
    await stage.runTo(steps);
    if (thisTurn === turn && stage.live.last >= steps) stage.setPlaying(true);
  };
  run.addEventListener("click", () => void learn());
  const read = bindKnobs(section, stage, () => stage.begin());
  section.querySelector("#learning-sit")!.addEventListener("click", () => {
    stage.stop();
    stage.set([MOVING], "-10");
    read();
    stage.begin(1);
    void learn();
  });
  Object.assign(stage, { rate, pace: () => pace(2 * PATH, path.length) }); // for the browser's console, and for tests
  return {
    section,
    stage,
    numbers: () => {
      const own = meals.length > ROUNDS && { meal: stage.value(MEAL), moving: stage.value(MOVING), rates: PRINTED.map((last) => rate(last - FEW, last)) };
      const shown = own ? [own] : recorded.learning;
      const head = ["rounds", ...shown.map(({ meal, moving }) => `meal ${show(meal)}, moving ${show(moving)}`)];
      const rows = PRINTED.map((last, i) => [`${last - FEW + 1}–${last}`, ...shown.map(({ rates }) => fixed(rates[i]!, 1))]);
      return { caption: `Meals per 1,000 steps of ${own ? "your creature" : "two recorded creatures"}, and what a meal and moving felt like:`, head, rows };
    },
    open: (place) => openStage(stage, place, read),
  };
}
