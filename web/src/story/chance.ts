// The probabilities of death and of having a child per step, as in the model (`hedon.config.schema.life`).
import { styleColor } from "../element";
import { Chart } from "./chart";
import type { Stage } from "./stage";

const MOST_ENERGY = 40; // of the plot
const POINTS = 80; // of a curve

export function hazard(stage: Stage, energy: number, age: number): number {
  const of = (name: string) => stage.value(`hazard.${name}`);
  const odds = of("alpha_energy") * Math.exp(-of("beta_energy") * energy);
  return (of("kappa") * odds) / (1 + odds) + of("alpha_age") * Math.exp(of("beta_age") * age);
}

export function birth(stage: Stage, energy: number): number {
  const of = (name: string) => stage.value(`birth.${name}`);
  return of("kappa") / (1 + Math.exp(of("logit_offset") - of("beta") * energy));
}

/** Makes a function that plots both probabilities for a newborn over its energy. */
export function chances(canvas: HTMLCanvasElement): (stage: Stage) => void {
  const per = { low: 0, high: 1, label: "expected per 1,000 steps" };
  const chart = new Chart(canvas, { low: 0, high: MOST_ENERGY, label: "energy" }, per);
  return (stage) => {
    const curve = (of: (energy: number) => number) => Array.from({ length: POINTS + 1 }, (_, i): [number, number] => [(i * MOST_ENERGY) / POINTS, 1000 * of((i * MOST_ENERGY) / POINTS)]);
    const [death, child] = [curve((energy) => hazard(stage, energy, 0)), curve((energy) => birth(stage, energy))];
    per.high = Math.max(0.5, Math.ceil(2.4 * Math.max(death[0]![1], child[POINTS]![1])) / 2);
    const [red, green] = [styleColor("--death"), styleColor("--birth")];
    chart.begin();
    chart.line(death, red);
    chart.line(child, green);
    chart.text("deaths", 1.5, death[0]![1] + per.high * 0.04, red);
    chart.text("children", MOST_ENERGY - 1.5, child[POINTS]![1] + per.high * 0.04, green, "right");
  };
}
