// Names without hashes, so that a rebuilt page can be compared with the one in the package file by file.
import { readFileSync } from "node:fs";
import { defineConfig } from "vite";

// What page and article share is one file; Vite would name it after any of its modules, and the name is in `single.py`.
const output = {
  entryFileNames: "assets/[name].js",
  chunkFileNames: "assets/shared.js",
  assetFileNames: "assets/[name][extname]",
};

/** Puts the text of each scene of the article where its page names it. */
const scenes = {
  name: "scenes",
  transformIndexHtml: {
    order: "pre",
    handler: (html) => html.replace(/<!-- scene (\w+) -->/g, (_, name) => readFileSync(new URL(`src/story/${name}.html`, import.meta.url), "utf8").trimEnd()),
  },
};

export default defineConfig({
  base: "./",
  plugins: [scenes],
  build: { target: "es2022", modulePreload: false, rollupOptions: { input: ["index.html", "story.html"], output } },
  worker: { format: "es", rollupOptions: { output } },
});
