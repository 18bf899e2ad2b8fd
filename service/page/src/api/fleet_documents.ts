/** touchcal/fleet/1: the cells of the plant's archive. null: never told. */
export interface FleetCell {
  cell: string;
  last_event_at: string;
  heard_at: string;
  state: 'running' | 'idle' | null;
  arm: string | null;
  arm_serial: string | null;
  last_run_id: string | null;
  outcome: string | null;
  verdict: string | null;
  ended_at: string | null;
  model: string | null;
  valid_until: string | null;
  model_over: boolean;
  tip_box_max_mm: number | null;
  applied_model: string | null;
  applied_at: string | null;
  applied_to: string | null;
  last_proof_at: string | null;
  last_proof_verdict: string | null;
  last_check_at: string | null;
  last_check_verdict: string | null;
  last_check_cause: string | null;
  check_due_at: string | null;
  check_overdue: boolean;
  certificate_artefact: string | null;
  certificate_valid_until: string | null;
  certificate_over: boolean;
  last_fault_code: string | null;
  last_fault_at: string | null;
}

export interface Fleet {
  cells: FleetCell[];
}

/** touchcal/fleet-trends/1. */
export interface FleetTrend {
  arm: string | null;
  month: string;
  cells: number;
  calibrations: number;
  rejected: number;
  approved: number;
  tip_box_max_mm: number | null;
  checks: number;
  alarms: number;
  growth_ppm: number | null;
  proofs: number;
  failed_proofs: number;
  faults: number;
}

export interface FleetTrends {
  trends: FleetTrend[];
}
