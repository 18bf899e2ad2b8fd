import type {Status} from '../api/documents.ts';
import {causeOf, isTold, type Cause} from './fault_cause.ts';
import {kBlockToMove} from './states.ts';

/** A fault or warning as it was told: it stays until a person has noted it, whatever the cell does meanwhile. */
export interface StickyFault {
  key: string;
  code: string;
  message: string;
  robot_action: string | null;
  next_step: string | null;
  run_id: string | null;
  isWarning: boolean;
  isOver: boolean;       // the daemon no longer tells it
  cause: Cause | null;   // what the controller told it of
  isCauseTold: boolean;  // the controller has told that cause ever since
  at: string;            // by the daemon's clock, of the state in which it was told
}

/** The fault is at work: the daemon tells it, or the controller its cause. */
export const isAtWork = ({isWarning, isOver, isCauseTold}: StickyFault): boolean => !isWarning && (!isOver || isCauseTold);

/** Warnings that end by themselves, as their texts say. */
const kPassing = ['computation_slow', 'store_slow'];

/** The newest warnings are enough to read; the run keeps all of them. */
const kWarningsMax = 5;

/** `lasting`: see lastingWarning(), before this status. */
export function noteFaults(known: StickyFault[], before: Status | null, status: Status, lasting: string | null): StickyFault[] {
  let faults = known;
  const restarted = before !== null && before.instance_id !== status.instance_id;
  const same = !restarted && before?.fault_code === status.fault_code && before?.fault_message === status.fault_message;
  if (!same) {
    faults = faults.map((fault) => (fault.isWarning || fault.isOver ? fault : {...fault, isOver: true}));
    const isStep = status.fault_code === kBlockToMove;  // nothing that anybody would have to note
    if (status.fault_code && !isStep) faults = [toFault(status), ...faults.filter((fault) => !isSameFault(fault, status))];
  }
  faults = followCauses(faults, status);
  const passed = before?.warning_code;
  const isOver = passed !== undefined && passed !== null && kPassing.includes(passed) && status.warning_code !== passed;
  if (isOver) faults = faults.filter(({code}) => code !== passed);
  const warning = warningId(status);
  const isUncovered = isOver && warning === lasting;  // it was told before the one that has passed
  if (warning !== null && warning !== (before && warningId(before)) && !isUncovered) faults = withWarning(faults, status);
  return faults;
}

/** A cause that was not told with its fault may be told by the next State; one that is gone once does not come back as this fault's. */
function followCauses(faults: StickyFault[], status: Status): StickyFault[] {
  if (faults.every(({isWarning}) => isWarning)) return faults;
  return faults.map((fault) => {
    if (fault.isWarning) return fault;
    const cause = fault.cause ?? (fault.isOver ? null : causeOf(fault.code, fault.message, status));
    const isCauseTold = isTold(cause, status) && (fault.isCauseTold || !fault.isOver);
    return cause === fault.cause && isCauseTold === fault.isCauseTold ? fault : {...fault, cause, isCauseTold};
  });
}

/** The warning that stays until a newer one comes, by what tells it from others: a passing one covers it for a while. */
export function lastingWarning(known: string | null, status: Status): string | null {
  return status.warning_code === null || kPassing.includes(status.warning_code) ? known : warningId(status);
}

function warningId({instance_id, run_id, warning_code, warning_message}: Status): string | null {
  return warning_code === null ? null : JSON.stringify([instance_id, run_id, warning_code, warning_message]);
}

function isSameFault(fault: StickyFault, status: Status): boolean {
  return !fault.isWarning && fault.code === status.fault_code && fault.message === status.fault_message;
}

function toFault(status: Status): StickyFault {
  return {
    key: `${status.instance_id}-${status.sequence}`,
    code: status.fault_code ?? '',
    message: status.fault_message ?? '',
    robot_action: status.fault_robot_action,
    next_step: status.fault_next_step,
    run_id: status.run_id,
    isWarning: false,
    isOver: false,
    cause: null,
    isCauseTold: false,
    at: status.since,
  };
}

function withWarning(faults: StickyFault[], status: Status): StickyFault[] {
  const warning: StickyFault = {
    key: `${status.instance_id}-${status.sequence}-warning`,
    code: status.warning_code ?? '',
    message: status.warning_message ?? '',
    robot_action: null,
    next_step: null,
    run_id: status.run_id,
    isWarning: true,
    isOver: false,
    cause: null,
    isCauseTold: false,
    at: status.since,
  };
  const others = faults.filter((fault) => !(fault.isWarning && fault.code === warning.code && fault.run_id === warning.run_id));
  const kept = others.filter((fault) => fault.isWarning).slice(0, kWarningsMax - 1);
  const told = toldFault(others);
  return [...(told ? [told] : []), warning, ...others.filter((fault) => fault !== told && (!fault.isWarning || kept.includes(fault)))];
}

/** A person has read it. One that is at work stays. */
export function dropFault(known: StickyFault[], key: string): StickyFault[] {
  return known.filter((fault) => fault.key !== key || isAtWork(fault));
}

/** The daemon took note of the fault of `key`: it is read. Others are not, and one whose cause is still told stays. */
export function dropAcknowledged(known: StickyFault[], key: string | null): StickyFault[] {
  return known.filter((fault) => fault.key !== key || fault.isCauseTold).map((fault) => (fault.key === key ? {...fault, isOver: true} : fault));
}

/** What has to be released before a fault that is at work can be cleared; null: nothing that is known. */
export function causeToRelease(known: StickyFault[]): Cause | null {
  return known.find(({isWarning, isCauseTold}) => !isWarning && isCauseTold)?.cause ?? null;
}

/** The fault that the daemon tells now. */
export function toldFault(known: StickyFault[]): StickyFault | null {
  return known.find((fault) => !fault.isWarning && !fault.isOver) ?? null;
}
