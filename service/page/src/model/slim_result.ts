import type {Parameter, PlaneDistances, Result} from '../api/documents.ts';

const slimParameter = ({name, group, unit, nominal, status, error, std_uncertainty, interval95, grouped_with}: Parameter): Parameter =>
    ({name, group, unit, nominal, status, error, std_uncertainty, interval95, grouped_with});

const slimPlane = ({plane, place, tip, touch_count, reference_mm, estimated_offset_mm, nominal_mean_mm, calibrated_mean_mm, error_removed_percent,
                    nominal_rms_mm, calibrated_rms_mm}: PlaneDistances): PlaneDistances =>
    ({plane, place, tip, touch_count, reference_mm, estimated_offset_mm, nominal_mean_mm, calibrated_mean_mm, error_removed_percent,
      nominal_rms_mm, calibrated_rms_mm});

/** What the page shows of a result: the document has a row a touch and a cell a correlation, and many results are kept. */
export function slimResult(result: Result): Result {
  const {recipe, touch_count, complete, warnings, rejected_touches, identifiable_count, condition_number, scale, fit, verdict, monte_carlo} = result;
  const {expanded, arm_frame, at_block_rms_mm, workspace_box_rms_mm, joint_ranges_rms_mm, map} = result.tip_uncertainty;
  return {
    recipe, touch_count, complete, warnings, rejected_touches, identifiable_count, condition_number, scale, fit, verdict, monte_carlo,
    parameters: result.parameters.map(slimParameter),
    planes: result.planes.map(slimPlane),
    planes_held_out: result.planes_held_out.map(slimPlane),
    tip_uncertainty: {expanded, arm_frame, at_block_rms_mm, workspace_box_rms_mm, joint_ranges_rms_mm, map},
  };
}
