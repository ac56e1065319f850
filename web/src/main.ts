// Where the page begins.
import "./style.css";
import { App } from "./app";
import { bindKeys, bindMouse } from "./control";
import { by } from "./element";

const app = new App();
Object.assign(window, { hedon: app }); // for a curious person's console, and for tests

async function begin(): Promise<void> {
  await app.open();
  bindKeys(app);
  bindMouse(app);
}

begin().catch((error: unknown) => {
  by("notice").hidden = false;
  by("notice").textContent = error instanceof Error ? error.message : String(error);
});
