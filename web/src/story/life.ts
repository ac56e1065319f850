// Scene 3: the chances of death and of a child as curves that one drags, and lives to their end.
import { show, styleColor } from "../element";
import { Chart } from "./chart";
import { ONE_COLOR } from "./creature";
import { bindGuess } from "./guess";
import { bindKnobs } from "./knob";
import { openStage, type Scene, type Worlds } from "./scene";
import { Stage } from "./stage";

const MOST_ENERGY = 40; // of the plot
const MOST_STEPS = 30_000; // of a life that is waited for
const MANY = 20; // lives
const POINTS = 80; // of a curve

/** Chances per step: see `hedon.config.life`. */
export function hazard(stage: Stage, energy: number, age: number): number {
  const of = (name: string) => stage.value(`hazard.${name}`);
  const odds = of("alpha_energy") * Math.exp(-of("beta_energy") * energy);
  return (of("kappa") * odds) / (1 + odds) + of("alpha_age") * Math.exp(of("beta_age") * age);
}

export function birth(stage: Stage, energy: number): number {
  const of = (name: string) => stage.value(`birth.${name}`);
  return of("kappa") / (1 + Math.exp(of("logit_offset") - of("beta") * energy));
}

export function life(section: HTMLElement, worlds: Worlds): Scene {
  const stage = new Stage(section, worlds.life!, { scene: "life", speed: 8, coloring: ONE_COLOR, chosen: 0, threads: 1 });
  const per = { low: 0, high: 1, label: "chance per 1,000 steps" };
  const curves = new Chart(section.querySelector("#life-curves")!, { low: 0, high: MOST_ENERGY, label: "energy" }, per);
  const dots = new Chart(section.querySelector("#life-dots")!, { low: 0, high: 10_000, label: "length of a life [steps]" }, { low: 0, high: 1, label: "" });
  const guess = bindGuess(section);
  const buttons = ["one", "many"].map((name) => section.querySelector<HTMLButtonElement>(`#life-${name}`)!);
  let lives: number[] = [];
  let ended = false;
  let busy = false;

  /** Runs until the founder is dead; notes how long it lived. */
  const toDeath = async () => {
    while (!ended && !stage.live.error && stage.live.last < MOST_STEPS) await stage.runTo(stage.live.last + 64);
  };
  stage.onBegin = () => (ended = false);
  stage.onMoment = ({ dead }) => {
    const founder = dead.find((each) => each.id === 0);
    if (!founder || ended) return;
    ended = true;
    lives.push(founder.death - founder.birth);
    stage.setPlaying(false);
  };
  const draw = () => {
    const [red, green] = [styleColor("--death"), styleColor("--birth")];
    const founder = stage.life();
    const age = founder && !ended ? stage.live.last : 0;
    const curve = (of: (energy: number) => number) => Array.from({ length: POINTS + 1 }, (_, i): [number, number] => [(i * MOST_ENERGY) / POINTS, 1000 * of((i * MOST_ENERGY) / POINTS)]);
    const [death, child] = [curve((energy) => hazard(stage, energy, age)), curve((energy) => birth(stage, energy))];
    per.high = Math.max(0.5, Math.ceil(2.4 * Math.max(death[0]![1], child[POINTS]![1])) / 2);
    curves.begin();
    curves.line(death, red);
    curves.line(child, green);
    curves.dot(0, death[0]![1], red, 8);
    curves.dot(MOST_ENERGY, child[POINTS]![1], green, 8);
    curves.text("death", 1.5, death[0]![1] + per.high * 0.04, red);
    curves.text("a child", MOST_ENERGY - 1.5, child[POINTS]![1] + per.high * 0.04, green, "right");
    if (founder && !ended) {
      const energy = Math.min(founder.energy, MOST_ENERGY);
      curves.line([[energy, 0], [energy, per.high]], styleColor("--quiet"), 1, [3, 3]);
      curves.text(`now, energy ${show(founder.energy, 1)}`, energy + 0.4, per.high * 0.95, styleColor("--quiet"));
    }
    dots.x.high = Math.max(10_000, ...lives);
    dots.begin();
    lives.forEach((each, i) => dots.dot(each, 0.2 + (0.6 * ((i * 7) % 10)) / 10, styleColor("--mark")));
    const guessed = Number(guess.value());
    if (guessed) dots.line([[guessed, 0], [guessed, 1]], styleColor("--ink"), 2, [5, 3]);
  };
  stage.onWords = () => {
    draw();
    for (const each of buttons) each.disabled = busy;
    if (lives.length === 0) return;
    const sorted = [...lives].sort((a, b) => a - b);
    const middle = sorted.length > 2 ? ` Half of ${sorted.length} lives ended before ${show(sorted[Math.floor(sorted.length / 2)])}.` : "";
    const guessed = guess.value() ? ` You guessed ${show(Number(guess.value()))}.` : "";
    const founder = stage.life();
    const children = founder ? `, with ${founder.children} ${founder.children === 1 ? "child" : "children"}` : "";
    guess.answer(`It lived ${show(lives[lives.length - 1])} steps${children}.${guessed}${middle}`);
  };
  const some = async (count: number) => {
    busy = true;
    for (let i = 0; i < count; i++) {
      if (stage.live.last > 0 || ended) stage.begin(stage.seed + 1);
      await toDeath();
    }
    busy = false;
  };
  buttons[0]!.addEventListener("click", () => void some(1));
  buttons[1]!.addEventListener("click", () => void some(MANY));
  const read = bindKnobs(section, stage, () => {
    lives = [];
    stage.begin();
  });
  section.addEventListener("reset", () => {
    lives = [];
    guess.answer("");
  });
  bindDrag(curves, stage, read, () => {
    lives = [];
    stage.begin();
  });
  Object.assign(stage, { lives: () => lives, curve: { hazard, birth } });
  return {
    section,
    stage,
    open: async (place) => {
      await openStage(stage, place);
      read();
    },
  };
}

/** The dots on the curves: up and down is how likely; with death, left and right is how fast food protects. */
function bindDrag(chart: Chart, stage: Stage, read: () => void, begin: () => void): void {
  const { canvas } = chart;
  let held = "";
  const put = (path: string, value: number) => {
    const knob = stage.host.querySelector<HTMLInputElement>(`input[data-path="${path}"]`)!;
    knob.value = String(value); // which takes the nearest value that the slider has
    stage.set([path], knob.value);
  };
  const move = (event: PointerEvent) => {
    const [, y] = chart.place(event);
    const chance = y / 1000;
    if (held === "death") {
      const alpha = stage.value("hazard.alpha_energy");
      put("hazard.kappa", (Math.max(chance - stage.value("hazard.alpha_age"), 0) * (1 + alpha)) / alpha);
    } else put("birth.kappa", chance * (1 + Math.exp(stage.value("birth.logit_offset") - stage.value("birth.beta") * MOST_ENERGY)));
    read();
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    held = chart.place(event)[0] < MOST_ENERGY / 2 ? "death" : "child";
    move(event);
  });
  canvas.addEventListener("pointermove", (event) => held && move(event));
  canvas.addEventListener("pointerup", () => {
    if (held) begin();
    held = "";
  });
}
