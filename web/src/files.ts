// Addresses of the page's other files, which are on its server or, if the page is a single file, within it.

declare global {
  var hedonFiles: Record<string, string> | undefined; // addresses by name; `single.js` sets them
}

const within = (name: string): string | undefined => globalThis.hedonFiles?.[name];

export const isSingleFile = (): boolean => globalThis.hedonFiles !== undefined;

export const fileAddress = (name: string): string => within(name) ?? new URL(name, document.baseURI).href;

/** Creates a worker that runs a world. */
export function liveWorker(): Worker {
  const address = within("assets/live.worker.js");
  return address ? new Worker(address) : new Worker(new URL("./live.worker.ts", import.meta.url), { type: "module" });
}
