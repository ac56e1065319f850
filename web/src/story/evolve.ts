// Scene 4: a feeling evolves before the reader's eyes, compared with genes that do nothing, with another seed and without learning.
import { diverging, type Coloring } from "../color";
import { show, signed, styleColor } from "../element";
import type { Life } from "../types";
import { Chart } from "./chart";
import { histogram } from "./hero";
import { bindKnobs } from "./knob";
import { Pad } from "./pad";
import recorded from "./recorded.json";
import { openStage, type Scene, type Worlds } from "./scene";
import { Stage } from "./stage";

const STEPS = 12_288;
const APART = 256; // steps between two points of a line
const POINTS = 41; // of a guess
const QUARTERS = 4; // of the plot, on the handout
const KEPT = 11; // of these, kept in a link
const LIMIT = 1.5; // of a histogram
const COLORED = 0.75; // feelings at and beyond this value have the same color
const RATE = "learning.learning_rate";

/** The means in a world so far of the feeling and of each neutral gene. */
interface Course {
  seed: number;
  learns: boolean;
  step: number[];
  feeling: number[];
  neutral: number[][]; // [gene][sample]
}

export function evolve(section: HTMLElement, worlds: Worlds): Scene {
  const genes = worlds.evolve!.layout.genes.map(({ name }) => name);
  const [feeling, idle] = [genes.indexOf("w_normal"), genes.flatMap((name, g) => (name.startsWith("neutral") ? [g] : []))];
  const coloring: Coloring = { name: "feeling", label: "how food feels", scale: "diverging", low: -COLORED, high: COLORED, value: (life) => life?.genome[feeling] ?? NaN };
  const stage = new Stage(section, worlds.evolve!, { scene: "evolve", speed: 8, coloring });
  const chart = new Chart(section.querySelector("#evolve-plot")!, { low: 0, high: STEPS, label: "steps" }, { low: -1, high: 1, label: "mean feeling" });
  const answer = section.querySelector<HTMLElement>("#evolve-answer")!;
  const then = section.querySelector<HTMLElement>("#evolve-then")!; // the explanation, shown after the reader has seen the result
  const [run, again, unable] = ["run", "seed", "learner"].map((name) => section.querySelector<HTMLButtonElement>(`#evolve-${name}`)!) as [HTMLButtonElement, HTMLButtonElement, HTMLButtonElement];
  stage.play.hidden = true; // the scene's buttons run it to the end of the plot, unless Reset stops it
  let done: Course[] = [];
  let now: Course | undefined;
  let living: Life[] = [];
  let busy = false;

  const pad = new Pad(chart, POINTS, () => stage.value("food.normal.gene.initial_mean"), () => draw());
  const learns = () => stage.value(RATE) > 0;
  stage.onBegin = () => {
    now = { seed: stage.seed, learns: learns(), step: [], feeling: [], neutral: idle.map(() => []) };
    living = [];
  };
  stage.onMoment = ({ frame, lives }) => {
    living = lives;
    if (!now || lives.length === 0 || frame.step < (now.step[now.step.length - 1] ?? -APART) + APART) return;
    const mean = (gene: number) => lives.reduce((sum, life) => sum + life.genome[gene]!, 0) / lives.length;
    now.step.push(frame.step);
    now.feeling.push(mean(feeling));
    idle.forEach((gene, g) => now!.neutral[g]!.push(mean(gene)));
  };
  const points = ({ step }: Course, values: number[]) => step.map((at, i): [number, number] => [at, values[i]!]);
  const draw = () => {
    chart.x.high = Math.max(STEPS, stage.live?.last ?? 0); // a link may lead further
    chart.begin();
    const [mark, gray] = [styleColor("--mark"), styleColor("--before")];
    for (const each of done) chart.line(points(each, each.feeling), mark, 1, each.learns ? [] : [5, 4]);
    if (now) {
      for (const values of now.neutral) chart.line(points(now, values), gray, 1);
      chart.line(points(now, now.feeling), mark, 3, now.learns ? [] : [8, 5]);
    }
    if (pad.guess.length > 0) chart.line(pad.line(), styleColor("--ink"), 2, [2, 4]);
    else if (!busy && done.length === 0) {
      chart.dot(0, pad.begin(), mark, 6);
      chart.text("Draw your line from here →", STEPS / 30, pad.begin() + 0.12, styleColor("--ink"));
    }
    if (pad.whole) stage.notes.set("guess", kept(pad.guess));
    else stage.notes.delete("guess");
    pad.shut = busy || done.length > 0;
    chart.canvas.classList.toggle("shown", pad.shut);
    run.setAttribute("aria-disabled", String(busy || !pad.whole)); // unlike `disabled`, this keeps the focus
    for (const button of [again, unable]) button.setAttribute("aria-disabled", String(busy || done.length === 0));
    answer.textContent = words();
    then.hidden = done.length === 0;
  };
  stage.onWords = () => {
    draw();
    histogram("evolve-feeling", living.map((life) => life.genome[feeling]!), LIMIT, (value) => diverging(value, COLORED));
    histogram("evolve-neutral", living.map((life) => life.genome[idle[0]!]!), LIMIT, () => styleColor("--before"));
  };
  const words = (): string => {
    if (busy && stage.running) return `World ${stage.seed}, step ${show(stage.live.last)} of ${show(STEPS)}: ${living.length} alive.`;
    const last = done[done.length - 1];
    if (!last) return pad.whole ? "Now watch." : pad.guess.length > 0 ? "Go on to the right end." : "Draw first.";
    return `${report(last)} ${tally(done)}`.trim();
  };
  const report = ({ feeling: course, neutral, learns: learned, step }: Course): string => {
    const [begin, end] = [course[0]!, course[course.length - 1]!];
    const guessed = pad.whole && learned ? `You drew ${signed(pad.guess[POINTS - 1]!)}. ` : "";
    const died = step[step.length - 1]! < STEPS - APART ? ` All had died by step ${show(step[step.length - 1])}.` : "";
    const beyond = Math.abs(end - begin) > Math.max(...neutral.map(change));
    const who = learned ? "The mean" : "Where nobody could learn, the mean";
    return `${guessed}${who} went from ${signed(begin)} to ${signed(end)}, ${beyond ? "further than any gray gene" : "no further than a gray gene did: this may be chance"}.${died}`;
  };
  const some = async (seed: number, rate: string) => {
    busy = true;
    stage.set([RATE], rate);
    stage.begin(seed);
    const course = now;
    draw();
    stage.host.querySelector(".view")!.scrollIntoView({ block: "nearest" }); // which may be above the plot just drawn into
    await stage.runTo(STEPS);
    if (course !== now) return; // another world has begun in the meantime
    busy = false;
    if (course && course.step.length > 1 && !stage.live.error) done.push(course);
    draw();
  };
  const usual = String(stage.value(RATE));
  run.addEventListener("click", () => {
    if (busy || !pad.whole) return;
    done = [];
    void some(1, usual);
  });
  again.addEventListener("click", () => busy || done.length === 0 || void some(stage.seed + 1, usual));
  unable.addEventListener("click", () => busy || done.length === 0 || void some(stage.seed, "0"));
  const forget = () => {
    [busy, done] = [false, []];
    pad.clear();
  };
  const read = bindKnobs(section, stage, () => {
    forget();
    stage.set([RATE], usual);
    stage.begin(1);
  });
  section.addEventListener("reset", forget);
  new ResizeObserver(draw).observe(chart.canvas);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  section.addEventListener("theme", draw);
  Object.assign(stage, { courses: () => done, pad });
  return {
    section,
    stage,
    numbers: () => {
      const own = done.flatMap((each) => rowsOf(`world ${each.seed}`, each.learns, quarters(each, each.feeling), quarters(each, furthest(each))));
      const others = recorded.evolve.flatMap((each) => rowsOf("recorded", each.learns, each.feeling.map((value) => signed(value)), each.neutral.map((value) => signed(value))));
      const drawn = Array.from({ length: QUARTERS + 1 }, (_, i) => pad.guess[Math.round((i * (POINTS - 1)) / QUARTERS)]!);
      const guessed = pad.whole ? [["your drawing", ...drawn.map((value) => signed(value))]] : [];
      const head = ["steps", ...drawn.map((_, i) => show((i * STEPS) / QUARTERS))];
      return { caption: "The mean feeling about food, and the mean of the gray gene that went furthest:", head, rows: [...guessed, ...(done.length > 0 ? own : others)] };
    },
    open: async (place) => {
      forget();
      place.notes.get("guess")?.split("_").forEach((value, i) => pad.put((i * STEPS) / (KEPT - 1), Number(value)));
      await openStage(stage, place, read);
      draw();
    },
  };
}

