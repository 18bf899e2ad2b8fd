import type {StateName, Status} from '../api/documents.ts';

/** Commands of the run or the cell, as in the API's paths. */
export type Command =
  | 'pause' | 'resume' | 'retry' | 'skip' | 'take' | 'undo' | 'locate' | 'stop' | 'abort' | 'clear' | 'reset' | 'acknowledge';

const kOfTheRun: ReadonlySet<Command> = new Set(['pause', 'resume', 'retry', 'skip', 'abort']);

export function commandPath(command: Command, run_id: string | null): string | null {
  if (!kOfTheRun.has(command)) return `/api/v1/cell/${command}`;
  return run_id ? `/api/v1/runs/${run_id}/${command}` : null;
}

const kQuiet: ReadonlySet<StateName> = new Set(['STOPPED', 'RESETTING', 'IDLE', 'COMPLETE', 'ABORTED', 'CLEARING']);

/** A run is under way. */
export const isActive = (state: StateName): boolean => !kQuiet.has(state);

/** A run may start, as far as the state goes. */
export const mayStart = (state: StateName): boolean => state === 'IDLE' || state === 'COMPLETE';

const kPausable: ReadonlySet<StateName> =
    new Set(['EXECUTE', 'UNHOLDING', 'SUSPENDING', 'SUSPENDED', 'UNSUSPENDING']);
export const mayPause = (state: StateName): boolean => kPausable.has(state);

/** What the run's main button does in a state; null: there is nothing to do but wait. */
export type MainAction = 'start' | 'resume' | 'reset' | 'clear' | null;
export function mainAction(state: StateName, isAtFace: boolean): MainAction {
  if (state === 'IDLE' && isAtFace) return 'reset';  // which takes it back
  if (mayStart(state)) return 'start';
  if (state === 'HELD' || state === 'SUSPENDED') return 'resume';
  if (state === 'STOPPED') return 'reset';
  return state === 'ABORTED' ? 'clear' : null;
}

/** Faults of a single touch, that making it again or leaving it out leads out of. */
export const kTouchFaults: ReadonlySet<string> = new Set([
  'probe_triggered', 'early_contact', 'false_trigger', 'touch_spread', 'retries_worse', 'repeated_touch', 'touch_does_not_fit',
  'touch_rejected', 'touch_deadline', 'no_contact', 'probe_stuck', 'probe_fault', 'no_safe_way',
]);

/** What can be done with the touch that holds the run; of the reference touch none can be left out. */
export function touchActions({state, fault_code}: Status): Command[] {
  if (state !== 'HELD' || !fault_code) return [];
  if (fault_code === 'reference_drift') return ['retry'];
  return kTouchFaults.has(fault_code) ? ['retry', 'skip'] : [];
}

/** The run waits for a person to bring the block to another place: told as a fault, and a step of the work. */
export const kBlockToMove = 'block_to_move';
export const isBlockToMove = ({state, fault_code}: Status): boolean => state === 'HELD' && fault_code === kBlockToMove;

/** A person holds the run, or is about to: no fault does. */
export const isPaused = ({state, fault_code}: Status): boolean => (state === 'HELD' || state === 'HOLDING') && fault_code === null;

/** The arm is about to be told what to do by another: a run would end the dialogue. */
export const isLocating = (status: Status): boolean => status.by_hand === 'locate';

/** The arm is on its way back from a face, for which alone there is a permit. */
export const isTakenBack = (status: Status): boolean => status.state === 'RESETTING' && status.controller_permit === 'granted';

/** STOP may be needed: a run is under way, or the arm is led or goes where a person is beside it. */
export const mayMove = (status: Status | null): boolean => status !== null && (isActive(status.state) || isTakenBack(status) || isLocating(status));

/** The emergency stop is pressed, and nothing of the run or its end is under way that would be told in its place. */
export const isMotionDisabled = ({state, controller_estop, controller_connected}: Status): boolean =>
    controller_connected && controller_estop === true && (state === 'IDLE' || state === 'COMPLETE' || state === 'HELD' || state === 'STOPPED');

/** How the state looks: at rest, at work, waiting for a person, or wrong. */
export type Mood = 'rest' | 'work' | 'wait' | 'wrong';
export function mood(status: Status): Mood {
  if (isMotionDisabled(status)) return 'wrong';
  if (status.state === 'ABORTED' || status.state === 'ABORTING') return 'wrong';
  const isFaulty = status.fault_code !== null && status.fault_code !== kBlockToMove;
  if (isFaulty && (status.state === 'HELD' || status.state === 'STOPPED')) return 'wrong';
  if (status.waiting_for || isLocating(status) || status.state === 'HELD' || status.state === 'SUSPENDED') return 'wait';
  return isActive(status.state) || isTakenBack(status) ? 'work' : 'rest';
}
