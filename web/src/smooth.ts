// A running mean over the rows of a plot.

export const WINDOWS = [1, 5, 20, 100]; // rows; 1 leaves the values as they are

export type Values = (number | null)[];

/** The mean of `window` rows around each row, or of fewer near both ends; null stays null. */
export function smooth(values: Values, window: number): Values {
  if (window === 1) return values;
  const sums = new Float64Array(values.length + 1);
  const counts = new Uint32Array(values.length + 1);
  values.forEach((value, i) => {
    sums[i + 1] = sums[i]! + (value ?? 0);
    counts[i + 1] = counts[i]! + (value === null ? 0 : 1);
  });
  const before = Math.floor(window / 2);
  return values.map((value, i) => {
    const [from, to] = [Math.max(i - before, 0), Math.min(i - before + window, values.length)];
    return value === null ? null : (sums[to]! - sums[from]!) / (counts[to]! - counts[from]!);
  });
}
