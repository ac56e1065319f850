// The engine's WebAssembly module as a world that JavaScript can make, run and read. No page and no Node in here.
// @ts-check

/** @typedef {Int8Array | Uint8Array | Int32Array | Uint32Array | Float32Array | Float64Array | BigInt64Array | BigUint64Array} Numbers */

/** What the module asks of a system: a clock, and nothing else that is used. @param {() => WebAssembly.Memory} memory */
function system(memory) {
  const refused = 52; // the system's number for "not there"
  return new Proxy(
    {
      clock_time_get: (/** @type {number} */ _id, /** @type {bigint} */ _precision, /** @type {number} */ at) => {
        const now = BigInt(Math.round(performance.now() * 1e6));
        new DataView(memory().buffer).setBigUint64(at, now, true);
        return 0;
      },
      proc_exit: () => {
        throw new Error("the engine stopped: there is no more memory");
      },
    },
    { get: (known, name) => Reflect.get(known, name) ?? (() => refused) },
  );
}

/** A problem that the engine reports in words. */
export class EngineError extends Error {}

export class Engine {
  /** @param {WebAssembly.Module} module */
  constructor(module) {
    const instance = new WebAssembly.Instance(module, {
      wasi_snapshot_preview1: /** @type {any} */ (system(() => this.memory)),
    });
    this.exports = /** @type {Record<string, CallableFunction>} */ (/** @type {unknown} */ (instance.exports));
    this.memory = /** @type {WebAssembly.Memory} */ (instance.exports.memory);
    this.exports._initialize();
    /** @type {Map<string, [number, number, number, number, number, number]>} */
    this.known = new Map();
  }

  /**
   * Makes the world of a text (see engine/web/input.h). Refuses one that needs more than `limit` bytes.
   * @param {string} text @param {number} [limit]
   */
  make(text, limit = 3e9) {
    const bytes = new TextEncoder().encode(text);
    const at = this.exports.hedon_text(bytes.length);
    new Uint8Array(this.memory.buffer, at, bytes.length).set(bytes);
    this.#need(this.exports.hedon_read());
    const needed = this.exports.hedon_bytes_needed();
    if (needed > limit) {
      throw new EngineError(
        `the world needs ${(needed / 1e9).toFixed(1)} GB of memory, and a page has at most ${(limit / 1e9).toFixed(1)} GB: ` +
          "lower population.capacity or learning.rollout_steps",
      );
    }
    this.known.clear();
    this.#need(this.exports.hedon_make());
    return needed;
  }

  /** Whether multiply-adds are fused: then digests are those of AVX2 and AVX-512. */
  get fuses() {
    return this.exports.hedon_fuses(1 + 2 ** -12) === 1;
  }

  /** Steps until `steps` are done, a window must be learned, or the world is over. @param {number} steps */
  run(steps) {
    const done = this.exports.hedon_run(steps);
    this.#need(this.exports.hedon_fault());
    return done;
  }

  /** Runs `steps` steps with all learning. @param {number} steps */
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

  /** Lets some learners learn; returns how many are left. @param {number} count */
  learn(count) {
    const left = this.exports.hedon_learn(count);
    if (left === 0) this.#need(this.exports.hedon_fault());
    return left;
  }

  /** The digest as `hedon run` prints it. */
  digest() {
    return BigInt.asUintN(64, this.exports.hedon_digest()).toString(16).padStart(16, "0");
  }

  /** Adds a thing by hand: a species by its index, or a food by its index after the species.
   * @param {number} type @param {number} x @param {number} y */
  add(type, x, y) {
    this.#need(this.exports.hedon_add(type, x, y));
  }

  /** Takes out by hand what is at a place, or at most `slack` beside it. @param {number} x @param {number} y @param {number} slack */
  remove(x, y, slack) {
    this.#need(this.exports.hedon_remove(x, y, slack));
  }

  /** Whether the world has been changed by hand. */
  get byHand() {
    return this.exports.hedon_by_hand() === 1;
  }

  /** Keeps the world as it is now, instead of the one kept before. */
  keep() {
    this.#need(this.exports.hedon_keep());
  }

  /** Makes the world as it was when it was kept. */
  goBack() {
    this.#need(this.exports.hedon_return());
  }

  takeDeaths() {
    this.exports.hedon_take_deaths();
  }

  /** An array of the state, or undefined. Columns of structs are copied, others are views until the next `run`.
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

  /** What the agent in a slot senses now, and its network's answer. @param {number} slot */
  mind(slot) {
    const at = this.exports.hedon_mind(slot);
    const { buffer } = this.memory;
    return {
      reading: new Float32Array(buffer, at, 32).slice(),
      type: new Uint8Array(buffer, at + 128, 32).slice(),
      dense: new Float32Array(buffer, at + 168, 6).slice(),
      output: new Float32Array(buffer, at + 256, 3).slice(),
    };
  }

  /** @param {string} name */
  #place(name) {
    const known = this.known.get(name);
    if (known) return known;
    const bytes = new TextEncoder().encode(name);
    const at = this.exports.hedon_path(bytes.length);
    new Uint8Array(this.memory.buffer, at, bytes.length).set(bytes);
    const found = this.exports.hedon_view();
    if (found === 0) return undefined;
    const place = /** @type {[number, number, number, number, number, number]} */ ([
      ...new Int32Array(this.memory.buffer, found, 6),
    ]);
    place[0] >>>= 0;
    this.known.set(name, place);
    return place;
  }

  /** @param {number} status */
  #need(status) {
    if (status === 0) return;
    const from = new Uint8Array(this.memory.buffer, this.exports.hedon_message());
    throw new EngineError(new TextDecoder().decode(from.subarray(0, from.indexOf(0))));
  }
}

/** @param {number} bytes @param {number} real @param {number} sign @returns {any} */
function numbers(bytes, real, sign) {
  if (real) return bytes === 8 ? Float64Array : Float32Array;
  if (bytes === 8) return sign ? BigInt64Array : BigUint64Array;
  if (bytes === 4) return sign ? Int32Array : Uint32Array;
  return sign ? Int8Array : Uint8Array;
}
