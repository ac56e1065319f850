// The engine's WebAssembly module as a world that JavaScript can make, run and read. Nothing here depends on a page or on Node.
// @ts-check

/** @typedef {Int8Array | Uint8Array | Int32Array | Uint32Array | Float32Array | Float64Array | BigInt64Array | BigUint64Array} Numbers */

// Addresses are signed numbers; those above 2 GB are negative until `>>> 0`.

/** What the module needs from the system. Only the clock is used. @param {WebAssembly.Memory} memory */
function system(memory) {
  const refused = 52; // WASI's errno for "not supported"
  return new Proxy(
    {
      clock_time_get: (/** @type {number} */ _id, /** @type {bigint} */ _precision, /** @type {number} */ at) => {
        const now = BigInt(Math.round(performance.now() * 1e6));
        new DataView(memory.buffer).setBigUint64(at >>> 0, now, true);
        return 0;
      },
      proc_exit: () => {
        throw new Error("there is no more memory");
      },
    },
    { get: (known, name) => Reflect.get(known, name) ?? (() => refused) },
  );
}

/** An error that the engine reports with a message. */
export class EngineError extends Error {}

/** The same functions, with traps turned into error messages. @param {Record<string, CallableFunction>} exports */
function explained(exports) {
  /** @param {CallableFunction} call */
  const guarded = (call) => (/** @type {unknown[]} */ ...args) => {
    try {
      return call(...args);
    } catch (error) {
      const thread = exports.hedon_stopped() || 1;
      const why = error instanceof Error ? error.message : String(error);
      throw new Error(`the engine stopped in its thread ${thread} (${why}): begin the world again`);
    }
  };
  return Object.fromEntries(Object.entries(exports).map(([name, each]) => [name, typeof each === "function" ? guarded(each) : each]));
}

const PAGE = 65536; // bytes
const FIRST_PAGES = 64; // as the module was linked
const MOST_PAGES = 65535;
const MOST = 4e9; // bytes of a world: the 32-bit address space, less other needs
const SPARE = 64e6; // bytes of memory in addition to a world and its snapshot
const NAP_MS = 100; // a thread's sleep before it checks whether another one was stopped
const SHARED_MEMORY = [3, ...new TextEncoder().encode("env"), 6, ...new TextEncoder().encode("memory"), 2, 3];

/**
 * Compiles these bytes. The module's memory import has a flag for shared memory, and nothing else depends on it. It is
 * set here, because a page that is not isolated cannot share memory. @param {Uint8Array<ArrayBuffer>} bytes @param {boolean} shared
 */
export async function compile(bytes, shared) {
  if (shared) return WebAssembly.compile(bytes);
  const copy = bytes.slice();
  const at = copy.findIndex((_, i) => SHARED_MEMORY.every((byte, k) => copy[i + k] === byte));
  copy[at + SHARED_MEMORY.length - 1] = 1;
  return WebAssembly.compile(copy);
}

/** @param {boolean} shared @param {number} bytes the maximum size */
function memoryOf(shared, bytes) {
  const maximum = Math.min(Math.ceil(bytes / PAGE) + FIRST_PAGES, MOST_PAGES);
  try {
    return new WebAssembly.Memory({ initial: FIRST_PAGES, maximum, shared });
  } catch {
    throw new EngineError(`this browser refuses ${gigabytes(bytes)} of memory: lower population.capacity or world.rollout_steps`);
  }
}

/** @param {number} bytes */
const gigabytes = (bytes) => `${(bytes / 1e9).toFixed(1)} GB`;

/**
 * What a worker needs to serve as a thread of the engine, by calling `serve`.
 * @typedef {{ module: WebAssembly.Module, memory: WebAssembly.Memory, seat: number, stack: number, locals: number }} Post
 * @typedef {(post: Post) => Promise<() => void>} Hire sends a post to a worker, waits until it is ready to serve, and
 * returns a function that dismisses it
 */

/** Serves as a thread of the engine until the worker ends. @param {Post} post @param {() => void} ready */
export function serve({ module, memory, seat, stack, locals }, ready) {
  const exports = instantiate(module, memory);
  /** @type {WebAssembly.Global} */ (/** @type {unknown} */ (exports.__stack_pointer)).value = stack;
  exports.__wasm_init_tls(locals);
  ready();
  try {
    exports.hedon_serve(seat);
  } catch (error) {
    exports.hedon_stop(seat + 2);
    throw error;
  }
}

/** How the threads of a module wait for one another: see engine/base/platform_web.cpp. @param {WebAssembly.Memory} memory */
function waiting(memory) {
  const words = () => new Int32Array(memory.buffer);
  return {
    sleep_while: (/** @type {number} */ at, /** @type {number} */ value) => void Atomics.wait(words(), at >>> 2, value, NAP_MS),
    wake_all: (/** @type {number} */ at) => void Atomics.notify(words(), at >>> 2),
  };
}

