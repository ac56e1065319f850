// Mouse and touch on the arena: click, drag, wheel, and two fingers that move and zoom at once.
import type { App } from "./app";
import type { Place } from "./types";

const STILL = 4; // pixels that a click may move

export function bindGestures(app: App): void {
  const { arena } = app;
  const { canvas } = arena.scene;
  const down = new Map<number, Place>(); // pointers, by id
  let moved = 0; // pixels since the first pointer came down; Infinity once there were two
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, [event.clientX, event.clientY]);
    moved = down.size === 1 ? 0 : Infinity;
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = down.get(event.pointerId);
    if (!last) return;
    const before = span(down);
    down.set(event.pointerId, [event.clientX, event.clientY]);
    const after = span(down);
    moved += Math.abs(event.clientX - last[0]) + Math.abs(event.clientY - last[1]);
    if (moved < STILL) return;
    arena.follow = false;
    arena.drag(before.middle, after.middle, before.width > 0 ? after.width / before.width : 1);
  });
  const lift = (event: PointerEvent) => {
    const clicked = down.delete(event.pointerId) && down.size === 0 && moved < STILL && event.type === "pointerup";
    if (clicked) app.click(...arena.scene.toWorld(event.clientX, event.clientY));
    else if (down.size === 0) app.viewed();
  };
  canvas.addEventListener("pointerup", lift);
  canvas.addEventListener("pointercancel", lift);
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const at: Place = [event.clientX, event.clientY];
      arena.drag(at, at, Math.exp(-event.deltaY * 0.0015));
      app.viewed();
    },
    { passive: false },
  );
}

/** The midpoint of the first two pointers that are down and the distance between them; for one pointer, its place. */
function span(down: Map<number, Place>): { middle: Place; width: number } {
  const [[ax, ay], b] = [...down.values()] as [Place, Place?];
  if (!b) return { middle: [ax, ay], width: 0 };
  return { middle: [(ax + b[0]) / 2, (ay + b[1]) / 2], width: Math.hypot(b[0] - ax, b[1] - ay) };
}
