// A guess before the answer: a choice or a number that the reader commits to, and the answer shown afterwards.
import { show } from "../element";

/** Binds the `fieldset.guess` of a scene; `answer` shows the answer. */
export function bindGuess(section: HTMLElement): { value: () => string; answer: (text: string) => void } {
  const box = section.querySelector<HTMLFieldSetElement>("fieldset.guess")!;
  const answer = box.querySelector<HTMLElement>(".answer")!;
  let value = "";
  const take = (event: Event) => (value = (event.target as HTMLInputElement).value);
  box.addEventListener("change", take);
  const slider = box.querySelector<HTMLInputElement>("input[type=range]");
  slider?.addEventListener("click", take); // so that a guess can keep the slider where it is
  slider?.addEventListener("keydown", (event) => event.key === "Enter" && take(event));
  slider?.addEventListener("input", () => (box.querySelector("output")!.textContent = show(Number(slider.value))));
  return {
    value: () => value,
    answer: (text) => {
      answer.hidden = text === "";
      answer.textContent = text;
    },
  };
}
