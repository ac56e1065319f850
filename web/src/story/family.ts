// Scene 3: many agents that die and have children, and what children inherit.
import { type Coloring, diverging } from "../color";
import { counted, element, fixed, show, styleColor } from "../element";
import type { Life } from "../types";
import { birth, chances, hazard } from "./chance";
import { Chart } from "./chart";
import { bindGuess } from "./guess";
import { bindKnobs } from "./knob";
import { Marks } from "./marks";
import { openStage, type Scene, type Worlds } from "./scene";
import { Stage } from "./stage";

const COLORED = 1.5; // feelings at and beyond this value have the same color
const RANGE = 3; // the plot of feelings shows -RANGE to RANGE
const SHOWN = 5; // children on the handout
const FIRST = 39; // the agent chosen at first; its family grows in the first world

export function family(section: HTMLElement, worlds: Worlds): Scene {
  const gene = (name: string) => worlds.family!.layout.genes.findIndex((each) => each.name === name);
  const [meal, moving] = [gene("w_normal"), gene("w_action")];
  let root = -1;
  const coloring: Coloring = { name: "feeling", label: "how food feels", scale: "diverging", low: -COLORED, high: COLORED, value: (life) => life?.genome[meal] ?? NaN };
  const stage: Stage = new Stage(section, worlds.family!, { scene: "family", autoplay: true, speed: 4, coloring });
  const chart = new Chart(
    section.querySelector("#family-dots")!,
    { low: -RANGE, high: RANGE, label: "how a meal feels to the parent" },
    { low: -RANGE, high: RANGE, label: "to the child" },
  );
  const drawChances = chances(section.querySelector("#family-chances")!);
  const count = section.querySelector<HTMLElement>("#family-count")!;
  const marks = new Marks(stage, (life) => diverging(life.genome[meal]!, COLORED));
  const guess = bindGuess(section);
  const card = section.querySelector<HTMLElement>("#family-card")!;
  const number = section.querySelector<HTMLInputElement>("#family-number")!;
  const next = section.querySelector<HTMLButtonElement>("#family-next")!;

  const choose = (id: number) => {
    stage.chosen = id;
    root = id < 0 ? -1 : stage.live.lives.founder(id);
    stage.notes.set("agent", String(id));
    if (id < 0) stage.notes.delete("agent");
    number.value = id < 0 ? "" : String(id);
  };
  /** The ids of living agents that have a parent, in ascending order. */
  const children = (): number[] => [...(stage.frame?.id ?? [])].filter((id) => (stage.life(id)?.parent ?? -1) >= 0);
  const chooseNext = () => {
    const ids = children();
    if (ids.length > 0) choose(ids.find((id) => id > stage.chosen) ?? ids[0]!);
  };
  /** Pairs of each child whose parent is known and that parent. */
  const pairs = (): [Life, Life][] =>
    [...stage.live.lives.all()].flatMap((child): [Life, Life][] => {
      const parent = child.parent >= 0 ? stage.live.lives.get(child.parent) : undefined;
      return parent ? [[child, parent]] : [];
    });
  stage.onBegin = () => {
    choose(FIRST);
    marks.clear();
  };
  stage.onMoment = (moment) => marks.note(moment);
  stage.onPicture = () => marks.draw();
  stage.onWords = () => {
    const known = pairs();
    chart.begin();
    chart.line([[-RANGE, -RANGE], [RANGE, RANGE]], styleColor("--rule"), 1);
    const [plain, mark] = [styleColor("--before"), styleColor("--kin")];
    const within = (value: number) => Math.min(Math.max(value, -RANGE), RANGE);
    const dots = known.map(([child, parent]) => ({ child, parent, kin: root >= 0 && stage.live.lives.founder(child.id) === root }));
    for (const { child, parent, kin } of dots.sort((a, b) => Number(a.kin) - Number(b.kin))) {
      chart.dot(within(parent.genome[meal]!), within(child.genome[meal]!), kin ? mark : plain, kin ? 4 : 3);
    }
    const all = [...stage.live.lives.all()];
    const died = all.filter(({ death }) => death >= 0).length;
    const born = all.filter(({ parent }) => parent >= 0).length;
    count.textContent = `${show(all.length - died)} alive; so far ${born} were born and ${died} died.`;
    drawChances(stage);
    const life = stage.life();
    card.replaceChildren(...(life ? about(life) : [element("p", { text: "Click or tap a creature, or take the next child." })]));
    next.disabled = children().length === 0;
    if (guess.value() && known.length > 0) guess.answer(verdict(known));
  };
  const about = (life: Life): HTMLElement[] => {
    const parent = stage.life(life.parent);
    const feels = (life: Life) => `a meal feels like ${show(life.genome[meal])}, moving like ${show(life.genome[moving])}`;
    const ate = (life: Life) => `${counted(life.eaten[0]!, "meal")} in ${counted((life.death >= 0 ? life.death : stage.live.last) - life.birth, "step")} of life`;
    const dead = (life: Life) => (life.death >= 0 ? " (dead)" : "");
    const kin = stage.frame ? [...stage.frame.id].filter((id) => stage.live.lives.founder(id) === root).length : 0;
    const lines = [`Creature ${life.id}${dead(life)}: ${feels(life)}; ${ate(life)}, ${life.children} ${life.children === 1 ? "child" : "children"}.`];
    lines.push(parent ? `Its parent, ${parent.id}${dead(parent)}: ${feels(parent)}; ${ate(parent)}.` : "It is a founder.");
    if (parent) lines.push("Its network began at random, with nothing that the parent had learned.");
    lines.push(kin === 1 ? "Nobody else of its family lives." : `${kin} of its family live.`);
    return lines.map((text) => element("p", { text }));
  };
  const verdict = (known: [Life, Life][]): string => {
    const apart = (pairs: [Life, Life][]) => pairs.reduce((sum, [child, parent]) => sum + Math.abs(child.genome[meal]! - parent.genome[meal]!), 0) / pairs.length;
    const others = known.flatMap(([child]) => known.filter(([, parent]) => parent.id !== child.parent).map(([, parent]): [Life, Life] => [child, parent]));
    const strangers = others.length > 0 ? `, but ${fixed(apart(others))} from another parent's` : "";
    return `Only what feels good. A child's feeling about meals is on average ${fixed(apart(known))} from its parent's${strangers}. Its network starts from scratch.`;
  };
  const { canvas } = stage.arena.scene;
  canvas.addEventListener("click", (event) => {
    const { frame } = stage;
    if (frame) choose(stage.arena.pick(stage.live, frame, ...stage.arena.scene.toWorld(event.clientX, event.clientY)));
  });
  document.addEventListener("keydown", (event) => {
    const writes = (event.target as HTMLElement).matches("input:not([type=radio], [type=range], [type=checkbox]), select, textarea");
    if (event.key.toLowerCase() !== "n" || !stage.seen || writes || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    chooseNext();
  });
  next.addEventListener("click", chooseNext);
  number.addEventListener("change", () => choose(stage.life(number.valueAsNumber) ? number.valueAsNumber : stage.chosen));
  const read = bindKnobs(section, stage, () => stage.begin(), { "energy.basic_cost": (value) => `${show(value)} energy` });
  section.addEventListener("reset", () => guess.answer(""));
  Object.assign(stage, { choose, pairs, marks, curve: { hazard, birth } });
  return {
    section,
    stage,
    numbers: () => {
      const last = pairs().slice(-SHOWN);
      const rows = last.map(([child, parent]) => [String(child.id), fixed(child.genome[meal]!), fixed(parent.genome[meal]!)]);
      return { caption: "How a meal feels to the children born last, and to their parents:", head: ["child", "to the child", "to its parent"], rows };
    },
    open: async (place) => {
      if ((await openStage(stage, place, read)) && place.notes.has("agent")) choose(Number(place.notes.get("agent")));
    },
  };
}