/** @param {WebAssembly.Module} module @param {WebAssembly.Memory} memory */
function instantiate(module, memory) {
  const imports = { env: { memory }, page: waiting(memory), wasi_snapshot_preview1: /** @type {any} */ (system(memory)) };
  return /** @type {Record<string, CallableFunction>} */ (/** @type {unknown} */ (new WebAssembly.Instance(module, imports).exports));
}

export class Engine {
  /**
   * @param {WebAssembly.Module} module @param {boolean} [shared] as the module was compiled
   * @param {number} [bytes] that it will need
   */
  constructor(module, shared = false, bytes = 0) {
    this.module = module;
    this.shared = shared;
    this.memory = memoryOf(shared, bytes + SPARE);
    this.exports = explained(instantiate(module, this.memory));
    this.exports._initialize();
    this.threads = 1;
    this.bytes = 0; // of its world
    /** @type {(() => void)[]} */
    this.dismissals = [];
    /** @type {Map<string, [number, number, number, number, number, number]>} */
    this.known = new Map();
  }

  /**
   * Makes an engine with the world of a text (see engine/web/input.h). Refuses a world that needs more than `limit` bytes.
   * @param {WebAssembly.Module} module @param {string} text
   * @param {{ shared?: boolean, threads?: number, hire?: Hire, limit?: number }} [how] more than one thread needs
   * shared memory, and `hire`
   */
  static async make(module, text, { shared = false, threads = 1, hire, limit = MOST } = {}) {
    const planned = new Engine(module, shared).#needOf(text, threads);
    if (planned > limit) {
      throw new EngineError(
        `the world needs ${gigabytes(planned)} of memory, and a page has at most ${gigabytes(limit)}: ` +
          "lower population.capacity or world.rollout_steps",
      );
    }
    const engine = new Engine(module, shared, 2 * planned + threads * 2 ** 21);
    try {
      engine.bytes = engine.#needOf(text, threads);
      for (let seat = 0; seat < threads - 1; seat++) await engine.#hire(seat, /** @type {Hire} */ (hire));
      engine.threads = threads;
      engine.#need(engine.exports.hedon_make(threads));
    } catch (error) {
      engine.close();
      throw error;
    }
    return engine;
  }

  /** Continues the world with the settings of another text; its snapshot is discarded. @param {string} text */
  change(text) {
    this.#needOf(text, this.threads);
    this.#need(this.exports.hedon_change());
    this.known.clear();
  }

