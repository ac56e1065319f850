// Entry point of the article: makes its scenes, plays the visible ones, and opens the places of links.
import "./story.css";
import { by, element } from "../element";
import { fileAddress } from "../files";
import { recallTheme, switchTheme } from "../preference";
import { contest } from "./contest";
import { creature } from "./creature";
import evidence from "./evidence.json";
import { evolve } from "./evolve";
import { family } from "./family";
import { fillIn } from "./handout";
import { hero } from "./hero";
import { learning } from "./learning";
import { type Place, placeOf } from "./link";
import { sandbox } from "./sandbox";
import type { Scene, Worlds } from "./scene";
import { showStill } from "./still";
import type { Stage } from "./stage";

const MAKERS: Record<string, (section: HTMLElement, worlds: Worlds) => Scene> = { creature, learning, family, evolve, contest, sandbox };
const PRINTED = 600; // steps that a world runs before it is printed
const scenes: Record<string, Scene> = {};
const story = { scenes, pictures: 0, opened: "" };
Object.assign(window, { hedon: story }); // for the browser's console, and for tests

async function begin(): Promise<void> {
  const answer = await fetch(fileAddress("data/story.json"));
  if (!answer.ok) throw new Error("this site was made without the article: call hedon view --story");
  const { worlds } = (await answer.json()) as { worlds: Worlds };
  const seen = new IntersectionObserver((entries) => entries.forEach(see), { rootMargin: "-15% 0px" });
  for (const [name, make] of Object.entries(MAKERS)) {
    try {
      const scene = (scenes[name] = make(by(name), worlds));
      seen.observe(scene.stage?.host.querySelector(".view") ?? scene.section);
    } catch (error) { // for example without WebGL: a picture takes its place, and the other scenes still work
      by(name).append(element("p", { class: "fault", text: `This scene cannot be shown: ${messageOf(error)}.` }));
      showStill(by(name).querySelector(".view")!, name);
    }
  }
  requestAnimationFrame(picture);
  window.addEventListener("hashchange", () => void openAddress().catch(complain));
  await openAddress();
}

/** Starts the world of a scene that becomes visible, and pauses one that leaves the screen. */
function see({ target, isIntersecting }: IntersectionObserverEntry): void {
  const stage = Object.values(scenes).find((each) => each.section.contains(target))?.stage;
  if (!stage) return;
  stage.seen = isIntersecting;
  if (isIntersecting) stage.ensure();
}

async function openAddress(): Promise<void> {
  by("notice").hidden = true;
  const place = placeOf(location.hash);
  if (!place) return;
  const { hash } = location;
  const scene = Object.hasOwn(scenes, place.scene) ? scenes[place.scene] : undefined;
  scene?.section.scrollIntoView();
  story.opened = "";
  try {
    if (!scene) throw new Error(`it names the scene '${place.scene}': there are ${Object.keys(scenes).join(", ")}`);
    if (place.damage) throw new Error(place.damage);
    await scene.open?.(place);
  } catch (error) {
    throw new Error(`The link is damaged: ${messageOf(error)}.`);
  }
  if (location.hash !== hash) return; // another link has been opened in the meantime
  story.opened = hash;
  const other = scene.stage && otherWorld(scene.stage, place);
  if (other) throw new Error(other);
}

/** A message if the world differs from its link, or "". */
function otherWorld({ live, chosen }: Stage, place: Place): string {
  const digest = live.digest();
  const arrived = digest !== "" && (live.last === place.step || live.over); // false if the reader has begun another world in the meantime
  if (arrived && place.digest && !digest.startsWith(place.digest)) {
    return `This is not the world of the link, whose letters are ${place.digest}: it is damaged, or made by another version, or by a browser that rounds otherwise.`;
  }
  const lost = place.notes.has("agent") && !live.lives.get(chosen);
  return arrived && lost ? `The link is damaged: this world has no creature ${place.notes.get("agent")}.` : "";
}

function picture(): void {
  for (const { stage } of Object.values(scenes)) stage?.picture();
  story.pictures++;
  requestAnimationFrame(picture);
}

const messageOf = (error: unknown): string => (error instanceof Error ? error.message : String(error));

function complain(error: unknown): void {
  by("notice").hidden = false;
  by("notice").querySelector("span")!.textContent = messageOf(error);
}

by("notice").querySelector("button")!.addEventListener("click", () => (by("notice").hidden = true));

recallTheme();
by("theme").addEventListener("click", () => {
  switchTheme();
  for (const { section } of Object.values(scenes)) section.dispatchEvent(new CustomEvent("theme"));
});

for (const { source, command } of Object.values(evidence)) by("source-list").append(element("li", {}, element("code", { text: source }), ` from ${command}`));

document.addEventListener("visibilitychange", () => Object.values(scenes).forEach(({ stage }) => stage?.unseen()));

/** Prints the article with a picture in each scene, including those whose world has not begun. */
async function print(): Promise<void> {
  for (const { stage } of Object.values(scenes)) {
    if (!stage) continue;
    stage.ensure();
    if (stage.live.last === 0) await stage.runTo(PRINTED);
    stage.show();
  }
  window.print();
}
by("print").addEventListener("click", () => void print());
window.addEventListener("beforeprint", () => {
  for (const { section, stage, numbers } of Object.values(scenes)) if (numbers && stage?.live) fillIn(section, numbers());
});

/** Plays the recording at the top. If it fails, its still picture and the rest of the article remain. */
function open(): void {
  const fault = by("hero-fault");
  fault.hidden = true;
  hero().then(
    (playing) => Object.assign(story, { hero: playing }),
    (error) => {
      fault.querySelector("span")!.textContent = `The recording cannot be played: ${messageOf(error)}.`;
      fault.hidden = false;
    },
  );
}
by("hero-fault").querySelector("button")!.addEventListener("click", open);

open();
begin().catch(complain);
