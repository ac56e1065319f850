// Runs a world in Node and prints its digest: node digest.mjs MODULE TEXT STEPS PORTION [THREADS]
// So many agents learn at a time, as in the page. Without THREADS, the memory is not shared.
import { make } from "./make.mjs";

const [module, text, steps, workSlice, threads] = process.argv.slice(2);
const engine = await make(module, text, Number(threads ?? 0));
const begun = performance.now();
for (let left = Number(steps); left > 0; ) {
  const done = engine.run(left);
  left -= done;
  while (engine.mustLearn) engine.learn(Number(workSlice));
  if (done === 0) break;
}
const seconds = (performance.now() - begun) / 1000;
console.log(JSON.stringify({ digest: engine.digest(), step: engine.number("head.step"), seconds, needed: engine.bytes }));
engine.close();
