// Sliders of settings, and the numbers in the text that follow them: the markup names the paths, this binds them.
import { show } from "../element";
import type { Stage } from "./stage";

/**
 * Binds every `input[data-path]` of a scene to its world, and every `[data-of]` in its text to a setting. While a slider moves the
 * numbers follow; when it rests the world begins again. `said` has how the value of a path is told beside its slider, if not as a number.
 */
export function bindKnobs(section: HTMLElement, stage: Stage, begin: () => void, said: Record<string, (value: number) => string> = {}): () => void {
  const knobs = [...section.querySelectorAll<HTMLInputElement>("input[data-path]")];
  const paths = (knob: HTMLInputElement) => knob.dataset.path!.split(" ");
  const tell = (knob: HTMLInputElement, value: number) => {
    const text = show(value, 5);
    knob.parentElement!.querySelector("output")!.textContent = said[paths(knob)[0]!]?.(value) ?? text;
    for (const path of paths(knob)) {
      for (const each of section.querySelectorAll(`[data-of="${CSS.escape(path)}"]`)) each.textContent = text;
    }
  };
  const read = () => {
    for (const knob of knobs) {
      const value = stage.value(paths(knob)[0]!);
      knob.value = String(value);
      tell(knob, value); // which a link may set to what lies between two places of the slider
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
