import type {Status} from '../api/documents.ts';

/** What keeps the arm from moving, as far as the controller tells it apart. */
export type Cause = 'estop' | 'cell' | 'mode' | 'power' | 'hold' | 'probe' | 'link';

/** Whether the status tells this cause now; null: it does not tell such a thing. */
function tells(cause: Cause, status: Status): boolean | null {
  if (cause === 'link') return !status.controller_connected;
  if (!status.controller_connected) return null;  // what it told last may have changed since
  switch (cause) {
    case 'estop':
      return status.controller_estop;
    case 'cell':
      return status.controller_cell_closed === null ? null : !status.controller_cell_closed;
    case 'mode':
      return status.controller_mode === null ? null : status.controller_mode !== 'remote';
    case 'power':
      return status.controller_powered === null ? null : !status.controller_powered;
    case 'probe':
      return status.probe === null ? null : status.probe !== 'free';
    case 'hold':
      return null;
  }
}

/** In the order in which one brings the next: an emergency stop takes the power, an opened cell may take the mode. */
const kPermission: [Cause, RegExp][] = [
  ['estop', /an emergency stop/], ['cell', /an open cell/], ['mode', /the mode '/], ['hold', /\bhold\b(?!,)/], ['power', /no power/],
];

const kByCode: Readonly<Record<string, Cause>> = {
  emergency_stop: 'estop', cell_open: 'cell', not_remote: 'mode', not_powered: 'power', hold: 'hold', probe_fault: 'probe', probe_stuck: 'probe',
  probe_triggered: 'probe', probe_touched: 'probe', link_lost: 'link', controller_unreachable: 'link', controller_not_connected: 'link',
  controller_state_unknown: 'link',
};

/** What a fault or an unmet condition of this code always comes of; null: it has no cause that lasts, or one that is not told apart. */
export const causeOfCode = (code: string): Cause | null => kByCode[code] ?? null;

/**
 * The one cause of a fault, where it can be told: of a permission that was lost by what the daemon's message adds behind
 * "the controller tells", else by the status. Null: not known (yet), or a fault without a cause that lasts.
 */
export function causeOf(code: string, message: string, status: Status): Cause | null {
  if (code !== 'permission_lost') return causeOfCode(code);
  const [, told] = message.match(/the controller tells (.*)/s) ?? [];
  const named = told === undefined ? undefined : kPermission.find(([, words]) => words.test(told));
  return (named ?? kPermission.find(([cause]) => tells(cause, status) === true))?.[0] ?? null;
}

/** The controller still tells what the fault came of. Unknown is not told. */
export const isTold = (cause: Cause | null, status: Status): boolean => cause !== null && tells(cause, status) === true;
