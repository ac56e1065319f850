// The language of the filter line, such as `age > 5000 and w_normal < 0`: its parser and the resulting predicates.
import { show } from "./element";
import type { Measure } from "./measure";

/** Whether an agent matches, given the values of its measures; undefined if that depends on an unknown value. */
export type Filter = (value: (measure: Measure) => number) => boolean | undefined;

type Token = { text: string; kind: "number" | "name" | "sign" };
type Operand = { measure?: Measure; number: number; word?: string };

const TOKEN = /\s*(?:([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)|([A-Za-z_]\w*)|(<=|>=|!=|==|[<>=()])|(\S))/gy;
const COMPARE: Record<string, (a: number, b: number) => boolean> = {
  "<": (a, b) => a < b,
  "<=": (a, b) => a <= b,
  ">": (a, b) => a > b,
  ">=": (a, b) => a >= b,
  "=": (a, b) => a === b,
  "==": (a, b) => a === b,
  "!=": (a, b) => a !== b,
};
const JOINERS = ["and", "or", "not"];
const GRAMMAR = "Use names, numbers, <, <=, >, >=, =, !=, and, or, not and parentheses, as in: age > 5000 and reward < 0";

class FilterError extends Error {}

/** Parses a filter; returns an error message if it is invalid. */
export function parseFilter(text: string, measures: Measure[]): Filter | string {
  try {
    return new Parser(tokens(text), measures).all();
  } catch (error) {
    if (error instanceof FilterError) return error.message;
    throw error;
  }
}

function tokens(text: string): Token[] {
  const typed = text.trimEnd().replaceAll("−", "-"); // a number may be copied from the page
  return [...typed.matchAll(TOKEN)].map(([, number, name, sign, other]): Token => {
    if (other !== undefined) throw new FilterError(`“${other}” cannot be used here. ${GRAMMAR}`);
    if (number !== undefined) return { text: number, kind: "number" };
    return name !== undefined ? { text: name, kind: "name" } : { text: sign!, kind: "sign" };
  });
}

/** The number of letters to change, add or remove to get from one word to another (the edit distance). */
function distance(a: string, b: string): number {
  let row = Array.from({ length: b.length + 1 }, (_, j) => j);
  for (let i = 1; i <= a.length; i++) {
    const next = [i];
    for (let j = 1; j <= b.length; j++) next.push(Math.min(next[j - 1]! + 1, row[j]! + 1, row[j - 1]! + (a[i - 1] === b[j - 1] ? 0 : 1)));
    row = next;
  }
  return row[b.length]!;
}

/** The word of a list that is closest to another one. */
function nearest(word: string, words: string[]): string {
  const away = words.map((each) => distance(word.toLowerCase(), each.toLowerCase()));
  return words[away.indexOf(Math.min(...away))]!;
}

/** A recursive-descent parser: `or` binds weakest, then `and`, then `not`, then comparisons. */
class Parser {
  private at = 0;

  constructor(
    private readonly tokens: Token[],
    private readonly measures: Measure[],
  ) {}

  all(): Filter {
    const filter = this.either();
    const rest = this.tokens[this.at];
    if (!rest) return filter;
    if (rest.text === ")") throw new FilterError("“)” has no “(” before it.");
    const meant = rest.kind === "name" ? ` Did you mean “${nearest(rest.text, ["and", "or"])}”?` : "";
    throw new FilterError(`“${rest.text}” cannot follow a complete comparison: join comparisons with “and” or “or”.${meant}`);
  }

  private either(): Filter {
    return this.joined("or", () => this.both(), true);
  }

  private both(): Filter {
    return this.joined("and", () => this.negated(), false);
  }

  /** Filters joined by a word. The result is `decisive` if any of them is; otherwise it is unknown if any of them is. */
  private joined(word: string, next: () => Filter, decisive: boolean): Filter {
    let left = next();
    while (this.take(word)) {
      const [a, b] = [left, next()];
      left = (value) => {
        const [x, y] = [a(value), b(value)];
        return x === decisive || y === decisive ? decisive : x === undefined || y === undefined ? undefined : !decisive;
      };
    }
    return left;
  }

  private negated(): Filter {
    if (this.take("not")) {
      const inner = this.negated();
      return (value) => {
        const matches = inner(value);
        return matches === undefined ? undefined : !matches;
      };
    }
    if (!this.take("(")) return this.comparison();
    const inner = this.either();
    if (!this.take(")")) throw new FilterError("A “)” is missing.");
    return inner;
  }

  /** One comparison, or a chain such as `100 < age <= 500`. */
  private comparison(): Filter {
    let left = this.operand();
    let filter: Filter | undefined;
    for (;;) {
      const sign = this.tokens[this.at];
      const compare = sign && COMPARE[sign.text];
      if (!compare) break;
      this.at++;
      const [a, b] = [left, this.operand()];
      this.check(a, sign.text, b);
      const [before, words] = [filter, a.measure?.words ?? b.measure?.words];
      const side = ({ measure, number, word }: Operand): ((value: (measure: Measure) => number) => number) => {
        if (measure) return (value) => value(measure);
        const fixed = word === undefined ? number : words!.indexOf(word);
        return () => fixed;
      };
      const [x, y] = [side(a), side(b)];
      filter = (value) => {
        const earlier = before ? before(value) : true;
        const [first, second] = [x(value), y(value)];
        if (earlier !== true || Number.isNaN(first) || Number.isNaN(second)) return earlier === false ? false : undefined;
        return compare(first, second);
      };
      left = b;
    }
    if (filter) return filter;
    const name = left.measure?.name ?? left.word ?? show(left.number);
    throw new FilterError(`“${name}” has to be compared with something, as in: ${left.measure && !left.measure.words ? name : "age"} > 100`);
  }

  private operand(): Operand {
    const token = this.tokens[this.at++];
    if (!token) throw new FilterError("The filter is not complete: a name or a number is missing at its end.");
    if (token.kind === "number") return { number: Number(token.text) };
    const { text } = token;
    if (token.kind === "sign" || JOINERS.includes(text.toLowerCase())) throw new FilterError(`A name or a number is missing before “${text}”.`);
    const measure = this.measures.find(({ name }) => name === text);
    if (measure) return { measure, number: NaN };
    if (this.words().includes(text)) return { word: text, number: NaN };
    throw this.unknown(text);
  }

  private words(): string[] {
    return this.measures.flatMap(({ words }) => words ?? []);
  }

  private unknown(text: string): FilterError {
    const names = this.measures.map(({ name }) => name);
    const columns = this.measures.filter(({ column }) => column).map(({ name }) => name);
    const words = this.words();
    const species = words.length > 0 ? `; species are ${words.join(", ")}` : "";
    return new FilterError(`“${text}” is not a known name. The nearest one is “${nearest(text, [...names, ...words])}”. Columns are ${columns.join(", ")}${species}.`);
  }

  /** Throws unless numbers are compared with numbers, and species with species. */
  private check(a: Operand, sign: string, b: Operand): void {
    const [left, right] = [a, b].map((each) => (each.word ?? each.measure?.words) !== undefined);
    if (left !== right) {
      const [word, other] = left ? [a, b] : [b, a];
      const text = ({ measure, word: name, number }: Operand) => measure?.name ?? name ?? show(number);
      throw new FilterError(`“${text(word!)}” cannot be compared with “${text(other!)}”: one is a species, the other a number.`);
    }
    if (left && !/^(=|==|!=)$/.test(sign)) throw new FilterError(`“${sign}” cannot be used for species: use = or !=, as in: species = ${this.words()[0]}`);
    if (a.word !== undefined && b.word !== undefined) throw new FilterError(`Compare a species with the name species, as in: species = ${a.word}`);
  }

  private take(text: string): boolean {
    const matches = this.tokens[this.at]?.text.toLowerCase() === text;
    if (matches) this.at++;
    return matches;
  }
}
