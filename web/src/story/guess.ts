// A guess before the answer: a choice or a number that a reader commits to, and what is shown afterwards.

/** Binds the `fieldset.guess` of a scene: `then` is called once with the value that was chosen; the answer shows when it is told. */
export function bindGuess(section: HTMLElement, then: (value: string) => void = () => {}): { value: () => string; answer: (text: string) => void } {
  const box = section.querySelector<HTMLFieldSetElement>("fieldset.guess")!;
  const answer = box.querySelector<HTMLElement>(".answer")!;
  let value = "";
  box.addEventListener("change", (event) => {
    const input = event.target as HTMLInputElement;
    value = input.value;
    const shown = box.querySelector("output");
    if (shown) shown.textContent = Number(value).toLocaleString("en-US");
    then(value);
  });
  box.addEventListener("input", (event) => {
    const shown = box.querySelector("output");
    if (shown) shown.textContent = Number((event.target as HTMLInputElement).value).toLocaleString("en-US");
  });
  return {
    value: () => value,
    answer: (text) => {
      answer.hidden = text === "";
      answer.textContent = text;
    },
  };
}
