// Buttons and keys. Every action is also available from the keyboard.
import type { App } from "./app";
import { by } from "./element";
import { switchTheme } from "./preference";

export function bindButtons(app: App): void {
  const acts: Record<string, () => void> = {
    play: () => app.play(!app.playing),
    "step-on": () => app.step(1),
    "step-back": () => app.step(-1),
    "look-whole": () => app.whole(),
    "look-next": () => app.next(),
    "look-follow": () => app.follow(!app.arena.follow),
    "look-full": () => app.fullScreen(),
    theme: switchTheme,
    "help-button": () => app.help(),
  };
  for (const [name, act] of Object.entries(acts)) by(name).onclick = act;
  by("look-full").hidden = !document.fullscreenEnabled;
  by("speed").onchange = () => app.setSpeed(Number(by<HTMLSelectElement>("speed").value));
  by("show-rays").onchange = () => (app.arena.showRays = by<HTMLInputElement>("show-rays").checked);
  by("show-trail").onchange = () => (app.arena.showTrail = by<HTMLInputElement>("show-trail").checked);
}

/** Whether the focused element uses a key itself, as a list uses arrows and a button uses the space bar. */
function needs(target: HTMLElement, key: string): boolean {
  if (target.closest("dialog") || /^(INPUT|SELECT|TEXTAREA)$/.test(target.tagName)) return true;
  if (key === " " && target.closest("button, summary, a")) return true;
  return /^(Arrow|Home|End)/.test(key) && target.closest("[role=tab]") !== null;
}

export function bindKeys(app: App): void {
  const keys: Record<string, (event: KeyboardEvent) => void> = {
    " ": () => app.play(!app.playing),
    ArrowRight: (event) => app.step(event.shiftKey ? 10 : 1),
    ArrowLeft: (event) => app.step(event.shiftKey ? -10 : -1),
    Home: () => app.seek(app.source.first),
    End: () => app.seek(app.source.last),
    "+": () => app.faster(1),
    "-": () => app.faster(-1),
    f: () => app.follow(!app.arena.follow),
    r: () => by("show-rays").click(),
    t: () => by("show-trail").click(),
    n: () => app.next(),
    a: () => app.tab("agent"),
    l: () => app.tab("agents"),
    p: () => app.tab("plots"),
    s: () => app.tab("settings"),
    w: () => app.tab("world-panel"),
    x: () => app.fullScreen(),
    "0": () => app.whole(),
    "?": () => app.help(),
    Escape: () => app.choose(-1),
  };
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented || needs(event.target as HTMLElement, event.key)) return;
    const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act) return;
    event.preventDefault();
    act(event);
  });
}
