// The API's documents, as far as the page reads them. Units stand at the end of names; what is not known is null.

export type StateName =
  | 'STOPPED' | 'RESETTING' | 'IDLE' | 'STARTING' | 'EXECUTE' | 'COMPLETING' | 'COMPLETE' | 'HOLDING' | 'HELD'
  | 'UNHOLDING' | 'SUSPENDING' | 'SUSPENDED' | 'UNSUSPENDING' | 'STOPPING' | 'ABORTING' | 'ABORTED' | 'CLEARING';
export type VerdictName = 'none' | 'accepted' | 'rejected' | 'incomplete';

export interface Status {
  state: StateName;
  waiting_for: string | null;
  run_id: string | null;
  recipe: string | null;
  touches_done: number;
  touches_total: number | null;
  plane: number | null;
  block_place?: string | null;  // a daemon that knows one place only does not tell it
  identifiable_count: number | null;
  condition_number: number | null;
  predicted_tip_rms_mm: number | null;
  more_would_bring: string | null;
  eta_s: number | null;
  verdict: VerdictName;
  controller_connected: boolean;
  controller_powered: boolean | null;
  controller_mode: string | null;
  controller_estop: boolean | null;
  controller_cell_closed: boolean | null;
  controller_touch_tested: boolean | null;
  controller_permit: string | null;
  probe: 'free' | 'touched' | 'fault' | null;
  retract_due: boolean | null;
  reference_drift_mm: number | null;
  by_hand: 'locate' | 'guided' | 'tool' | null;  // what a person with the pendant is at
  by_hand_step: 'touch' | 'undo' | 'pass' | 'passing' | null;
  by_hand_plane: number | null;
  by_hand_index: number | null;
  by_hand_total: number | null;
  by_hand_words: string | null;
  by_hand_problem: string | null;
  by_hand_joints_deg: number[] | null;
  fault_code: string | null;
  fault_message: string | null;
  fault_robot_action: string | null;
  fault_next_step: string | null;
  warning_code: string | null;
  warning_message: string | null;
  last_accepted_run_id: string | null;
  last_accepted_at: string | null;
  archive_behind: number | null;  // null: no archive is configured
  data_age_ms: number | null;
  sequence: number;
  instance_id: string;
  since: string;
}

export interface Joints {
  joints_deg: number[] | null;
  data_age_ms: number | null;
  sequence: number;
  instance_id: string;
}

export type Vector = [number, number, number];
/** Through a solid from side to side; the axis of unit length. */
export interface Hole { center_mm: Vector; axis: Vector; radius_mm: number }
export interface Box { name: string; min_mm: Vector; max_mm: Vector; holes?: Hole[] }
export interface Capsule { name: string; frame: number; from_mm: Vector; to_mm: Vector; radius_mm: number }
export interface Frame { alpha_rad: number; d_mm: number; theta_rad: number; r_mm: number; beta_rad: number }
export interface Face {
  plane: number;
  name?: string | null;  // of the block's file; a daemon whose file has none does not tell it
  outward: Vector;
  offset_mm: number;
  center_mm: Vector;
  edge_u: Vector;
  half_extent_mm: [number, number];
  sphere?: {center_mm: Vector; radius_mm: number};  // the rest is the plane that touches it at its pole
  bore?: {mouth_mm: Vector; axis: Vector; radius_mm: number; depth_mm: [number, number]; wall_half_angle_deg: number};
}
/** Where the block was located, against the cell's file. */
export interface Place { located_at: string; shift_mm: number[]; turn_deg: number[] }
/** Where else the block can stand, in R_-1 of the first place; the turn is a rotation vector. */
export interface BlockPlace { name: string; is_known: boolean; shift_mm: Vector; turn_deg: Vector }
/** A further tip of a star stylus: where its ball is in R_7, by the drawing. */
export interface ProbeTip { name: string; center_mm: Vector; radius_mm: number }
export interface Cell {
  name: string;
  arm: string;
  // A daemon that takes no temperature with a run does not tell the deviation.
  block: {name: string; temperature_c: number | null; std_temperature_k?: number | null; faces: Face[]; places?: BlockPlace[]};
  confirm_s?: number;  // for how long the confirmation is awaited; an older daemon does not tell it
  place?: Place | null;  // a daemon that cannot locate the block does not tell it
  probe: {name: string; stylus_radius_mm: number; tips?: ProbeTip[]};
  tool_tips?: string[];  // tools that can touch; an older daemon does not tell them
  default_recipe: string;
  workspace_box: Box;
  keep_out_boxes: Box[];
  acceptance: {
    held_out_mean_max_mm: number;
    held_out_rms_max_mm: number;
    condition_number_max: number;
    tip_box_rms_max_mm: number | null;
    tip_box_max_mm: number | null;
    tip_box_max_by_recipe_mm?: Record<string, number>;
  };
  scene: {
    frames: Frame[];
    gains: number[];
    arm_bodies: Capsule[];
    probe_bodies: Capsule[];
    solids: Box[];
    park_joints_deg: number[];
  };
}

