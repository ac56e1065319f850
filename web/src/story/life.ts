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
const WATCHED = 64; // steps between two pictures of one life
const PIECE = 2048; // steps between two looks at one of many lives
const GRAB = 26; // pixels around a dot where it can be taken
const POINTS = 80; // of a curve

type Grip = "death" | "child"; // a dot at the end of a curve

/** A life that has ended: its steps, and how many children it had. */
interface Ended {
  steps: number;
  children: number;
}

/** Chances per step: see `hedon.config.schema.life`. */
export function hazard(stage: Stage, energy: number, age: number, kappa = stage.value("hazard.kappa")): number {
  const of = (name: string) => stage.value(`hazard.${name}`);
  const odds = of("alpha_energy") * Math.exp(-of("beta_energy") * energy);
  return (kappa * odds) / (1 + odds) + of("alpha_age") * Math.exp(of("beta_age") * age);
}

export function birth(stage: Stage, energy: number, kappa = stage.value("birth.kappa")): number {
  const of = (name: string) => stage.value(`birth.${name}`);
  return kappa / (1 + Math.exp(of("logit_offset") - of("beta") * energy));
}

/** The energy at which hunger is half as dangerous as without any. */
function halved(stage: Stage, beta: number): number {
  return Math.log(2 + stage.value("hazard.alpha_energy")) / beta;
}

/** How many of the lives were shorter than the one in their middle. */
function middle(lives: Ended[]): string {
  if (lives.length < 3) return "";
  const sorted = lives.map(({ steps }) => steps).sort((a, b) => a - b);
  const half = sorted[Math.floor(sorted.length / 2)]!;
  return ` ${sorted.filter((each) => each < half).length} of ${sorted.length} lives were shorter than ${show(half)} steps.`;
}

