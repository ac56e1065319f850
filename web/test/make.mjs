// Makes a world in Node, with threads: shared memory, and a worker for each thread but the first.
import { readFileSync } from "node:fs";
import { Worker } from "node:worker_threads";
import { compile, Engine } from "../src/engine.js";

export function hire(post) {
  const worker = new Worker(new URL("./member.mjs", import.meta.url), { workerData: post });
  return new Promise((ready, fail) => {
    worker.once("message", () => ready(() => void worker.terminate()));
    worker.on("error", fail); // after the start it changes nothing: the engine tells what has stopped
  });
}

/** With 0 threads, one thread without shared memory, as in a page that is not isolated. */
export async function make(path, text, threads = 0, how = {}) {
  const shared = threads > 0;
  const module = await compile(new Uint8Array(readFileSync(path)), shared);
  return Engine.make(module, readFileSync(text, "utf8"), { shared, threads: Math.max(threads, 1), hire, ...how });
}