/** `places`: to which the block is brought after the first one; `tips`: that touch at each beside the first one. */
export interface Recipe { name: string; description: string; planes: number[]; places?: string[]; tips?: string[]; fit_max: number; held_out: number }
export interface Recipes { default: string; recipes: Recipe[] }

export interface FaultEntry {
  code: string;
  kind: 'refused' | 'warning' | 'held' | 'suspended' | 'aborted';
  cause: string;
  robot_action: string;
  next_step: string;
}

export interface Run {
  id: string;
  kind: 'calibration' | 'proof' | 'check' | 'qualification' | 'tool';
  of_run: string | null;  // the calibration that it is held against
  recipe: string;
  outcome: 'running' | 'complete' | 'stopped' | 'aborted' | 'interrupted';
  verdict: VerdictName;
  touches_done: number;
  touches_total: number | null;
  started_at: string;
  ended_at: string | null;
  fault_code: string | null;
  fault_message: string | null;
}
export interface DamagedRun { id: string; detail: string }
export interface Runs { runs: Run[]; damaged: DamagedRun[]; next_before: string | null }

export type TouchRole = 'fit' | 'held_out' | 'proof';
export interface Touch { plane: number; role: TouchRole; joints_deg: number[] }
export interface Touches { touches: Touch[] }

export interface UncertaintyMap { box: Box; counts: Vector; cell_mm: Vector; values_mm: (number | null)[] }
/** k times the standard uncertainty of the tip over the workspace box. */
export interface ExpandedTip { k: number; box_rms_mm: number | null; box_p95_mm: number | null; box_max_mm: number | null }
/** A result that an older daemon stored lacks what is optional. */
export interface TipUncertainty {
  expanded?: ExpandedTip;
  arm_frame?: {expanded: ExpandedTip};
  at_block_rms_mm: number | null;
  workspace_box_rms_mm: number | null;
  joint_ranges_rms_mm: number | null;
  map: UncertaintyMap | null;
}
export interface Plan {
  plan_id: string;
  recipe: string;
  touch_count: number;
  condition_number: number | null;
  identifiable_count: number | null;
  tip_uncertainty: TipUncertainty;
  duration_s: number | null;
  touches: Touch[];
}

export type ParameterStatus = 'identified' | 'grouped' | 'no_effect' | 'excluded' | 'weak';
export interface Parameter {
  name: string;
  group: string;
  unit: 'mm' | 'rad';
  nominal: number;
  status: ParameterStatus;
  error: number | null;
  std_uncertainty: number | null;
  interval95: [number, number] | null;
  grouped_with: {name: string; factor: number}[];
}
export interface PlaneDistances {
  plane: number;
  place?: string | null;  // another one than the first
  tip?: string | null;  // likewise
  touch_count: number;
  reference_mm: number;
  /** Of a face that was found in place; the calibrated mean scatters about this. */
  estimated_offset_mm?: number | null;
  nominal_mean_mm: number | null;
  calibrated_mean_mm: number | null;
  error_removed_percent: number | null;
  nominal_rms_mm: number | null;
  calibrated_rms_mm: number | null;
}
/** Simulated calibrations: standard uncertainties, and the tip error that 95 % of the errors do not exceed. */
export interface MonteCarlo {
  count: number;
  converged: number;
  box_rms_mm: number | null;
  box_p95_mm: number | null;
  joint_ranges_rms_mm: number | null;
  linear_over_monte_carlo: number | null;
}
/** A figure against its limit (ISO 14253-1). */
export interface Criterion {
  name: string;
  plane: number | null;
  tool?: string | null;
  unit: string;
  value: number | null;
  side?: 'upper' | 'lower';
  limit: number;
  expanded_uncertainty: number | null;
  within_limit: boolean;
  proved: boolean | null;
}
export interface DecisionRule { standard: string; rule: 'simple' | 'guarded'; text: string; coverage_factor: number; criteria: Criterion[] }
interface VerificationHead {
  of_run: string;
  touch_count: number;
  complete: boolean;
  verdict: {accepted: boolean | null; reasons: string[]};
  rms_mm: number | null;
  p: number | null;
  p_min: number | null;
  noise_um: number | null;
}
/** The result of a proof. */
export interface Proof extends VerificationHead {
  schema: 'touchcal/proof/1';
  rms_max_mm: number | null;
  power: {alternative: string; power: number | null}[];
}
/** The result of a check. */
export interface Check extends VerificationHead {
  schema: 'touchcal/check/1';
  reference: {count: number; needed: number};
  joints: {joint: number; offset_mrad: number | null; std_offset_mrad: number | null}[];
  growth_ppm: number | null;
  warmer_k: number | null;
}
/** The result of a qualification of the probe. */
export interface Qualification {
  schema: 'touchcal/qualification/1';
  probe: string;
  of_run: string | null;
  no_of_run: string | null;  // why there is none
  touch_count: number;
  complete: boolean;
  verdict: {accepted: boolean | null; reasons: string[]};
  scatter: {std_um: number | null; low_um: number | null; high_um: number | null};
  criteria: {name: string; unit: 'mm' | 'p'; value: number | null; limit: number | null; expanded: number | null; passed: boolean}[];
}
/** Where the tip of a tool was found. */
export interface TouchedTool {
  schema: 'touchcal/tool/1';
  tool: string;
  of_run: string;
  touch_count: number;
  complete: boolean;
  verdict: {accepted: boolean | null; reasons: string[]};
  position_mm: [number, number, number] | null;  // in R_6
  std_position_mm: [number, number, number] | null;
  off_drawing_mm: number | null;
  box_rms_mm: number | null;
  box_rms_max_mm: number | null;
  rms_mm: number | null;
  p: number | null;
  p_min: number | null;
}
export type Verification = Proof | Check | Qualification | TouchedTool;

