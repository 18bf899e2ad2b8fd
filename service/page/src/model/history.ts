import type {Cell, PlaneDistances, Result, Run} from '../api/documents.ts';
import {ownNumber, whereOfPlane, type Where} from './places.ts';

/** What a trend is drawn of: a parameter's error, or the rms of the held-out distances of a plane. */
export type TrendOf = {kind: 'parameter'; name: string; unit: string} | ({kind: 'plane'} & TouchedPlane);

/** The block's own plane: which number it has at a further place depends on what else the run's recipe touched, and with how many tips. */
export interface TouchedPlane extends Where { plane: number }

export interface TrendPoint { run: number; value: number | null }

/** Over the complete runs whose results are here, oldest first. */
export function trend(runs: Run[], results: Record<string, Result>, of: TrendOf, cell: Cell | null): TrendPoint[] {
  return runs.filter((run) => run.outcome === 'complete' && results[run.id])
      .map((run) => ({run: Number(run.id), value: trendValue(results[run.id]!, of, cell)}))
      .sort((a, b) => a.run - b.run);
}

function trendValue(result: Result, of: TrendOf, cell: Cell | null): number | null {
  if (of.kind === 'parameter') return result.parameters.find(({name}) => name === of.name)?.error ?? null;
  return heldOutRms(result, of, cell);
}

function touchedPlane(distances: PlaneDistances, cell: Cell | null): TouchedPlane {
  const where = whereOfPlane(distances);
  return {plane: where.place === null && where.tip === null ? distances.plane : ownNumber(cell, distances.plane), ...where};
}

const keyOf = ({plane, place, tip}: TouchedPlane): string => JSON.stringify([plane, place, tip]);

function heldOutRms(result: Result, of: TouchedPlane, cell: Cell | null): number | null {
  return result.planes_held_out.find((distances) => keyOf(touchedPlane(distances, cell)) === keyOf(of))?.calibrated_rms_mm ?? null;
}

/** The planes with held-out touches, each once, by the numbers that they have first. */
function heldOutPlanes(results: Result[], cell: Cell | null): TouchedPlane[] {
  const planes = results.flatMap(({planes_held_out}) => planes_held_out).sort((a, b) => a.plane - b.plane);
  return [...new Map(planes.map((distances) => touchedPlane(distances, cell)).map((of) => [keyOf(of), of])).values()];
}

/** All that a trend can be drawn of. */
export function trendChoices(results: Record<string, Result>, cell: Cell | null): TrendOf[] {
  const parameters = new Map<string, string>();
  for (const result of Object.values(results)) {
    for (const {name, unit, status} of result.parameters) if (status === 'identified') parameters.set(name, unit);
  }
  return [
    ...heldOutPlanes(Object.values(results), cell).map((of): TrendOf => ({kind: 'plane', ...of})),
    ...[...parameters].map(([name, unit]): TrendOf => ({kind: 'parameter', name, unit})),
  ];
}

/** A plane's held-out distances in two runs, in mm. */
export interface ComparedPlane extends TouchedPlane { a: number | null; b: number | null; difference: number | null }

export function compareHeldOut(a: Result, b: Result, cell: Cell | null): ComparedPlane[] {
  return heldOutPlanes([a, b], cell).map((of) => {
    const [first, second] = [heldOutRms(a, of, cell), heldOutRms(b, of, cell)];
    return {...of, a: first, b: second, difference: first === null || second === null ? null : second - first};
  });
}
