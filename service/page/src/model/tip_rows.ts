import type {ExpandedTip, Result} from '../api/documents.ts';

/** In whose frame the tip's uncertainty holds, or how it was found. */
export type TipRowName = 'tipBlockFrame' | 'tipArmFrame' | 'tipSimulated';

/** The expanded uncertainty of the tip over the workspace box: root mean square, 95 % and worst. */
export interface TipRow { name: TipRowName; rms_mm: number | null; p95_mm: number | null; worst_mm: number | null }

const rowOf = (name: TipRowName, {box_rms_mm, box_p95_mm, box_max_mm}: ExpandedTip): TipRow =>
    ({name, rms_mm: box_rms_mm, p95_mm: box_p95_mm, worst_mm: box_max_mm});

/**
 * What an integrator asks for first. Simulated calibrations have their standard uncertainty expanded by the same k, the tip
 * error that 95 % of their errors do not exceed, and no worst one. Empty for a result that an older daemon stored.
 */
export function tipRows({tip_uncertainty: {expanded, arm_frame}, monte_carlo}: Result): TipRow[] {
  if (!expanded) return [];
  const rows = [rowOf('tipBlockFrame', expanded)];
  if (arm_frame) rows.push(rowOf('tipArmFrame', arm_frame.expanded));
  if (monte_carlo) {
    const {box_rms_mm, box_p95_mm} = monte_carlo;
    rows.push({name: 'tipSimulated', rms_mm: box_rms_mm === null ? null : expanded.k * box_rms_mm, p95_mm: box_p95_mm, worst_mm: null});
  }
  return rows;
}

/** How far the tip may be off in the workspace box at 95 %, in mm: by simulated calibrations where there are any. Null: not known. */
export function tipWithin_mm({tip_uncertainty: {expanded}, monte_carlo}: Pick<Result, 'tip_uncertainty' | 'monte_carlo'>): number | null {
  return monte_carlo?.box_p95_mm ?? expanded?.box_p95_mm ?? null;
}
