// Scene 1: a creature that the reader steers, with two meters.
import { counted, show, styleColor } from "../element";
import type { Coloring } from "../color";
import { bindGuess } from "./guess";
import { bindKnobs } from "./knob";
import { openStage, type Scene, type Worlds } from "./scene";
import { CALM, Stage } from "./stage";
import { commandsOf, ofKeys, toward, Track } from "./steer";

export const ONE_COLOR: Coloring = { name: "one", label: "a creature", scale: "distinct", value: () => 0 };
const FIRST = 212; // the seed of a world in which it begins in the middle with food straight ahead, some 35 steps away
const STROLL = 1500; // steps for which it moves by itself as a demonstration
const ENOUGH = 5; // meals that reveal the second slider
const GLOW = 3; // radii
const LASTS = 60; // time constant of a feeling's decay [steps]
const FLAME = 0.09; // length of a motor's flame per unit of force

export function creature(section: HTMLElement, worlds: Worlds): Scene {
  const stage = new Stage(section, worlds.creature!, { scene: "creature", autoplay: true, speed: 1, coloring: ONE_COLOR, chosen: 0, first: FIRST, rays: true, threads: 1 });
  const [least, most] = ["min_force", "max_force"].map((name) => stage.value(`motor.${name}`)) as [number, number];
  const commands = commandsOf(least, most);
  const keys = new Set<string>();
  let replay: { command: string; until: number }[] = []; // commands from a link, each with the step at which it ends
  let track = new Track();
  let goal: [number, number] | undefined;
  let strolling = !CALM.matches;
  let steered = false; // whether a reader, or a link, has steered this world
  let command = ".";
  let felt = 0; // recent reward, decaying
  let rewarded = 0; // total reward at the last moment
  const guess = bindGuess(section);
  const hint = section.querySelector<HTMLElement>(".hint")!;
  const second = section.querySelector<HTMLElement>("#creature-moving")!; // the second slider
  const speed = section.querySelector<HTMLElement>("#creature-speed")!; // the words about it
  const meter = (name: string) => section.querySelector<HTMLElement>(`#creature-${name}`)!;

  const takeOver = () => {
    if (strolling) stage.begin();
    stage.stop();
    [strolling, steered, replay] = [false, true, []];
    stage.setPlaying(true);
  };
  const here = (): [number, number, number] | undefined => {
    const { frame } = stage;
    return frame && frame.id.length > 0 ? [frame.x[0]!, frame.y[0]!, frame.angle[0]!] : undefined;
  };
  const nearest = (): [number, number] | undefined => {
    const { frame } = stage;
    if (!frame || frame.foodX.length === 0) return undefined;
    const away = (i: number) => (frame.foodX[i]! - frame.x[0]!) ** 2 + (frame.foodY[i]! - frame.y[0]!) ** 2;
    const best = [...frame.foodX.keys()].reduce((a, b) => (away(b) < away(a) ? b : a));
    return [frame.foodX[best]!, frame.foodY[best]!];
  };
  const decide = (): string => {
    if (keys.size > 0) return ofKeys(keys);
    const at = here();
    const to = goal ?? (strolling ? nearest() : undefined);
    return at && to ? toward(...at, to) : ".";
  };

  stage.advance = (steps) => {
    if (strolling && stage.live.last > STROLL) {
      strolling = false;
      stage.setPlaying(false);
      return false;
    }
    const next = decide();
    stage.actions = commands[next];
    const sent = Stage.prototype.advance.call(stage, steps);
    if (sent) command = next;
    return sent;
  };
  stage.ahead = (left) => {
    const next = replay.find(({ until }) => until > stage.live.last);
    if (!next) return left;
    [command, stage.actions] = [next.command, commands[next.command]];
    return Math.min(left, next.until - stage.live.last);
  };
  stage.onBegin = () => {
    [track, command, replay, steered] = [new Track(), ".", [], false];
    [felt, rewarded] = [0, 0];
  };
  stage.onMoment = ({ done }) => {
    track.add(command, done);
    stage.edited = track.runs.some(([each]) => each !== ".");
    if (track.fits) stage.notes.set("steer", String(track));
    else stage.notes.delete("steer");
    const reward = stage.life()?.reward ?? 0;
    felt = felt * Math.exp(-done / LASTS) + reward - rewarded;
    rewarded = reward;
    if (stage.running && replay.length > 0) stage.move(); // without waiting for the next picture, since there may be hundreds of short commands
  };
  stage.onPicture = () => {
    drawMotors(stage, commands[command]!, [least, most]);
    drawGlow(stage, felt);
  };
  stage.onWords = () => {
    const meals = stage.life()?.eaten[0] ?? 0;
    const done = meals >= ENOUGH && !guess.value() && stage.changes.size === 0;
    const state = strolling ? "strolls" : stage.aim > stage.live.last ? "replays" : !steered ? "waits" : done ? "done" : "";
    hint.hidden = state === "";
    for (const each of hint.querySelectorAll<HTMLElement>("[data-when]")) each.hidden = each.dataset.when !== state;
    const life = stage.life();
    if (!life) return;
    meter("energy").textContent = show(life.energy, 1);
    meter("meals").textContent = show(meals);
    meter("reward").textContent = show(life.reward, 2);
    meter("meals").classList.toggle("reached", meals >= ENOUGH && !strolling);
    if (stage.changes.size > 0 || guess.value() || (meals >= ENOUGH && !strolling)) second.hidden = speed.hidden = false;
    if (guess.value()) guess.answer("Yes. Let moving feel like 5 and drive in circles: reward grows without a meal, while energy falls.");
  };

  bindSteering(stage, keys, takeOver, (place) => (goal = place));
  releaseFocus(section);
  section.addEventListener("reset", () => (strolling = false));
  const read = bindKnobs(section, stage, () => {
    strolling = false;
    stage.setPlaying(false); // until the reader steers
    stage.begin();
  });
  Object.assign(stage, { commands, track: () => String(track) }); // for the browser's console, and for tests
  return {
    section,
    stage,
    numbers: () => {
      const feels = (path: string) => show(stage.value(path));
      const felt = `a meal felt like ${feels("food.normal.gene.initial_mean")} and moving like ${feels("genome.action.initial_mean")}`;
      return { caption: `These are its energy, meals and reward after ${counted(stage.live.last, "step")}, in which ${felt}.`, head: [], rows: [] };
    },
    open: (place) =>
      openStage(stage, place, () => {
        read();
        let until = 0;
        replay = Track.of(place.notes.get("steer") ?? "").runs.map(([each, steps]) => ({ command: each, until: (until += steps) }));
        [strolling, steered] = [false, replay.length > 0];
      }),
  };
}

