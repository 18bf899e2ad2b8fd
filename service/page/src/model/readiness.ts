import type {Status, Unmet} from '../api/documents.ts';
import type {WordKey} from '../words/words.ts';
import {causeOfCode, type Cause} from './fault_cause.ts';

/** One condition of a start. Unknown is not fine. */
export interface Condition {
  name: WordKey;
  state: 'met' | 'unmet' | 'unknown' | 'later';  // later: asked for once the run starts
  code: string | null;    // of the fault table, when unmet
  detail: string | null;  // the daemon's own words
}

interface Rule { name: WordKey; codes: string[]; met: (status: Status) => boolean | null }

const kRules: Rule[] = [
  {name: 'readyController', codes: ['controller_not_connected', 'controller_state_unknown'], met: (s) => s.controller_connected},
  {name: 'readyEstop', codes: ['emergency_stop'], met: (s) => (s.controller_estop === null ? null : !s.controller_estop)},
  {name: 'readyCell', codes: ['cell_open'], met: (s) => s.controller_cell_closed},
  {name: 'readyMode', codes: ['not_remote'], met: (s) => (s.controller_mode === null ? null : s.controller_mode === 'remote')},
  {name: 'readyPower', codes: ['not_powered'], met: (s) => s.controller_powered},
  {name: 'readyProbe', codes: ['probe_touched', 'probe_fault'], met: (s) => (s.probe === null ? null : s.probe === 'free')},
];

/** All conditions of a start, with the reason of each that is not met. `unmet`: the daemon's list; null: not known. */
export function conditions(status: Status | null, unmet: Unmet[] | null): Condition[] {
  if (!status) return kRules.map(({name}) => ({name, state: 'unknown', code: null, detail: null}));
  const told = unmet ?? [];
  const list = kRules.map((rule) => condition(rule, status, told));
  list.push({
    name: 'readyTouchTest',
    state: status.controller_touch_tested ? 'met' : status.controller_touch_tested === null ? 'unknown' : 'later',
    code: null,
    detail: null,
  });
  for (const {code, detail} of told) {
    if (!kRules.some((rule) => rule.codes.includes(code))) list.push({name: 'readyOther', state: 'unmet', code, detail});
  }
  if (unmet === null) list.push({name: 'readyOther', state: 'unknown', code: null, detail: null});
  return list;
}

/** Of the block's file; a start may bring another one. */
const kOfTemperature = ['temperature_missing', 'temperature_old', 'temperature_in_future'];

/** Whether a start is taken, as far as the daemon's list tells. Unknown is not ready. */
export function isReadyFor(unmet: Unmet[] | null, bringsTemperature: boolean): boolean {
  return unmet !== null && unmet.every(({code}) => bringsTemperature && kOfTemperature.includes(code));
}

/** The first condition that keeps a start back: as what has to be released, or by its code. */
export function standsInTheWay(unmet: Unmet[], bringsTemperature: boolean): {cause?: Cause; code?: string} {
  const first = unmet.find((one) => !isReadyFor([one], bringsTemperature));
  if (!first) return {};
  const cause = causeOfCode(first.code);
  return cause ? {cause} : {code: first.code};
}

function condition({name, codes, met}: Rule, status: Status, told: Unmet[]): Condition {
  const reason = told.find(({code}) => codes.includes(code));
  if (reason) return {name, state: 'unmet', code: reason.code, detail: reason.detail};
  const value = status.controller_connected ? met(status) : name === 'readyController' ? false : null;
  if (value === null) return {name, state: 'unknown', code: null, detail: null};
  return {name, state: value ? 'met' : 'unmet', code: value ? null : codes[0] ?? null, detail: null};
}
