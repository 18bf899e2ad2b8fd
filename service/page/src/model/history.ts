import type {Result, Run} from '../api/documents.ts';

/** What a trend is drawn of: a parameter's error, or the rms of the held-out distances of a plane. */
export type TrendOf = {kind: 'parameter'; name: string; unit: string} | {kind: 'plane'; plane: number};

export interface TrendPoint { run: number; value: number | null }

/** Over the complete runs whose results are here, oldest first. */
export function trend(runs: Run[], results: Record<string, Result>, of: TrendOf): TrendPoint[] {
  return runs.filter((run) => run.outcome === 'complete' && results[run.id])
      .map((run) => ({run: Number(run.id), value: trendValue(results[run.id]!, of)}))
      .sort((a, b) => a.run - b.run);
}

function trendValue(result: Result, of: TrendOf): number | null {
  if (of.kind === 'parameter') return result.parameters.find(({name}) => name === of.name)?.error ?? null;
  return result.planes_held_out.find(({plane}) => plane === of.plane)?.calibrated_rms_mm ?? null;
}

/** All that a trend can be drawn of. */
export function trendChoices(results: Record<string, Result>): TrendOf[] {
  const parameters = new Map<string, string>();
  const planes = new Set<number>();
  for (const result of Object.values(results)) {
    for (const {name, unit, status} of result.parameters) if (status === 'identified') parameters.set(name, unit);
    for (const {plane} of result.planes_held_out) planes.add(plane);
  }
  return [
    ...[...planes].sort((a, b) => a - b).map((plane): TrendOf => ({kind: 'plane', plane})),
    ...[...parameters].map(([name, unit]): TrendOf => ({kind: 'parameter', name, unit})),
  ];
}

/** A plane's held-out distances in two runs, in mm. */
export interface ComparedPlane { plane: number; a: number | null; b: number | null; difference: number | null }

export function compareHeldOut(a: Result, b: Result): ComparedPlane[] {
  const planes = new Set([...a.planes_held_out, ...b.planes_held_out].map(({plane}) => plane));
  const rms = (result: Result, plane: number): number | null =>
      result.planes_held_out.find((one) => one.plane === plane)?.calibrated_rms_mm ?? null;
  return [...planes].sort((x, y) => x - y).map((plane) => {
    const [first, second] = [rms(a, plane), rms(b, plane)];
    return {plane, a: first, b: second, difference: first === null || second === null ? null : second - first};
  });
}
