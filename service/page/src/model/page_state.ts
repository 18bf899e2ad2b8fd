import type {Cell, Checks, Comparison, DamagedRun, FaultEntry, Joints, Plan, Problem, Recipes, Result, Role, Run, Status, Touch, Unmet, Verification} from '../api/documents.ts';
import type {Link} from '../api/live.ts';
import type {Person, Session} from '../api/session_documents.ts';
import {addToSeries, kNoSeries, type Series} from './series.ts';
import {isActive, isPaused, type Command} from './states.ts';
import {dropAcknowledged, dropFault, lastingWarning, noteFaults, type StickyFault} from './sticky_faults.ts';

/** `setup` is reached from the account: it is no operator's. */
export type View = 'cell' | 'live' | 'result' | 'history' | 'setup';
export const kViews: View[] = ['cell', 'live', 'result', 'history'];

/** When something was heard: by the browser's clock that only goes forward, which nobody sets. */
export interface Pulse { joints: Joints; heard_ms: number }

/** A plan of a recipe: being made, made, or why not. */
export type PlanState = {kind: 'planning'} | {kind: 'made'; plan: Plan} | {kind: 'refused'; problem: Problem} | {kind: 'lost'};

/** The checks of a calibration, or why they cannot be had. */
export type ChecksState = {kind: 'known'; checks: Checks} | {kind: 'refused'; why: string};

/** A comparison of two runs, or why there is none. */
export type ComparisonState = {kind: 'known'; comparison: Comparison} | {kind: 'refused'; why: string};

/** A command that was not taken, in words, until noted. */
export interface Notice { command: Command | 'start'; problem: Problem | null }

/** Who paused a run, by the daemon's audit log. */
export interface PausedBy { run_id: string; name: string | null; from: string; at: string }

/** All that the page shows. */
export interface PageState {
  link: Link;
  status: Status | null;
  pulse: Pulse | null;
  statusKnown_ms: number | null;        // when the status was last heard, or known to be still the newest
  series: Series;
  faults: StickyFault[];
  lastingWarning: string | null;        // told last of those that do not end by themselves, noted or not
  unmet: Unmet[] | null;  // what stands in the way of a start; null: not known
  role: Role | null;
  session: Session | null;              // whom the token stands for; null: not heard yet, or of a daemon without sessions
  people: Person[] | null;              // who may sign in; an engineer may know
  isAccountOpen: boolean;               // the panel to sign in, and of the person who did
  hasToken: boolean;
  waitingSince_ms: number | null;       // when the page heard that the present wait began; null: it did not hear it begin
  pausedBy: PausedBy | null;            // who asked for the pause that holds the run
  view: View;
  cell: Cell | null;
  recipes: Recipes | null;
  faultTable: Record<string, FaultEntry>;
  recipe: string | null;                // chosen for the next run
  plans: Record<string, PlanState>;     // by recipe
  runs: Run[];
  damagedRuns: DamagedRun[];            // of the same pages
  nextBefore: string | null;            // of the history's next page
  shownRun: string | null;              // chosen in the history; null: the newest
  compared: string[];                   // at most two runs
  comparisons: Record<string, ComparisonState>;  // by comparisonKey()
  results: Record<string, Result>;      // by run
  verifications: Record<string, Verification>;  // of proofs and checks, by run
  checks: Record<string, ChecksState>;  // by the run of the calibration
  countingChecks: ChecksState | null;   // of the calibration that the next check would be of; null: there is none, or it was not heard yet
  missing: Record<string, string>;      // why a run has no result, by run
  touches: {run_id: string; touches: Touch[]} | null;  // of the run that is watched
  runPlan: {run_id: string; touches: Touch[]} | null;
  notice: Notice | null;
  isStopLost: boolean;                  // a stop did not reach the daemon, until noted
  busy: Command | 'start' | null;       // sent, not answered yet
}