/** How far a mean went. */
const change = (values: number[]): number => Math.abs(values[values.length - 1]! - values[0]!);

/** The mean of the neutral gene that went furthest. */
const furthest = ({ neutral }: Course): number[] => neutral.reduce((most, each) => (change(each) > change(most) ? each : most));

/** The values of a course closest to the start, the quarters and the end of the plot; "" after the last death. */
const quarters = ({ step }: Course, values: number[]): string[] =>
  Array.from({ length: QUARTERS + 1 }, (_, i) => {
    const due = (i * STEPS) / QUARTERS;
    const at = step.findIndex((each) => each >= due - APART);
    return at < 0 ? "" : signed(values[at]!);
  });

/** Both rows of a world on the handout. */
const rowsOf = (world: string, learns: boolean, feeling: string[], neutral: string[]): string[][] => {
  const name = learns ? world : `${world}, no learning`;
  return [[`feeling, ${name}`, ...feeling], [`gray gene, ${name}`, ...neutral]];
};

/** A guess as it is kept in a link, with fewer points. */
const kept = (guess: number[]): string =>
  Array.from({ length: KEPT }, (_, i) => guess[Math.round((i * (POINTS - 1)) / (KEPT - 1))]!.toFixed(2)).join("_");

/** A sentence with the number of worlds with learning in which the feeling rose. */
function tally(done: Course[]): string {
  const learned = done.filter((each) => each.learns);
  if (learned.length < 2) return "";
  const rose = learned.filter(({ feeling }) => feeling[feeling.length - 1]! > feeling[0]!).length;
  return `It rose in ${rose} of ${learned.length} worlds that learned.`;
}
