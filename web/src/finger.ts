// A finger moving sideways on a plot drags like a mouse. Moving up and down scrolls the page, which the style sheet allows.

const SIDEWAYS = 8; // pixels after which a touch is a drag

export function dragByFinger(over: HTMLElement): void {
  let start: PointerEvent | undefined;
  let dragging = false;
  const act = (type: string, { clientX, clientY }: PointerEvent) =>
    over.dispatchEvent(new MouseEvent(type, { clientX, clientY, bubbles: true, movementX: 1 })); // the chart ignores moves of zero length
  const end = (event: PointerEvent) => {
    if (start && dragging) act("mouseup", event);
    start = undefined;
  };
  over.addEventListener("pointerdown", (event) => {
    if (event.pointerType !== "touch" || !event.isPrimary) return;
    [start, dragging] = [event, false];
  });
  over.addEventListener("pointermove", (event) => {
    if (!start || event.pointerId !== start.pointerId) return;
    if (!dragging && Math.abs(event.clientX - start.clientX) > SIDEWAYS) {
      dragging = true;
      act("mousedown", start);
    }
    if (dragging) act("mousemove", event);
  });
  over.addEventListener("pointerup", end);
  over.addEventListener("pointercancel", () => {
    if (start && dragging) act("mousemove", start); // back to where it began, so that it selects nothing
    if (start) end(start);
  });
}
