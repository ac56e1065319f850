// Changes a world by hand in Node, and prints what became of it: node edit.mjs MODULE TEXT [add]
// With `add`, it adds somebody first, and lets a refusal through.
import { make } from "./make.mjs";

const [module, text] = process.argv.slice(2);
const world = await make(module, text);
const told = {};
const refused = (act) => {
  try {
    act();
    return "";
  } catch (error) {
    return error.message;
  }
};
const alive = () => world.number("head.living_count");
const foods = () => world.view("physics.circles.present").reduce((sum, each) => sum + each, 0);
const firstFree = (kind) => {
  for (let x = 20; x < 460; x += 7) {
    for (let y = 20; y < 340; y += 7) if (refused(() => world.add(kind, x, y)) === "") return [x, y];
  }
  return undefined;
};

if (process.argv[4] === "add") world.add(0, 100, 100);
world.runWhole(100);
world.takeDeaths();
told.untouched = world.edited;
world.keep();
world.runWhole(200);
told.first = world.digest();
world.goBack();
told.back = world.number("head.step");
world.runWhole(200);
told.second = world.digest();

told.alive = [alive()];
const place = firstFree(0);
told.alive.push(alive());
told.overlap = refused(() => world.add(0, ...place));
told.wall = refused(() => world.add(0, -5, 3));
told.unknown = refused(() => world.add(99, 50, 50));
told.edited = world.edited;
world.remove(...place, 0);
told.alive.push(alive());
told.death = [Number(world.view("death_log.death_step")[world.number("head.death_log_count") - 1]), world.number("head.step")];
told.foods = [foods()];
const meal = firstFree(1);
told.foods.push(foods());
world.remove(...meal, 0);
told.foods.push(foods());
told.nothing = refused(() => world.remove(-100, -100, 1));

for (let i = 0; i < 5; i++) firstFree(0);
world.runWhole(300); // with learning, and with the audit that looks for anything inconsistent
told.step = world.number("head.step");
while (firstFree(0)) continue;
told.full = refused(() => world.add(0, 200, 200));
while (alive() > 0) {
  const living = world.view("living")[0];
  world.remove(world.view("physics.bodies.x")[living], world.view("physics.bodies.y")[living], 0);
  world.takeDeaths();
}
told.extinct = world.number("head.extinct_step");
told.still = world.run(5);
firstFree(0);
told.again = world.run(5);
world.runWhole(256 - (world.number("head.step") % 256) - 1);
world.run(1);
told.learning = [world.mustLearn, refused(() => world.keep()), refused(() => world.add(0, 100, 100))];
console.log(JSON.stringify(told));
