// A place in the article as an address: the scene, the changes to its config, the seed, the step and the digest there.

export interface Place {
  scene: string;
  seed: number | undefined; // undefined for the scene's first
  step: number;
  digest: string; // its first digits; "" if there is none
  changes: Map<string, string>; // settings that differ from the scene's config, by path
  notes: Map<string, string>; // other state of a scene, by a name without a dot
  damage?: string; // the part that no valid link has, in words
}

export const SHORT = 8; // digits of a digest in a link
const OWN = new Set(["scene", "seed", "step", "digest"]);
const WHOLE = /^\d{1,15}$/;
/** The parameters of a link other than settings, with the form of each. */
const FORMS: Record<string, RegExp> = {
  scene: /^/,
  seed: WHOLE,
  step: WHOLE,
  digest: /^[0-9a-f]{8}$/,
  steer: /^([.fblrqe]\d{1,7})*$/,
  agent: WHOLE,
  world: /^/,
  color: /^(energy|food|moving)$/,
  worlds: /^[1-9]\d?$/,
  guess: /^-?\d+(\.\d+)?(_-?\d+(\.\d+)?){10}$/,
};

export function addressOf({ scene, seed, step, digest, changes, notes }: Place): string {
  const link = new URLSearchParams({ scene, seed: String(seed), step: String(step) });
  for (const [name, value] of [...notes, ...changes]) link.set(name, value);
  if (digest) link.set("digest", digest.slice(0, SHORT));
  return `#${link}`;
}

/** Copies the page's address, and confirms this for a moment in the clicked link. */
export function copyAddress(link: HTMLAnchorElement): void {
  void navigator.clipboard?.writeText(location.href).catch(() => {}); // a browser may refuse, but the address bar has it too
  link.textContent = "link copied";
  setTimeout(() => (link.textContent = "link"), 1500);
}

/** The place of an address, even of a damaged one; undefined if it names none. Paths of settings have dots, notes do not. */
export function placeOf(address: string): Place | undefined {
  const link = new URLSearchParams(address.replace(/^#/, ""));
  const scene = link.get("scene");
  if (!scene) return undefined;
  const rest = [...link].filter(([name]) => !OWN.has(name));
  return {
    scene,
    seed: link.has("seed") ? Number(link.get("seed")) : undefined,
    step: Number(link.get("step") ?? 0),
    digest: link.get("digest") ?? "",
    changes: new Map(rest.filter(([name]) => name.includes("."))),
    notes: new Map(rest.filter(([name]) => !name.includes("."))),
    damage: damageOf(link),
  };
}

/** The error in the form of a link, or "". A link with only a scene is valid. */
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