export function life(section: HTMLElement, worlds: Worlds): Scene {
  const stage = new Stage(section, worlds.life!, { scene: "life", speed: 8, coloring: ONE_COLOR, chosen: 0, threads: 1 });
  const per = { low: 0, high: 1, label: "expected per 1,000 steps" };
  const curves = new Chart(section.querySelector("#life-curves")!, { low: 0, high: MOST_ENERGY, label: "energy" }, per);
  const dots = new Chart(section.querySelector("#life-dots")!, { low: 0, high: 10_000, label: "length of a life [steps]" }, { low: 0, high: 1, label: "" });
  const guess = bindGuess(section);
  const buttons = ["one", "many"].map((name) => section.querySelector<HTMLButtonElement>(`#life-${name}`)!);
  let lives: Ended[] = [];
  let ended = false;
  const grips: Record<Grip, [number, number]> = { death: [0, 0], child: [MOST_ENERGY, 0] };
  let busy = ""; // which life runs, of how many
  let turn = 0; // a number of its own for each time that lives are asked for: it ends those before

  stage.onBegin = () => (ended = false);
  stage.onMoment = ({ dead }) => {
    const founder = dead.find((each) => each.id === 0);
    if (!founder || ended) return;
    ended = true;
    lives.push({ steps: founder.death - founder.birth, children: founder.children });
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
    [grips.death, grips.child] = [death[0]!, child[POINTS]!];
    curves.dot(...grips.death, red, 8);
    curves.dot(...grips.child, green, 8);
    curves.text("deaths", 1.5, death[0]![1] + per.high * 0.04, red);
    curves.text("children", MOST_ENERGY - 1.5, child[POINTS]![1] + per.high * 0.04, green, "right");
    if (founder && !ended) {
      const energy = Math.min(founder.energy, MOST_ENERGY);
      curves.line([[energy, 0], [energy, per.high]], styleColor("--quiet"), 1, [3, 3]);
      curves.text(`now, energy ${show(founder.energy, 1)}`, energy + 0.4, per.high * 0.95, styleColor("--quiet"));
    }
    dots.x.high = Math.max(10_000, ...lives.map(({ steps }) => steps));
    dots.begin();
    lives.forEach(({ steps }, i) => dots.dot(steps, 0.2 + (0.6 * ((i * 7) % 10)) / 10, styleColor("--mark")));
    const guessed = Number(guess.value());
    if (guessed) dots.line([[guessed, 0], [guessed, 1]], styleColor("--ink"), 2, [5, 3]);
  };
  stage.onWords = () => {
    draw();
    stage.play.disabled = busy !== "";
    buttons[0]!.setAttribute("aria-disabled", String(busy !== "")); // so that it keeps the focus
    buttons[1]!.textContent = busy ? `${busy}: stop` : `${MANY} lives`;
    const last = lives[lives.length - 1];
    if (!last) return;
    const guessed = guess.value() ? ` You guessed ${show(Number(guess.value()))}.` : "";
    const children = `${last.children || "no"} ${last.children === 1 ? "child" : "children"}`;
    guess.answer(`It lived ${show(last.steps)} steps, with ${children}.${guessed}${middle(lives)}`);
  };
  const stop = () => {
    [busy, turn] = ["", turn + 1];
  };
  /** Runs until the founder is dead, a piece at a time, as often as it is asked; nothing else stops it but `stop`. */
  const some = async (count: number, piece: number) => {
    const own = ++turn;
    stage.ensure();
    for (let i = 1; i <= count && own === turn; i++) {
      busy = `Life ${i} of ${count}`;
      if (stage.live.last > 0 || ended) stage.begin(stage.seed + 1);
      while (own === turn && !ended && !stage.live.error && stage.live.last < MOST_STEPS) await stage.runTo(stage.live.last + piece);
    }
    if (own === turn) stop();
  };
  buttons[0]!.addEventListener("click", () => busy || void some(1, WATCHED));
  buttons[1]!.addEventListener("click", () => (busy ? stop() : void some(MANY, PIECE)));
  const anew = () => {
    stop();
    lives = [];
    stage.begin();
  };
  const rate = (expected: number) => `${show(1000 * expected)} / 1,000 steps`;
  const read = bindKnobs(section, stage, anew, {
    "energy.basic_cost": (value) => `${show(value)} energy`,
    "hazard.kappa": (value) => rate(hazard(stage, 0, 0, value)),
    "hazard.beta_energy": (value) => `at ${show(halved(stage, value), 1)} energy`,
    "birth.kappa": (value) => rate(birth(stage, MOST_ENERGY, value)),
  });
  const forget = () => {
    stop();
    lives = [];
    guess.answer("");
  };
  section.addEventListener("reset", forget);
  bindDrag(curves, stage, grips, read, anew);
  Object.assign(stage, { lives: () => lives.map(({ steps }) => steps), curve: { hazard, birth } });
  return {
    section,
    stage,
    open: async (place) => {
      await openStage(stage, place, () => {
        forget();
        read();
      });
    },
  };
}

/** The dots on the curves: up and down is how many. Beside the dots a finger scrolls the page. */
function bindDrag(chart: Chart, stage: Stage, grips: Record<Grip, [number, number]>, read: () => void, begin: () => void): void {
  const { canvas } = chart;
  let held: Grip | undefined;
  const under = ({ clientX, clientY }: { clientX: number; clientY: number }): Grip | undefined =>
    (["death", "child"] as const).find((grip) => {
      const [x, y] = chart.page(...grips[grip]);
      return Math.hypot(clientX - x, clientY - y) <= GRAB;
    });
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
  canvas.addEventListener("touchstart", (event) => under(event.touches[0]!) && event.preventDefault(), { passive: false });
  canvas.addEventListener("pointerdown", (event) => {
    held = under(event);
    if (!held) return;
    canvas.setPointerCapture(event.pointerId);
    move(event);
  });
  canvas.addEventListener("pointermove", (event) => {
    canvas.classList.toggle("grip", held !== undefined || under(event) !== undefined);
    if (held) move(event);
  });
  for (const end of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(end, () => {
      if (held) begin();
      held = undefined;
    });
  }
}
