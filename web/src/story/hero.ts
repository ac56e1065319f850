// The opening of the article: a recording of a world in which a feeling evolves, with histograms of two genes below it.
import { diverging } from "../color";
import { by, show, signed, styleColor, surface } from "../element";
import { fileAddress } from "../files";
import { type Actor, load } from "./recording";
import { CALM } from "./stage";

const SECONDS = 20; // length of the whole recording
const REST = 3; // seconds for which its last moment is shown
const BINS = 25; // bars of a histogram
const SPAN = 0.5; // share of the range of feelings over which colors differ
const FACES = 21; // colors for which creatures are drawn in advance
const COUNT_MS = 100; // between two updates of the histograms
const FADE = 3; // moments over which a creature fades in, and over which the ring of a dead one fades out
const EYE = 0.6; // angle from the middle of the face to an eye [radian]

/** State for the browser's console, and for tests. */
interface Playing {
  moment: () => number;
  jump: (to: number) => void;
}

/** Plays the recording while it is visible; without a recording the still picture stays. */
export async function hero(): Promise<Playing> {
  const recording = await load(fileAddress("hero.gz"));
  const canvas = by<HTMLCanvasElement>("hero-world");
  const ink = canvas.getContext("2d");
  if (!ink) throw new Error("this browser draws no pictures");
  const play = by<HTMLButtonElement>("hero-play");
  const { head } = recording;
  const limit = head.limit * SPAN;
  const last = head.moments - 1;
  let [seen, playing, moment, before] = [true, !CALM.matches, CALM.matches ? last : 0, performance.now()];
  let due = 0; // time of the next update of the histograms
  let faces: HTMLCanvasElement[] = [];
  let size = 0; // scale at which the faces are drawn [pixel per unit]

  const label = () => {
    play.textContent = playing ? "Pause" : "Play";
    play.setAttribute("aria-pressed", String(playing));
  };
  const draw = () => {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [canvas.clientWidth * ratio, canvas.clientHeight * ratio];
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    const scale = Math.max(width / head.width, height / head.height);
    if (scale !== size) [size, faces] = [scale, Array.from({ length: FACES }, (_, i) => face(((2 * i) / (FACES - 1) - 1) * limit, limit, head.radius * scale))];
    const place = (x: number, y: number) => [width / 2 + (x - head.width / 2) * scale, height / 2 - (y - head.height / 2) * scale] as const;
    ink.setTransform(1, 0, 0, 1, 0, 0);
    ink.fillStyle = styleColor("--ground");
    ink.fillRect(0, 0, width, height);
    ink.fillStyle = "#3f8f4f";
    ink.beginPath();
    for (const { first, count, x, y } of recording.foods) {
      if (first > moment) break;
      if (first + count <= moment) continue;
      const at = place(x, y);
      ink.moveTo(at[0] + head.foodRadius * scale, at[1]);
      ink.arc(...at, head.foodRadius * scale, 0, 2 * Math.PI);
    }
    ink.fill();
    for (const actor of recording.actors) drawActor(actor, place, scale);
    ink.setTransform(1, 0, 0, 1, 0, 0);
    ink.globalAlpha = 1;
  };
  const drawActor = (actor: Actor, place: (x: number, y: number) => readonly [number, number], scale: number) => {
    const age = moment - actor.first;
    const end = actor.x.length - 1;
    if (age < 0 || age > end + FADE) return;
    const i = Math.min(Math.floor(age), end);
    const [next, share] = [Math.min(i + 1, end), age - i];
    const between = (of: Int16Array) => of[i]! + (of[next]! - of[i]!) * Math.min(share, 1);
    const at = place(between(actor.x), between(actor.y));
    if (age > end && actor.first + end < last) {
      ink.globalAlpha = Math.max(0, 1 - (age - end) / FADE);
      ink.setTransform(1, 0, 0, 1, 0, 0);
      ink.strokeStyle = diverging(actor.feeling, limit);
      ink.lineWidth = 2;
      ink.beginPath();
      ink.arc(...at, head.radius * scale * (1 + (age - end) / FADE / 2), 0, 2 * Math.PI);
      return void ink.stroke();
    }
    const grown = Math.min(1, actor.first === 0 ? 1 : 0.3 + (0.7 * age) / FADE);
    const turn = heading(actor, age);
    ink.globalAlpha = 1;
    ink.setTransform(grown * Math.cos(turn), grown * Math.sin(turn), -grown * Math.sin(turn), grown * Math.cos(turn), ...at);
    const color = Math.round(((Math.min(Math.max(actor.feeling / limit, -1), 1) + 1) / 2) * (FACES - 1));
    ink.drawImage(faces[color]!, -faces[color]!.width / 2, -faces[color]!.height / 2);
  };
  const living = () => recording.actors.filter(({ first, x }) => first <= moment && moment < first + x.length);
  const count = () => {
    const now = living();
    histogram("hero-feeling", now.map(({ feeling }) => feeling), head.limit, (value) => diverging(value, limit));
    histogram("hero-neutral", now.map(({ neutral }) => neutral), head.limit, () => styleColor("--before"));
    const mean = now.reduce((sum, { feeling }) => sum + feeling, 0) / now.length;
    by("hero-clock").textContent = `step ${show(Math.round(moment) * head.every)}, ${now.length} alive, mean feeling ${signed(mean)}`;
  };
  const picture = (now: number) => {
    const passed = Math.min((now - before) / 1000, 0.1);
    before = now;
    if (seen && playing) {
      moment += (passed * last) / SECONDS;
      if (moment > last * (1 + REST / SECONDS)) moment = 0;
    }
    const at = moment;
    moment = Math.min(at, last);
    if (seen) {
      draw();
      if (now > due) count();
      if (now > due) due = now + COUNT_MS;
    }
    moment = at;
    requestAnimationFrame(picture);
  };
  play.addEventListener("click", () => {
    if (!playing && moment >= last) moment = 0;
    playing = !playing;
    label();
  });
  new IntersectionObserver((entries) => (seen = entries[entries.length - 1]!.isIntersecting)).observe(canvas);
  label();
  play.hidden = false;
  canvas.hidden = false;
  by("hero-genes").hidden = false;
  requestAnimationFrame(picture);
  return { moment: () => moment, jump: (to) => (moment = to) };
}