function bindSteering(stage: Stage, keys: Set<string>, takeOver: () => void, go: (place?: [number, number]) => void): void {
  const { canvas } = stage.arena.scene;
  canvas.classList.add("steered");
  document.addEventListener("keydown", (event) => {
    const target = event.target as HTMLElement;
    if (!event.key.startsWith("Arrow") || !stage.seen || /^(INPUT|SELECT|TEXTAREA)$/.test(target.tagName) || event.ctrlKey || event.metaKey || event.altKey) return;
    if (target !== canvas && document.activeElement !== document.body) return;
    event.preventDefault();
    if (keys.size === 0) takeOver();
    keys.add(event.key);
  });
  document.addEventListener("keyup", (event) => keys.delete(event.key));
  window.addEventListener("blur", () => keys.clear());
  const point = (event: PointerEvent) => go(stage.arena.scene.toWorld(event.clientX, event.clientY));
  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    canvas.setPointerCapture(event.pointerId);
    takeOver();
    point(event);
  });
  canvas.addEventListener("pointermove", (event) => (event.buttons & 1) > 0 && point(event));
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => go());
}

/** Blurs controls after a click, so that the arrow keys steer again. Keyboard users keep the focus. */
function releaseFocus(section: HTMLElement): void {
  const release = () => {
    const { activeElement } = document;
    if (activeElement instanceof HTMLElement && section.contains(activeElement) && activeElement.matches("input, button, a")) activeElement.blur();
  };
  section.addEventListener("click", (event) => event.detail > 0 && setTimeout(release)); // a click on a label moves the focus afterwards
  section.addEventListener("pointerdown", () => document.addEventListener("pointerup", () => setTimeout(release), { once: true }));
}

/** Draws its feeling as a glow around it, warm for good and cold for bad. */
function drawGlow(stage: Stage, felt: number): void {
  const { frame, ink, arena } = stage;
  const strength = Math.min(Math.abs(felt), 1);
  if (!frame || frame.id.length === 0 || strength < 0.02) return;
  const [x, y] = stage.at(frame.x[0]!, frame.y[0]!);
  const radius = stage.live.layout.species[0]!.radius * arena.scene.zoom * (ink.canvas.clientWidth / arena.scene.canvas.width);
  const glow = ink.createRadialGradient(x, y, radius, x, y, GLOW * radius);
  const color = styleColor(felt > 0 ? "--flame" : "--blue");
  glow.addColorStop(0, color);
  glow.addColorStop(1, `${color}00`); // "transparent" would be black, and gray on the way there
  ink.globalAlpha = 0.7 * strength;
  ink.fillStyle = glow;
  ink.beginPath();
  ink.arc(x, y, GLOW * radius, 0, 2 * Math.PI);
  ink.arc(x, y, radius, 0, 2 * Math.PI, true);
  ink.fill();
  ink.globalAlpha = 1;
}

/** Draws both motors as flames behind the body, with lengths proportional to their forces. */
function drawMotors(stage: Stage, actions: [number, number], [least, most]: [number, number]): void {
  const { frame, ink, arena } = stage;
  if (!frame || frame.id.length === 0) return;
  const [x, y, angle] = [frame.x[0]!, frame.y[0]!, frame.angle[0]!];
  const { radius } = stage.live.layout.species[0]!;
  ink.lineWidth = Math.max(3, arena.scene.zoom * 3);
  ink.strokeStyle = styleColor("--flame");
  ink.lineCap = "round";
  actions.forEach((action, i) => {
    const force = least + (most - least) / (1 + Math.exp(-action));
    const side = angle + ((i === 0 ? 135 : -135) * Math.PI) / 180;
    const [mx, my] = [x - radius * Math.sin(side), y + radius * Math.cos(side)];
    ink.beginPath();
    ink.moveTo(...stage.at(mx, my));
    ink.lineTo(...stage.at(mx + FLAME * force * Math.sin(angle), my - FLAME * force * Math.cos(angle)));
    if (Math.abs(force) > 1) ink.stroke();
  });
}
