// Entry point of the page.
import "./style.css";
import { App } from "./app";
import { bindButtons, bindKeys } from "./control";
import { bindGestures } from "./gesture";
import { Notice } from "./notice";
import { recallTheme } from "./preference";

recallTheme();

async function begin(): Promise<void> {
  const app = new App();
  Object.assign(window, { hedon: app }); // for the browser's console, and for tests
  bindButtons(app);
  await app.open();
  bindKeys(app);
  bindGestures(app);
}

begin().catch((error: unknown) => new Notice().show(error instanceof Error ? error.message : String(error), { "Load the page again": () => location.reload() }));
