// Reads Parquet files off the page's thread. Answers each request with typed arrays or an error message.
import { decompress } from "fzstd";
import { parquetRead } from "hyparquet";

export type Column = Float64Array | string[];
export interface Request {
  key: number;
  url: string;
  columns?: string[];
}
export interface Answer {
  key: number;
  columns?: Record<string, Column>;
  error?: string;
}

const compressors = { ZSTD: (input: Uint8Array, size: number) => decompress(input, new Uint8Array(size)) };

/** Copies a chunk of a column; a missing number becomes NaN. */
function copy(from: ArrayLike<unknown>, to: Float64Array | string[], at: number): void {
  if (to instanceof Float64Array) {
    for (let i = 0; i < from.length; i++) {
      const value = from[i];
      to[at + i] = value === null || value === undefined ? NaN : Number(value);
    }
  } else {
    for (let i = 0; i < from.length; i++) to[at + i] = String(from[i]);
  }
}

async function read(url: string, columns: string[] | undefined): Promise<Record<string, Column>> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${response.status} ${await response.text()}`);
  const file = await response.arrayBuffer();
  const out: Record<string, Column> = {};
  const chunks = new Map<string, { at: number; data: ArrayLike<unknown> }[]>();
  await parquetRead({
    file,
    columns,
    compressors,
    onChunk: ({ columnName, columnData, rowStart }) => {
      const pieces = chunks.get(columnName) ?? [];
      pieces.push({ at: rowStart, data: columnData as ArrayLike<unknown> });
      chunks.set(columnName, pieces);
    },
  });
  for (const [name, parts] of chunks) {
    const rows = Math.max(...parts.map((part) => part.at + part.data.length));
    const text = parts.some((part) => typeof part.data[0] === "string");
    const column: Column = text ? new Array<string>(rows) : new Float64Array(rows).fill(NaN);
    for (const part of parts) copy(part.data, column, part.at);
    out[name] = column;
  }
  return out;
}

self.onmessage = async ({ data }: MessageEvent<Request>) => {
  const answer: Answer = { key: data.key };
  try {
    answer.columns = await read(data.url, data.columns);
  } catch (error) {
    answer.error = String(error);
  }
  const buffers = Object.values(answer.columns ?? {}).flatMap((column) =>
    column instanceof Float64Array ? [column.buffer as ArrayBuffer] : [],
  );
  self.postMessage(answer, { transfer: buffers });
};