/** The direction in which it looks [radian on the canvas]: along its path, as far as it is known, with smooth turns. */
function heading({ x, y }: Actor, age: number): number {
  const i = Math.floor(age);
  const along = (from: number) => {
    for (let k = Math.min(from, x.length - 2); k >= 0; k--) {
      const [right, up] = [x[k + 1]! - x[k]!, y[k + 1]! - y[k]!];
      if (right !== 0 || up !== 0) return Math.atan2(-up, right);
    }
    return 0;
  };
  const [now, next] = [along(i), along(i + 1)];
  const turn = Math.atan2(Math.sin(next - now), Math.cos(next - now));
  return now + turn * Math.min(age - i, 1);
}

/** Draws a creature with this feeling, facing right. */
function face(feeling: number, limit: number, radius: number): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = Math.ceil(2 * radius + 2);
  const ink = canvas.getContext("2d")!;
  const disc = (x: number, y: number, size: number, color: string) => {
    ink.fillStyle = color;
    ink.beginPath();
    ink.arc(canvas.width / 2 + x * radius, canvas.height / 2 + y * radius, size * radius, 0, 2 * Math.PI);
    ink.fill();
  };
  disc(0, 0, 1, diverging(feeling, limit));
  for (const side of [-EYE, EYE]) {
    disc(0.6 * Math.cos(side), 0.6 * Math.sin(side), 0.27, "#ffffff");
    disc(0.7 * Math.cos(side), 0.7 * Math.sin(side), 0.13, "#101418");
  }
  return canvas;
}

/** Draws a histogram of a gene's values from -limit to limit, with a line at 0. */
export function histogram(id: string, values: number[], limit: number, color: (value: number) => string): void {
  const canvas = by<HTMLCanvasElement>(id);
  const ink = surface(canvas);
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  const counts = new Array<number>(BINS).fill(0);
  for (const value of values) counts[Math.min(Math.max(Math.floor(((value / limit + 1) / 2) * BINS), 0), BINS - 1)]!++;
  const most = Math.max(0.2 * values.length, ...counts);
  counts.forEach((count, i) => {
    ink.fillStyle = color(((2 * (i + 0.5)) / BINS - 1) * limit);
    const tall = (count / most) * (height - 2);
    ink.fillRect((i * width) / BINS + 1, height - tall, width / BINS - 2, tall);
  });
  ink.fillStyle = styleColor("--quiet");
  ink.fillRect(width / 2 - 0.5, 0, 1, height);
}
