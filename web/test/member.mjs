// A thread of the engine in Node.
import { parentPort, workerData } from "node:worker_threads";
import { serve } from "../src/engine.js";

serve(workerData, () => parentPort.postMessage("ready"));
