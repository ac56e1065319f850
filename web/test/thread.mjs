// Prints what is said where a world cannot have its threads, or loses one: node thread.mjs MODULE TEXT
import { hire, make } from "./make.mjs";

const [module, text] = process.argv.slice(2);
const told = {};
async function refused(name, act) {
  try {
    await act();
  } catch (error) {
    told[name] = error.message;
  }
}

await refused("memory", () => make(module, text, 2, { limit: 1e6 }));
await refused("start", () => make(module, text, 2, { hire: () => Promise.reject(new Error("its program cannot be loaded")) }));
await refused("many", () => make(module, text, 18));

// A thread whose stack lies outside of the memory is stopped as soon as it works.
const world = await make(module, text, 3, { hire: (post) => hire(post.seat === 1 ? { ...post, stack: 0 } : post) });
await refused("stopped", () => world.run(10));
world.close();

const again = await make(module, text, 3);
told.again = again.run(10);
again.close();
console.log(JSON.stringify(told));
