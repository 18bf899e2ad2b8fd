import type {Result, Run} from '../api/documents.ts';

/** What a trend is drawn of: a parameter's error, or the rms of the held-out distances of a plane. */
export type TrendOf = {kind: 'parameter'; name: string; unit: string} | ({kind: 'plane'} & TouchedPlane);

/** A plane's number counts on at further places: the same number is another plane in a run at other places. */
export interface TouchedPlane { plane: number; place: string | null }

export interface TrendPoint { run: number; value: number | null }

/** Over the complete runs whose results are here, oldest first. */
export function trend(runs: Run[], results: Record<string, Result>, of: TrendOf): TrendPoint[] {
  return runs.filter((run) => run.outcome === 'complete' && results[run.id])
      .map((run) => ({run: Number(run.id), value: trendValue(results[run.id]!, of)}))
      .sort((a, b) => a.run - b.run);
}

function trendValue(result: Result, of: TrendOf): number | null {
  if (of.kind === 'parameter') return result.parameters.find(({name}) => name === of.name)?.error ?? null;
  return heldOutRms(result, of);
}

function heldOutRms(result: Result, of: TouchedPlane): number | null {
  return result.planes_held_out.find(({plane, place}) => plane === of.plane && (place ?? null) === of.place)?.calibrated_rms_mm ?? null;
}

/** The planes with held-out touches, each once, by their numbers. */
function heldOutPlanes(results: Result[]): TouchedPlane[] {
  const planes = results.flatMap(({planes_held_out}) => planes_held_out.map(({plane, place}): TouchedPlane => ({plane, place: place ?? null})));
  const once = new Map(planes.map((of) => [`${of.plane} ${of.place}`, of]));
  return [...once.values()].sort((a, b) => a.plane - b.plane);
}

/** All that a trend can be drawn of. */
export function trendChoices(results: Record<string, Result>): TrendOf[] {
  const parameters = new Map<string, string>();
  for (const result of Object.values(results)) {
    for (const {name, unit, status} of result.parameters) if (status === 'identified') parameters.set(name, unit);
  }
  return [
    ...heldOutPlanes(Object.values(results)).map((of): TrendOf => ({kind: 'plane', ...of})),
    ...[...parameters].map(([name, unit]): TrendOf => ({kind: 'parameter', name, unit})),
  ];
}

/** A plane's held-out distances in two runs, in mm. */
export interface ComparedPlane extends TouchedPlane { a: number | null; b: number | null; difference: number | null }

export function compareHeldOut(a: Result, b: Result): ComparedPlane[] {
  return heldOutPlanes([a, b]).map((of) => {
    const [first, second] = [heldOutRms(a, of), heldOutRms(b, of)];
    return {...of, a: first, b: second, difference: first === null || second === null ? null : second - first};
  });
}
