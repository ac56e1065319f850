// Keys, mouse and touch: everything can also be done from the keyboard.
import type { App } from "./app";
import { by } from "./element";

export function bindKeys(app: App): void {
  const keys: Record<string, (event: KeyboardEvent) => void> = {
    " ": () => app.play(!app.playing),
    ArrowRight: (event) => app.step(event.shiftKey ? 10 : 1),
    ArrowLeft: (event) => app.step(event.shiftKey ? -10 : -1),
    Home: () => app.seek(app.source.first),
    End: () => app.seek(app.source.last),
    "+": () => app.faster(1),
    "-": () => app.faster(-1),
    f: () => (app.arena.follow = !app.arena.follow),
    r: () => by("show-rays").click(),
    t: () => by("show-trail").click(),
    n: () => next(app),
    a: () => app.tab("agent"),
    p: () => app.tab("plots"),
    s: () => app.tab("settings"),
    w: () => app.tab("world-panel"),
    "0": () => app.arena.fit(app.source),
    "?": () => app.help(),
    Escape: () => app.choose(-1),
  };
  document.addEventListener("keydown", (event) => {
    const target = event.target as HTMLElement;
    if (/^(INPUT|SELECT|TEXTAREA)$/.test(target.tagName) || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === " " && target.tagName === "BUTTON") return;
    const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act) return;
    event.preventDefault();
    act(event);
  });
}

function next(app: App): void {
  const ids = app.frame?.id;
  if (!ids || ids.length === 0) return;
  app.choose(ids.find((id) => id > app.chosen) ?? ids[0]!);
}

export function bindMouse(app: App): void {
  const { scene } = app.arena;
  const { canvas } = scene;
  let from: { x: number; y: number; moved: number } | undefined;
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    from = { x: event.clientX, y: event.clientY, moved: 0 };
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!from) return;
    const [ax, ay] = scene.toWorld(from.x, from.y);
    const [bx, by_] = scene.toWorld(event.clientX, event.clientY);
    from.moved += Math.abs(event.clientX - from.x) + Math.abs(event.clientY - from.y);
    [from.x, from.y] = [event.clientX, event.clientY];
    if (from.moved < 4) return;
    scene.centerX += ax - bx;
    scene.centerY += ay - by_;
    app.arena.follow = false;
  });
  canvas.addEventListener("pointerup", (event) => {
    const clicked = from !== undefined && from.moved < 4;
    from = undefined;
    if (clicked) app.click(...scene.toWorld(event.clientX, event.clientY));
  });
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const [x, y] = scene.toWorld(event.clientX, event.clientY);
      const factor = Math.exp(-event.deltaY * 0.0015);
      scene.zoom = Math.min(Math.max(scene.zoom * factor, 0.02), 60);
      scene.centerX = x - (x - scene.centerX) / factor;
      scene.centerY = y - (y - scene.centerY) / factor;
    },
    { passive: false },
  );
}
