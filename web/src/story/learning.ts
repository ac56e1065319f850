// Scene 2: the creature learns by itself; what it eats over time, and its path before and after.
import { show, styleColor } from "../element";
import { Chart } from "./chart";
import { ONE_COLOR } from "./creature";
import { bindGuess } from "./guess";
import { bindKnobs } from "./knob";
import { openStage, type Scene, type Worlds } from "./scene";
import { Stage } from "./stage";

const ROUNDS = 80; // windows with learning
const PATH = 500; // steps of a path
const FIRST = 5; // rounds that "before" is a mean over
const BEFORE_LEAST = 0.2; // meals per 1,000 steps that a ratio is at least taken to

export function learning(section: HTMLElement, worlds: Worlds): Scene {
  const stage = new Stage(section, worlds.learning!, { scene: "learning", speed: 2, coloring: ONE_COLOR, chosen: 0, threads: 1, trace: true });
  const window = stage.world.layout.window;
  const steps = ROUNDS * window;
  const chart = new Chart(section.querySelector("canvas.chart")!, { low: 0, high: ROUNDS, label: "rounds of learning" }, { low: 0, high: 40, label: "meals / 1,000 steps" });
  const guess = bindGuess(section);
  const run = section.querySelector<HTMLButtonElement>("#learning-run")!;
  let meals: [number, number][] = []; // step, meals so far
  let path: number[] = []; // x, y of every step of the first and the last ones

  /** Meals per 1,000 steps between two rounds. */
  const rate = (from: number, to: number): number => {
    const at = (round: number) => meals.findLast(([step]) => step <= round * window) ?? [0, 0];
    const [a, b] = [at(from), at(to)];
    return b[0] > a[0] ? (1000 * (b[1] - a[1])) / (b[0] - a[0]) : 0;
  };
  const draw = () => {
    const rounds = Math.floor(stage.live.last / window);
    const points = Array.from({ length: Math.max(rounds - 1, 0) }, (_, i): [number, number] => [i + 2, rate(i, i + 2)]);
    chart.y.high = Math.max(40, ...points.map(([, y]) => y));
    chart.x.high = Math.max(ROUNDS, rounds);
    chart.begin();
    chart.line(points, styleColor("--mark"));
  };
  /** Units per step on a part of the path. */
  const pace = (from: number, to: number): number => {
    let way = 0;
    for (let i = from + 2; i + 1 < to; i += 2) way += Math.hypot(path[i]! - path[i - 2]!, path[i + 1]! - path[i - 1]!);
    return (2 * way) / (to - from);
  };
  const answer = () => {
    const [before, after] = [rate(0, FIRST), rate(ROUNDS - FIRST, ROUNDS)];
    const times = after / Math.max(before, BEFORE_LEAST);
    const guessed = guess.value() ? ` You guessed ${guess.value()} times.` : "";
    guess.answer(`Before: ${show(before, 1)} meals per 1,000 steps. After: ${show(after, 1)}, ${show(times, 1)} times as many.${guessed} It moves ${show(pace(2 * PATH, path.length))} units per step, at first ${show(pace(0, 2 * PATH))}.`);
  };

  stage.onBegin = () => {
    [meals, path] = [[[0, 0]], []];
    guess.answer("");
  };
  stage.onMoment = ({ frame, lives, trace }) => {
    const eaten = lives[0]?.eaten[0] ?? 0;
    if (frame.step > meals[meals.length - 1]![0]) meals.push([frame.step, eaten]);
    path.push(...trace);
    if (path.length > 4 * PATH) path.splice(2 * PATH, path.length - 4 * PATH);
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
    run.disabled = stage.running;
    if (stage.live.last >= steps) answer();
  };
  const learn = async () => {
    if (stage.live.last >= steps) stage.begin(stage.seed + 1);
    await stage.runTo(steps);
    stage.setPlaying(true);
  };
  run.addEventListener("click", () => void learn());
  const read = bindKnobs(section, stage, () => stage.begin());
  section.querySelector("#learning-sit")!.addEventListener("click", () => {
    stage.set(["food.normal.gene.initial_mean"], "0");
    stage.set(["genome.action.initial_mean"], "-10");
    read();
    stage.begin();
  });
  Object.assign(stage, { rate, pace: () => pace(2 * PATH, path.length) }); // for tests and curious persons
  return {
    section,
    stage,
    open: async (place) => {
      await openStage(stage, place);
      read();
    },
  };
}
