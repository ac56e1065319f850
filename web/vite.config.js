// Names without hashes, so that a rebuilt page can be compared with the one in the package file by file.
import { defineConfig } from "vite";

const output = {
  entryFileNames: "assets/[name].js",
  chunkFileNames: "assets/[name].js",
  assetFileNames: "assets/[name][extname]",
};

export default defineConfig({
  base: "./",
  build: { target: "es2022", modulePreload: false, rollupOptions: { output } },
  worker: { format: "es", rollupOptions: { output } },
});