export const kFirstState: PageState = {
  link: 'connecting', status: null, pulse: null, statusKnown_ms: null, series: kNoSeries, faults: [], lastingWarning: null, unmet: null,
  role: null, session: null, people: null, isAccountOpen: false, hasToken: false, waitingSince_ms: null, pausedBy: null,
  view: 'cell', cell: null, recipes: null, faultTable: {}, recipe: null, plans: {}, runs: [], damagedRuns: [], nextBefore: null,
  shownRun: null, compared: [], comparisons: {}, results: {}, verifications: {}, checks: {}, countingChecks: null, missing: {}, touches: null, runPlan: null,
  notice: null, isStopLost: false, busy: null,
};

export type Action =
  | {type: 'link'; link: Link}
  | {type: 'statuses'; statuses: Status[]; heard_ms: number}
  | {type: 'joints'; joints: Joints; heard_ms: number}
  | {type: 'patch'; patch: Partial<PageState>}
  | {type: 'plan'; recipe: string; plan: PlanState}
  | {type: 'result'; run_id: string; result: Result}
  | {type: 'verification'; run_id: string; verification: Verification}
  | {type: 'checks'; asked: string | null; found: ChecksState | null}  // asked null: of the calibration that counts; found null: there is none
  | {type: 'comparison'; key: string; found: ComparisonState}
  | {type: 'missing'; run_id: string; why: string}
  | {type: 'runs'; runs: Run[]; damaged: DamagedRun[]; nextBefore: string | null; isMore: boolean}
  | {type: 'noted'; key: string}
  | {type: 'acknowledged'; key: string | null}
  | {type: 'compare'; run_id: string};

/** Results are some 25 kB each: as many are kept as the trends draw. */
const kResultsMax = 40;

export function reduce(state: PageState, action: Action): PageState {
  switch (action.type) {
    case 'link':
      return state.link === action.link ? state : {...state, link: action.link};
    case 'statuses':
      return {...action.statuses.reduce((so_far, status) => takeStatus(so_far, status, action.heard_ms), state), statusKnown_ms: action.heard_ms};
    case 'joints':
      return takePulse(state, {joints: action.joints, heard_ms: action.heard_ms});
    case 'patch':
      return {...state, ...action.patch};
    case 'plan':
      return {...state, plans: {...state.plans, [action.recipe]: action.plan}};
    case 'result':
      return {...state, results: keepNewest({...state.results, [action.run_id]: action.result})};
    case 'verification':
      return {...state, verifications: keepNewest({...state.verifications, [action.run_id]: action.verification})};
    case 'checks':
      return takeChecks(state, action.asked, action.found);
    case 'comparison':
      return {...state, comparisons: {...state.comparisons, [action.key]: action.found}};
    case 'missing':
      return {...state, missing: {...state.missing, [action.run_id]: action.why}};
    case 'runs':
      return {
        ...state, nextBefore: action.nextBefore,
        runs: action.isMore ? [...state.runs, ...action.runs] : action.runs,
        damagedRuns: action.isMore ? [...state.damagedRuns, ...action.damaged] : action.damaged,
      };
    case 'noted':
      return {...state, faults: dropFault(state.faults, action.key)};
    case 'acknowledged':
      return {...state, faults: dropAcknowledged(state.faults, action.key)};
    case 'compare':
      return {...state, compared: toggled(state.compared, action.run_id)};
  }
}

function takeStatus(state: PageState, status: Status, heard_ms: number): PageState {
  const before = state.status;
  const series = addToSeries(state.series, status);
  if (before && before.instance_id === status.instance_id && status.sequence <= before.sequence) {
    // Told again, or remembered from before this page was loaded: only the curves gain by it.
    return status.run_id === before.run_id && series !== state.series ? {...state, series} : state;
  }
  return {
    ...state,
    status,
    series,
    faults: noteFaults(state.faults, before, status, state.lastingWarning),
    lastingWarning: lastingWarning(state.lastingWarning, status),
    waitingSince_ms: waitingSince(state, status, heard_ms),
    pausedBy: state.pausedBy?.run_id === status.run_id && isPaused(status) ? state.pausedBy : null,
    view: nextView(state.view, before, status),
    shownRun: status.run_id !== null && before?.run_id !== status.run_id ? null : state.shownRun,  // a new run is looked at
  };
}

