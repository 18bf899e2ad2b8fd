import type {Cell, PlaneDistances, Result, Touch, Vector} from '../api/documents.ts';
import {tip_mm} from './kinematics.ts';
import {furtherTip, type Numbering} from './places.ts';

/** How far the touches of a plane lie from it, in one role. */
export interface Residual { mean_mm: number; rms_mm: number; isWithin: boolean }

/** A plane's residuals; null: no such touches yet. */
export interface PlaneResiduals { plane: number; fit: Residual | null; held_out: Residual | null }

/** The residuals of each plane against the cell's limits. */
export function residualsOf(result: Result, cell: Cell): PlaneResiduals[] {
  const {held_out_mean_max_mm: mean_max, held_out_rms_max_mm: rms_max} = cell.acceptance;
  const residual = (list: PlaneDistances[], plane: number): Residual | null => {
    const distances = list.find((one) => one.plane === plane);
    if (!distances || distances.calibrated_mean_mm === null || distances.calibrated_rms_mm === null) return null;
    const mean_mm = distances.calibrated_mean_mm - (distances.estimated_offset_mm ?? distances.reference_mm);
    const rms_mm = distances.calibrated_rms_mm;
    return {mean_mm, rms_mm, isWithin: Math.abs(mean_mm) <= mean_max && rms_mm <= rms_max};
  };
  const planes = new Set([...result.planes, ...result.planes_held_out].map(({plane}) => plane));
  return [...planes].sort((a, b) => a - b)
      .map((plane) => ({plane, fit: residual(result.planes, plane), held_out: residual(result.planes_held_out, plane)}))
      .filter(({fit, held_out}) => fit !== null || held_out !== null);
}

/** Where the nominal arm's ball is at each touch, in R_-1: that of the tip that touches. */
export function touchPoints(cell: Cell, touches: Touch[], numbering: Numbering): Vector[] {
  const {frames, gains} = cell.scene;
  return touches.map(({plane, joints_deg}) => tip_mm(frames, gains, joints_deg, furtherTip(cell, plane, numbering)?.center_mm));
}
