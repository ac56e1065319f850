// Runs a world in Node and prints its digest: node digest.mjs MODULE TEXT STEPS [PORTION]
// With PORTION, that many agents learn at a time, as in the page.
import { readFileSync } from "node:fs";
import { Engine } from "../src/engine.js";

const [module, text, steps, portion] = process.argv.slice(2);
const engine = new Engine(new WebAssembly.Module(readFileSync(module)));
const needed = engine.make(readFileSync(text, "utf8"));
const begun = performance.now();
for (let left = Number(steps); left > 0; ) {
  const done = engine.run(left);
  left -= done;
  while (engine.mustLearn) engine.learn(Number(portion ?? 1e9));
  if (done === 0) break;
}
const seconds = (performance.now() - begun) / 1000;
console.log(JSON.stringify({ digest: engine.digest(), step: engine.number("head.step"), seconds, needed }));
