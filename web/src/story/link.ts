// A place in the article as an address: the scene, what differs from its config, the seed, the step, and what it was there.

export interface Place {
  scene: string;
  seed: number;
  step: number;
  digest: string; // its first digits; "" for none
  changes: Map<string, string>; // settings by path, with another value than the scene's config
  notes: Map<string, string>; // what else a scene keeps, by a name without a dot
  damage?: string; // what a link can never have, in words
}

export const SHORT = 8; // digits of a digest that a link has
const OWN = new Set(["scene", "seed", "step", "digest"]);
const WHOLE = /^\d{1,15}$/;
/** What a link may have besides settings, and the form of each. */
const FORMS: Record<string, RegExp> = {
  scene: /^/,
  seed: WHOLE,
  step: WHOLE,
  digest: /^[0-9a-f]{8}$/,
  steer: /^([.fblrqe]\d{1,7})*$/,
  agent: WHOLE,
  world: /^/,
  guess: /^-?\d+(\.\d+)?(_-?\d+(\.\d+)?){10}$/,
};

export function addressOf({ scene, seed, step, digest, changes, notes }: Place): string {
  const link = new URLSearchParams({ scene, seed: String(seed), step: String(step) });
  for (const [name, value] of [...notes, ...changes]) link.set(name, value);
  if (digest) link.set("digest", digest.slice(0, SHORT));
  return `#${link}`;
}

/** Copies the page's address, and says so for a moment in the link that was clicked. */
export function copyAddress(link: HTMLAnchorElement): void {
  void navigator.clipboard?.writeText(location.href).catch(() => {}); // a browser may refuse; the address has it too
  link.textContent = "link copied";
  setTimeout(() => (link.textContent = "link"), 1500);
}

/** The place of an address, also of a damaged one; undefined if it names none. Paths of settings have dots, notes have none. */
export function placeOf(address: string): Place | undefined {
  const link = new URLSearchParams(address.replace(/^#/, ""));
  const scene = link.get("scene");
  if (!scene) return undefined;
  const rest = [...link].filter(([name]) => !OWN.has(name));
  return {
    scene,
    seed: Number(link.get("seed") ?? 1),
    step: Number(link.get("step") ?? 0),
    digest: link.get("digest") ?? "",
    changes: new Map(rest.filter(([name]) => name.includes("."))),
    notes: new Map(rest.filter(([name]) => !name.includes("."))),
    damage: damageOf(link),
  };
}

/** What is wrong with the form of a link, or "". One that names its scene alone is whole. */
function damageOf(link: URLSearchParams): string {
  const short = (text: string) => (text.length > 40 ? `${text.slice(0, 40)}…` : text);
  for (const [name, value] of link) {
    if (name.includes(".")) continue;
    if (!Object.hasOwn(FORMS, name)) return `nothing in it is called ${short(name)}`;
    if (!FORMS[name]!.test(value)) return `it has ${name}=${short(value)}`;
    if (link.getAll(name).length > 1) return `it has ${name} twice`;
  }
  const missing = [...link].length > 1 && ["seed", "step"].find((name) => !link.has(name));
  return missing ? `it has no ${missing}` : "";
}