/** The two runs that are compared, the earlier one first; null: not two are chosen. */
export function comparedPair(compared: string[]): [string, string] | null {
  const [a, b] = [...compared].sort((x, y) => Number(x) - Number(y));
  return a !== undefined && b !== undefined ? [a, b] : null;
}

export const comparisonKey = ([earlier, later]: [string, string]): string => `${earlier} ${later}`;

/** What is heard of the calibration that counts is the same document as that of its run: both places have the newer. */
function takeChecks(state: PageState, asked: string | null, found: ChecksState | null): PageState {
  const runOf = (one: ChecksState | null): string | null => (one?.kind === 'known' ? one.checks.of_run : null);
  const of_run = runOf(found) ?? asked;
  const counts = asked === null || of_run === runOf(state.countingChecks);
  return {
    ...state,
    checks: found && of_run !== null ? keepNewest({...state.checks, [of_run]: found}) : state.checks,
    countingChecks: counts ? found : state.countingChecks,
  };
}

/** A wait that another page load began has no beginning here: what is left of it is not guessed. */
function waitingSince({status: before, waitingSince_ms}: PageState, status: Status, heard_ms: number): number | null {
  if (status.waiting_for === null || before === null || before.instance_id !== status.instance_id) return null;
  return before.waiting_for === status.waiting_for ? waitingSince_ms : heard_ms;
}

/** The pulse tells the newest status' number as well: one that is not behind it is as new as the pulse. */
function takePulse(state: PageState, pulse: Pulse): PageState {
  const {status} = state;
  const {sequence, instance_id} = pulse.joints;
  const isNewest = status !== null && status.instance_id === instance_id && status.sequence >= sequence;
  return {...state, pulse, statusKnown_ms: isNewest ? pulse.heard_ms : state.statusKnown_ms};
}

/** The run that was made last, as far as the page knows. */
export function newestRun({status, runs}: Pick<PageState, 'status' | 'runs'>): string | null {
  const ids = [status?.run_id ?? null, runs[0]?.id ?? null].filter((id) => id !== null);
  return ids.sort((a, b) => Number(b) - Number(a))[0] ?? null;
}

/** The calibration that the shown run is a check of; null: it is none. */
export function checkedRun(state: PageState): string | null {
  const run_id = state.shownRun ?? newestRun(state);
  const shown = run_id === null ? undefined : state.verifications[run_id];
  return shown?.schema === 'touchcal/check/1' ? shown.of_run : null;
}

/** A start shows the run, its end the result; else a person chooses. */
function nextView(view: View, before: Status | null, status: Status): View {
  const was = before !== null && isActive(before.state);
  if (!was && isActive(status.state)) return 'live';
  if (was && status.state === 'COMPLETE' && view === 'live') return 'result';
  return view;
}

export function hasResult({results, verifications}: PageState, run_id: string): boolean {
  return run_id in results || run_id in verifications;
}

function keepNewest<Kept>(results: Record<string, Kept>): Record<string, Kept> {
  const ids = Object.keys(results).sort((a, b) => Number(b) - Number(a)).slice(0, kResultsMax);
  return Object.fromEntries(ids.map((id) => [id, results[id]!]));
}

function toggled(compared: string[], run_id: string): string[] {
  return compared.includes(run_id) ? compared.filter((id) => id !== run_id) : [...compared, run_id].slice(-2);
}

/**
 * How old what is shown is now, in ms: the older of the cell's data (their age when they were told and the time since) and
 * of the status; null: never heard.
 */
export function dataAge_ms({pulse, statusKnown_ms}: Pick<PageState, 'pulse' | 'statusKnown_ms'>, now_ms: number): number | null {
  if (!pulse || pulse.joints.data_age_ms === null || statusKnown_ms === null) return null;
  return Math.max(0, pulse.joints.data_age_ms + now_ms - pulse.heard_ms, now_ms - statusKnown_ms);
}
