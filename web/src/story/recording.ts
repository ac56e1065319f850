// The recording at the top of the article: the agents and foods at each moment, and their positions. Written by `web/hero.py`.

interface Head {
  width: number;
  height: number;
  radius: number;
  foodRadius: number;
  every: number; // steps between two moments
  moments: number;
  limit: number; // largest absolute value of a feeling
  columns: Record<string, number>; // length of each column
}

/** An agent of the recording: its genes, and its positions from moment `first` on. */
export interface Actor {
  first: number;
  feeling: number;
  neutral: number;
  x: Int16Array;
  y: Int16Array;
}

export interface Morsel {
  first: number;
  count: number;
  x: number;
  y: number;
}

export interface Recording {
  head: Head;
  actors: Actor[];
  foods: Morsel[]; // in the order of their first moments
}

const GENE = 127; // integer that stands for the limit of a feeling

export async function load(address: string): Promise<Recording> {
  const answer = await fetch(address);
  if (!answer.ok || !answer.body) throw new Error(`${address}: ${answer.status} ${answer.statusText}`);
  const bytes = await new Response(answer.body.pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
  return decode(new Uint8Array(bytes));
}

export function decode(bytes: Uint8Array): Recording {
  const end = bytes.indexOf(10);
  const head = JSON.parse(new TextDecoder().decode(bytes.subarray(0, end))) as Head;
  let at = end + 1;
  const column: Record<string, Int16Array> = {};
  for (const [name, count] of Object.entries(head.columns)) {
    column[name] = Int16Array.from({ length: count }, (_, i) => bytes[at + i]! | (bytes[at + count + i]! << 8));
    at += 2 * count;
  }
  const { first, count, feeling, neutral, x, y, foodFirst, foodCount, foodX, foodY } = column as Record<string, Int16Array>;
  let from = 0;
  const actors = Array.from(first!, (born, i): Actor => {
    const to = from + count![i]!;
    const path = { x: summed(x!.subarray(from, to)), y: summed(y!.subarray(from, to)) };
    from = to;
    return { first: born, feeling: (feeling![i]! * head.limit) / GENE, neutral: (neutral![i]! * head.limit) / GENE, ...path };
  });
  const grown = summed(foodFirst!);
  const foods = Array.from(grown, (born, i): Morsel => ({ first: born, count: foodCount![i]!, x: foodX![i]!, y: foodY![i]! }));
  return { head, actors, foods };
}

function summed(steps: Int16Array): Int16Array {
  let sum = 0;
  return steps.map((step) => (sum += step));
}
