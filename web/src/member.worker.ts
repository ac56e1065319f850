// A thread of the engine.
import { type Post, serve } from "./engine.js";

self.onmessage = ({ data }: MessageEvent<Post>) => serve(data, () => self.postMessage("ready"));
