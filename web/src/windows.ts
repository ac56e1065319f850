// The reward of each agent in each window, between two rounds of learning, which shows whether it learns.

/** The living agents at the end of a window, with the reward and the meals of their lives until then. */
export interface WindowEnd {
  step: number;
  id: Int32Array;
  reward: Float32Array;
  meals: Int32Array;
}

/** The part of a life within one window, from one step to another, and the reward in it. */
export interface Earned {
  from: number;
  to: number;
  reward: number;
}

export class Windows {
  private readonly ends = new Map<number, [number, number][]>(); // by agent: step, and the reward up to it

  add({ step, id, reward }: WindowEnd): void {
    id.forEach((agent, i) => {
      const known = this.ends.get(agent);
      if (known) known.push([step, reward[i]!]);
      else this.ends.set(agent, [[step, reward[i]!]]);
    });
  }

  /** The windows of a life that have ended, in order of time. */
  of(agent: number, birth: number): Earned[] {
    let [from, before] = [birth, 0];
    return (this.ends.get(agent) ?? []).map(([to, until]) => {
      const earned = { from, to, reward: until - before };
      [from, before] = [to, until];
      return earned;
    });
  }

  /** Forgets the windows that ended after a step. */
  rewind(step: number): void {
    for (const [agent, known] of this.ends) this.ends.set(agent, known.filter(([each]) => each <= step));
  }
}
