import type {Status} from '../api/documents.ts';

/** What a touch brought, as the status told it: a point of the run's curves. */
export interface SeriesPoint {
  touch: number;
  rank: number | null;
  condition_number: number | null;
  predicted_tip_rms_mm: number | null;
}

/** The curves of one run over its touches. */
export interface Series {
  run_id: string | null;
  points: SeriesPoint[];  // by touch, each once
}

export const kNoSeries: Series = {run_id: null, points: []};

/** A run has at most some hundreds of touches; a daemon that says otherwise does not fill this browser. */
const kPointsMax = 5000;

export function addToSeries(series: Series, status: Status): Series {
  const base = series.run_id === status.run_id ? series : {run_id: status.run_id, points: []};
  if (!status.run_id || status.touches_done < 1) return base;
  const point: SeriesPoint = {
    touch: status.touches_done,
    rank: status.identifiable_count,
    condition_number: status.condition_number,
    predicted_tip_rms_mm: status.predicted_tip_rms_mm,
  };
  const last = base.points[base.points.length - 1];
  if (last && isSame(last, point)) return base;
  if (!last || last.touch < point.touch) return {...base, points: [...base.points, point].slice(-kPointsMax)};
  const points = base.points.filter((known) => known.touch !== point.touch);
  points.push(point);
  points.sort((a, b) => a.touch - b.touch);
  return {...base, points};
}

function isSame(a: SeriesPoint, b: SeriesPoint): boolean {
  return a.touch === b.touch && a.rank === b.rank && a.condition_number === b.condition_number &&
      a.predicted_tip_rms_mm === b.predicted_tip_rms_mm;
}
