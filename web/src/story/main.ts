// Where the article begins: makes its scenes, plays those that are seen, and opens the places of links.
import "./story.css";
import { by, element } from "../element";
import { chance } from "./chance";
import { contest } from "./contest";
import { creature } from "./creature";
import evidence from "./evidence.json";
import { family } from "./family";
import { learning } from "./learning";
import { life } from "./life";
import { placeOf } from "./link";
import { sandbox } from "./sandbox";
import type { Scene, Worlds } from "./scene";
import { CALM } from "./stage";

const MAKERS: Record<string, (section: HTMLElement, worlds: Worlds) => Scene> = { creature, learning, life, family, contest, chance, sandbox };
const scenes: Record<string, Scene> = {};
const story = { scenes, pictures: 0, opened: "" };
Object.assign(window, { hedon: story }); // for a curious person's console, and for tests

async function begin(): Promise<void> {
  const answer = await fetch("data/story.json");
  if (!answer.ok) throw new Error("this site was made without the article: call hedon view --story");
  const { worlds } = (await answer.json()) as { worlds: Worlds };
  const seen = new IntersectionObserver((entries) => entries.forEach(see), { rootMargin: "-15% 0px" });
  for (const [name, make] of Object.entries(MAKERS)) {
    const scene = (scenes[name] = make(by(name), worlds));
    seen.observe(scene.stage?.host.querySelector(".view") ?? scene.section);
  }
  requestAnimationFrame(picture);
  window.addEventListener("hashchange", () => void openAddress().catch(complain));
  await openAddress();
}

/** A scene that comes into sight has its world, and one that leaves it rests. */
function see({ target, isIntersecting }: IntersectionObserverEntry): void {
  const scene = Object.values(scenes).find((each) => each.section.contains(target));
  const stage = scene?.stage;
  if (!scene || !stage) return;
  stage.seen = isIntersecting;
  if (!isIntersecting || stage.live) return;
  stage.begin();
  if (scene.autoplay && !CALM.matches) stage.setPlaying(true);
}

async function openAddress(): Promise<void> {
  by("notice").hidden = true;
  const place = placeOf(location.hash);
  if (!place) return;
  const scene = scenes[place.scene];
  if (!scene) throw new Error(`the link names the scene '${place.scene}': there are ${Object.keys(scenes).join(", ")}`);
  scene.section.scrollIntoView();
  story.opened = "";
  await scene.open?.(place);
  story.opened = location.hash;
}

function picture(): void {
  for (const { stage } of Object.values(scenes)) stage?.picture();
  story.pictures++;
  requestAnimationFrame(picture);
}

function complain(error: unknown): void {
  by("notice").hidden = false;
  by("notice").querySelector("span")!.textContent = error instanceof Error ? error.message : String(error);
}

by("notice").querySelector("button")!.addEventListener("click", () => (by("notice").hidden = true));

by("theme").addEventListener("click", () => {
  const dark = getComputedStyle(document.documentElement).colorScheme.startsWith("dark");
  document.documentElement.dataset.theme = dark ? "light" : "dark";
  for (const { section } of Object.values(scenes)) section.dispatchEvent(new CustomEvent("theme"));
});

for (const { source, command } of Object.values(evidence)) by("source-list").append(element("li", {}, element("code", { text: source }), ` from ${command}`));

begin().catch(complain);
