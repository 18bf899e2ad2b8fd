import type {Status} from 'page/api/documents.ts';

/** A status of a cell at rest, with `changes`. */
export function statusWith(changes: Partial<Status>): Status {
  return {
    state: 'IDLE', waiting_for: null, run_id: null, recipe: null, touches_done: 0, touches_total: null, plane: null,
    identifiable_count: null, condition_number: null, predicted_tip_rms_mm: null, more_would_bring: null, eta_s: null,
    verdict: 'none', controller_connected: true, controller_powered: true, controller_mode: 'remote', controller_estop: false,
    controller_cell_closed: true, controller_touch_tested: true, controller_permit: 'none', probe: 'free', retract_due: false,
    reference_drift_mm: null, by_hand: null, by_hand_step: null, by_hand_plane: null, by_hand_index: null, by_hand_total: null,
    by_hand_words: null, by_hand_problem: null, by_hand_joints_deg: null, fault_code: null, fault_message: null,
    fault_robot_action: null, fault_next_step: null, warning_code: null, warning_message: null, last_accepted_run_id: null,
    last_accepted_at: null, archive_behind: null, data_age_ms: 10, sequence: 1, instance_id: 'a', since: '2026-01-01T00:00:00.000Z', ...changes,
  };
}
