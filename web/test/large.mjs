// Makes a world of more than 2 GB in Node, runs it a little, and tries to keep it: node large.mjs MODULE TEXT STEPS
import { make } from "./make.mjs";

const [module, text, steps] = process.argv.slice(2);
const world = await make(module, text);
world.run(Number(steps));
const told = { needed: world.bytes, digest: world.digest(), first: Number(world.view("life.agent_id")[0]) };
try {
  world.keep();
} catch (error) {
  told.kept = error.message;
}
told.going = world.run(1);
console.log(JSON.stringify(told));
