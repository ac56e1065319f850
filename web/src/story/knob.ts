// Binds sliders, and numbers in the text, to the settings whose paths the markup names.
import { show } from "../element";
import type { Stage } from "./stage";

/**
 * Binds every `input[data-path]` of a scene to its world, and every `[data-of]` in its text to a setting. The numbers follow a
 * moving slider; once it rests, the world begins again. `formats` gives the text for some paths next to their sliders.
 */
export function bindKnobs(section: HTMLElement, stage: Stage, begin: () => void, formats: Record<string, (value: number) => string> = {}): () => void {
  const knobs = [...section.querySelectorAll<HTMLInputElement>("input[data-path]")];
  const paths = (knob: HTMLInputElement) => knob.dataset.path!.split(" ");
  const tell = (knob: HTMLInputElement, value: number) => {
    const text = show(value, 5);
    knob.parentElement!.querySelector("output")!.textContent = formats[paths(knob)[0]!]?.(value) ?? text;
    for (const path of paths(knob)) {
      for (const each of section.querySelectorAll(`[data-of="${CSS.escape(path)}"]`)) each.textContent = text;
    }
  };
  const read = () => {
    for (const knob of knobs) {
      const value = stage.value(paths(knob)[0]!);
      knob.value = String(value);
      tell(knob, value); // a link may set a value between two positions of the slider
    }
  };
  for (const knob of knobs) {
    knob.addEventListener("input", () => tell(knob, Number(knob.value)));
    knob.addEventListener("change", () => {
      const wrong = stage.set(paths(knob), knob.value);
      knob.setCustomValidity(wrong);
      if (!wrong) begin();
    });
  }
  section.addEventListener("reset", read);
  read();
  return read;
}
