// An agent's body: the settings of its species, scaled by its genes.
import type { Source } from "./source";
import type { Frame, Species } from "./types";

/** The species of agent `i` of a frame, with the values that its genes set, if they are known. */
export function bodyOf(source: Source, frame: Frame, i: number): Species {
  const common = source.layout.species[frame.species[i]!]!;
  const genome = common.sets.length > 0 ? source.lives.get(frame.id[i]!)?.genome : undefined;
  if (!genome) return common;
  const scaled = (place: string, value: number) => {
    const set = common.sets.find((each) => each.place === place);
    return set ? Math.min(Math.max(value * 10 ** genome[set.gene]!, set.low), set.high) : value;
  };
  return {
    ...common,
    radius: scaled("body.radius", common.radius),
    mouth_degrees: scaled("sensor.mouth_spread", common.mouth_degrees),
    mouth_center_degrees: scaled("sensor.mouth_center", common.mouth_center_degrees),
    rays: {
      ...common.rays,
      spread_degrees: scaled("sensor.ray_spread", common.rays.spread_degrees),
      length: scaled("sensor.ray_length", common.rays.length),
    },
    noses: {
      ...common.noses,
      degrees: scaled("sensor.nose_angle", common.noses.degrees),
      decay: scaled("sensor.smell_decay", common.noses.decay),
    },
  };
}
