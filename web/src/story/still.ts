// The picture of a scene, shown in its arena if the world cannot run. A single-file page has none.
import { element } from "../element";
import { isSingleFile } from "../files";

export function showStill(view: Element, scene: string): void {
  if (isSingleFile() || view.querySelector("img")) return;
  const picture = element("img");
  picture.src = new URL(`still/${scene}.jpg`, document.baseURI).href;
  picture.alt = view.querySelector("canvas")!.getAttribute("aria-label") ?? "";
  view.prepend(picture);
}

export function hideStill(view: Element): void {
  view.querySelector("img")?.remove();
}
