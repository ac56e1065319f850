// A guess before the answer: a choice or a number that a reader commits to, and what is shown afterwards.

/** Binds the `fieldset.guess` of a scene; the answer shows when it is told. */
export function bindGuess(section: HTMLElement): { value: () => string; answer: (text: string) => void } {
  const box = section.querySelector<HTMLFieldSetElement>("fieldset.guess")!;
  const answer = box.querySelector<HTMLElement>(".answer")!;
  let value = "";
  const take = (event: Event) => (value = (event.target as HTMLInputElement).value);
  box.addEventListener("change", take);
  const slider = box.querySelector<HTMLInputElement>("input[type=range]");
  slider?.addEventListener("click", take); // so that it can be left where it is
  slider?.addEventListener("keydown", (event) => event.key === "Enter" && take(event));
  slider?.addEventListener("input", () => (box.querySelector("output")!.textContent = Number(slider.value).toLocaleString("en-US")));
  return {
    value: () => value,
    answer: (text) => {
      answer.hidden = text === "";
      answer.textContent = text;
    },
  };
}