  /** Bytes needed by the world of a text, which `hedon_make` can then make. @param {string} text @param {number} threads */
  #needOf(text, threads) {
    const bytes = new TextEncoder().encode(text);
    const at = this.exports.hedon_text(bytes.length) >>> 0;
    new Uint8Array(this.memory.buffer, at, bytes.length).set(bytes);
    this.#need(this.exports.hedon_read());
    return /** @type {number} */ (this.exports.hedon_bytes_needed(threads));
  }

  /** @param {number} seat @param {Hire} hire */
  async #hire(seat, hire) {
    const at = this.exports.hedon_seat() >>> 0;
    if (at === 0) throw new EngineError("there is no room for another thread: ask for fewer");
    const [stack, locals] = new Uint32Array(this.memory.buffer, at, 2);
    const { module, memory } = this;
    try {
      this.dismissals.push(await hire({ module, memory, seat, stack: /** @type {number} */ (stack), locals: /** @type {number} */ (locals) }));
    } catch (error) {
      const why = error instanceof Error ? error.message : String(error);
      throw new EngineError(`thread ${seat + 2} of the engine cannot start (${why}): put threads=1 into the page's link`);
    }
  }

  /** Ends all threads; the world is gone. */
  close() {
    for (const dismiss of this.dismissals.splice(0)) dismiss();
  }

  /** Whether multiply-adds are fused, in which case digests match AVX2 and AVX-512. */
  get fuses() {
    return this.exports.hedon_fuses(1 + 2 ** -12) === 1;
  }

  /** Runs until `steps` are done, a window must be learned, or the world has ended. @param {number} steps */
  run(steps) {
    const done = this.exports.hedon_run(steps);
    this.#need(this.exports.hedon_fault());
    return done;
  }

  /** Runs `steps` steps, including all learning. @param {number} steps */
  runWhole(steps) {
    for (let left = steps; left > 0; ) {
      const done = this.run(left);
      left -= done;
      if (this.mustLearn) this.learn(1e9);
      else if (done === 0) return;
    }
  }

  get mustLearn() {
    return this.exports.hedon_must_learn() === 1;
  }

  /** Trains up to `count` learners; returns how many are left. @param {number} count */
  learn(count) {
    const left = this.exports.hedon_learn(count);
    if (left === 0) this.#need(this.exports.hedon_fault());
    return left;
  }

  /** The digest as `hedon run` prints it. */
  digest() {
    return BigInt.asUintN(64, this.exports.hedon_digest()).toString(16).padStart(16, "0");
  }

  /** Adds an agent or a food by hand: a species by its index, or a food by its index after all species.
   * @param {number} type @param {number} x @param {number} y */
  add(type, x, y) {
    this.#need(this.exports.hedon_add(type, x, y));
  }

  /** Removes by hand whatever is at a place, or at most `slack` away. @param {number} x @param {number} y @param {number} slack */
  remove(x, y, slack) {
    this.#need(this.exports.hedon_remove(x, y, slack));
  }

  /** Whether the world has been edited by hand. */
  get edited() {
    return this.exports.hedon_edited() === 1;
  }

  /** Takes a snapshot of the world, which replaces the previous one. */
  keep() {
    this.#need(this.exports.hedon_keep());
  }

  /** Restores the snapshot. */
  goBack() {
    this.#need(this.exports.hedon_return());
  }

  takeDeaths() {
    this.exports.hedon_take_deaths();
  }

  /** An array of the state, or undefined. Columns of structs are copied; others are views, valid until the next `run`.
   * @param {string} name @returns {Numbers | undefined} */
  view(name) {
    const place = this.#place(name);
    if (!place) return undefined;
    const [address, count, stride, bytes, real, sign] = place;
    const type = numbers(bytes, real, sign);
    if (stride === bytes) return new type(this.memory.buffer, address, count);
    const step = stride / bytes;
    const whole = new type(this.memory.buffer, address, (count - 1) * step + 1);
    const out = new type(count);
    for (let i = 0; i < count; i++) out[i] = whole[i * step];
    return out;
  }

  /** The first number of an array, as a plain number. @param {string} name */
  number(name) {
    const place = this.#place(name);
    if (!place) throw new EngineError(`no array '${name}'`);
    return Number(new (numbers(place[3], place[4], place[5]))(this.memory.buffer, place[0], 1)[0]);
  }

  /** The sum of an array, as a plain number. @param {string} name */
  sum(name) {
    const values = this.view(name);
    if (!values) throw new EngineError(`no array '${name}'`);
    let sum = 0;
    for (const value of values) sum += Number(value);
    return sum;
  }

  /** Index of the first food of a kind among `physics.circles`. @param {number} kind */
  foodStart(kind) {
    return /** @type {number} */ (this.exports.hedon_food_start(kind));
  }

  /** What the agent in a slot senses now, and its network's output. @param {number} slot */
  probeAgent(slot) {
    const at = this.exports.hedon_probe(slot) >>> 0;
    const { buffer } = this.memory;
    const parts = new Uint32Array(buffer, at, 4);
    const [reading, type, output, observed] = /** @type {[number, number, number, number]} */ ([...parts]);
    return {
      reading: new Float32Array(buffer, reading, 32).slice(),
      type: new Uint8Array(buffer, type, 32).slice(),
      output: new Float32Array(buffer, output, 3).slice(),
      observed: new Float32Array(buffer, observed, 32).slice(),
    };
  }

  /** @param {string} name */
  #place(name) {
    const known = this.known.get(name);
    if (known) return known;
    const bytes = new TextEncoder().encode(name);
    const at = this.exports.hedon_path(bytes.length) >>> 0;
    new Uint8Array(this.memory.buffer, at, bytes.length).set(bytes);
    const address = this.exports.hedon_view() >>> 0;
    if (address === 0) return undefined;
    const place = /** @type {[number, number, number, number, number, number]} */ ([
      ...new Int32Array(this.memory.buffer, address, 6),
    ]);
    place[0] >>>= 0;
    this.known.set(name, place);
    return place;
  }

  /** @param {number} status */
  #need(status) {
    if (status === 0) return;
    const from = new Uint8Array(this.memory.buffer, this.exports.hedon_message() >>> 0);
    throw new EngineError(new TextDecoder().decode(from.slice(0, from.indexOf(0))));
  }
}

/** @param {number} bytes @param {number} real @param {number} sign @returns {any} */
function numbers(bytes, real, sign) {
  if (real) return bytes === 8 ? Float64Array : Float32Array;
  if (bytes === 8) return sign ? BigInt64Array : BigUint64Array;
  if (bytes === 4) return sign ? Int32Array : Uint32Array;
  return sign ? Int8Array : Uint8Array;
}
