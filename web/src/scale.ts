// The ends of a color scale, from all known data of a world, so that they stay the same over time.
import { columnOf } from "./series";
import type { Source } from "./source";
import type { Frame, Life } from "./types";

const SHARE = 0.95; // share of the lives that are within the ends; the few beyond have the color of an end
const SAMPLE = 2000; // maximum number of lives examined
const STEPS = 64; // of a live world between two updates
const ABOVE_MEAN = 2.5;
const ROUND = [1, 1.5, 2, 3, 4, 5, 6, 8, 10];

/** The smallest easily read number that is not below a value. */
export function roundUp(value: number): number {
  if (!(value > 0)) return 0;
  const size = 10 ** Math.floor(Math.log10(value));
  return size * (ROUND.find((each) => each * size >= value * (1 - 1e-9)) ?? 10);
}

/** The quantile of some values at a share; NaN if there are none. */
export function quantile(values: number[], share: number): number {
  const sorted = values.filter(Number.isFinite).sort((a, b) => a - b);
  return sorted[Math.min(Math.floor(share * sorted.length), sorted.length - 1)] ?? NaN;
}

function ofLives(source: Source, measure: (life: Life) => number): number {
  const [stride, values] = [Math.ceil(source.lives.size / SAMPLE), [] as number[]];
  let i = 0;
  for (const life of source.lives.all()) if (i++ % stride === 0) values.push(Math.abs(measure(life)));
  return quantile(values, SHARE);
}

/** A multiple of the highest mean so far over all species, or of the current mean if the world has just begun. Few agents have more. */
function ofEnergy(source: Source, frame: Frame): number {
  const { layout, series } = source;
  const columns = layout.species.map((each) => ["energy_mean", "alive"].map((name) => series.get(columnOf(layout, each, name))) as [number[], number[]]);
  const mean = (row: number): number => {
    const known = columns.filter(([mean, alive]) => mean[row]! * alive[row]! > 0);
    return known.reduce((sum, [mean, alive]) => sum + mean[row]! * alive[row]!, 0) / known.reduce((sum, [, alive]) => sum + alive[row]!, 0);
  };
  const now = frame.energy.reduce((sum, each) => sum + each, 0) / Math.max(frame.energy.length, 1);
  const highest = series.step.reduce((most, _, row) => Math.max(most, mean(row) || 0), series.step.length > 0 ? 0 : now);
  return Math.min(roundUp(ABOVE_MEAN * highest), layout.energy_capacity);
}

/** Makes a function that gives the ends of a scale from 0, or around 0, for a measure of lives; without a measure, for energy. */
export function scaleOf(name: string, around = false, measure?: (life: Life) => number): (source: Source, frame: Frame) => [number, number] {
  const least = name === "reward" || around ? 1e-3 : 1;
  let [seen, end] = ["", 0];
  return (source, frame) => {
    const { lives, series } = source;
    const key = `${lives.size} ${series.step.length} ${source.live ? Math.floor(source.last / STEPS) : ""}`;
    if (key !== seen) {
      const fresh = measure ? roundUp(ofLives(source, measure)) : ofEnergy(source, frame);
      end = Math.max(fresh, least, source.live ? end : 0); // the scale of a running world only widens
      seen = key;
    }
    return [around ? -end : 0, end];
  };
}