/** One figure of a check, and what chance allows it. */
export interface CheckPoint {
  run: string;
  value: number | null;
  weighted_mean: number | null;
  shewhart_limit: number | null;  // distance of the value from the centre
  ewma_limit: number | null;      // of the weighted mean from it
  beyond_shewhart: boolean;
  beyond_ewma: boolean;
}
export interface CheckChart { quantity: string; unit: string; centre: number | null; points: CheckPoint[] }
/** One check, as far as all of them are told together. */
export interface CheckRow {
  run: string;
  ended_at: string;
  operator: string | null;
  reference: boolean;
  accepted: boolean | null;
  cause: string | null;  // of one that is not accepted: joint, block, stylus, unknown
  joint: number | null;
}
/** The checks of a calibration. */
export interface Checks {
  of_run: string;
  count: number;              // of all; `checks` and the points of the charts are of the newest
  reference: {count: number; needed: number};
  base: {count: number; needed: number};
  every_days: number | null;  // null: no rule, or the calibration was replaced
  due_at: string | null;      // null with a rule: not known
  overdue: boolean | null;
  warnings: string[];
  checks: CheckRow[];
  charts: CheckChart[];
}

/** Part of a comparison: the arm, or the stylus. */
export interface ComparedPart {
  changed: boolean | null;  // null: nothing of it was identified by both
  p: number | null;
  combinations: {e_n: number | null; shares: {parameter: string; share: number | null}[]}[];
}
/** Two calibrations, compared by the combinations of errors that both identified. */
export interface Comparison {
  earlier: string;
  later: string;
  verdict: {accepted: boolean | null; reasons: string[]};
  growth_ppm: number | null;
  std_growth_ppm: number | null;
  tip_difference_mm: number | null;
  std_tip_difference_mm: number | null;
  arm: ComparedPart;
  tool: ComparedPart;
}

export interface Result {
  schema?: 'touchcal/result/1';
  recipe: string;
  touch_count: number;
  complete: boolean;
  warnings: string[];
  rejected_touches: {touch: number; residual_mm: number | null; reason: string}[];
  identifiable_count: number;
  condition_number: number | null;
  parameters: Parameter[];
  planes: PlaneDistances[];
  planes_held_out: PlaneDistances[];
  scale: {
    source: string | null;
    std_uncertainty_ppm: number | null;
    stretch_ppm: number | null;
    warning: string | null;
  };
  tip_uncertainty: TipUncertainty;
  monte_carlo?: MonteCarlo | null;
  fit: {noise_declared_um: number | null; noise_estimated_um: number | null; lack_of_fit_p: number | null};
  verdict: {accepted: boolean; reasons: string[]; decision_rule?: DecisionRule};
}

export interface Unmet { code: string; detail: string }
/** RFC 9457, and what the daemon adds. */
export interface Problem {
  type: string;
  title: string;
  status: number;
  detail: string;
  errors?: Unmet[];
  exits?: string[];
}

/** A row of the audit log, as far as the page reads it. */
export interface AuditRow { at: string; token: string | null; remote: string; action: string; outcome: string }
export interface Audit { rows: AuditRow[] }

/** What this page may do. 'ended': a person's session that has run out, which may stop and nothing else. */
export type Role = 'operate' | 'view' | 'none' | 'wrong token' | 'ended';
