// A place in the article as an address: the scene, what differs from its config, the seed, the step, and what it was there.

export interface Place {
  scene: string;
  seed: number;
  step: number;
  digest: string; // its first digits; "" for none
  changes: Map<string, string>; // settings by path, with another value than the scene's config
  notes: Map<string, string>; // what else a scene keeps, by a name without a dot
}

export const SHORT = 8; // digits of a digest that a link has
const OWN = new Set(["scene", "seed", "step", "digest"]);

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

/** The place of an address; undefined if it names none. Paths of settings have dots, notes have none. */
export function placeOf(address: string): Place | undefined {
  const link = new URLSearchParams(address.replace(/^#/, ""));
  const scene = link.get("scene");
  if (!scene) return undefined;
  const rest = [...link].filter(([name]) => !OWN.has(name));
  return {
    scene,
    seed: whole(link.get("seed"), 1),
    step: whole(link.get("step"), 0),
    digest: link.get("digest") ?? "",
    changes: new Map(rest.filter(([name]) => name.includes("."))),
    notes: new Map(rest.filter(([name]) => !name.includes("."))),
  };
}

function whole(text: string | null, otherwise: number): number {
  return text !== null && /^\d{1,15}$/.test(text) ? Number(text) : otherwise;
}
