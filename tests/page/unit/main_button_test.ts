import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import type {Cell, Status} from 'page/api/documents.ts';
import {secondsLeft} from 'page/model/countdown.ts';
import {causeOf} from 'page/model/fault_cause.ts';
import {mainButton} from 'page/model/main_button.ts';
import {kFirstState, reduce, type PageState} from 'page/model/page_state.ts';
import {isAtWork} from 'page/model/sticky_faults.ts';
import {reasonWords} from 'page/words/reason_words.ts';
import {stickyTitle} from 'page/words/sticky_title.ts';
import {kPaths} from 'page/view/symbol.tsx';
import {loadLanguage, sayIn} from 'page/words/words.ts';
import {statusWith} from './statuses.ts';

before(() => loadLanguage('de'));

const kOperating: PageState = {...kFirstState, link: 'live', role: 'operate', unmet: [], recipe: 'quick'};
const take = (state: PageState, heard_ms: number, ...statuses: Status[]): PageState => reduce(state, {type: 'statuses', statuses, heard_ms});
const kLost = {
  fault_code: 'permission_lost', fault_message: 'power, mode, hold, emergency stop or an opened cell took the permission to move; the controller tells an emergency stop, no power',
};
const buttonOf = (changes: Partial<PageState>, status: Partial<Status> = {}) => mainButton({...take(kOperating, 0, statusWith(status)), ...changes}, false);

test('TheMainButtonSaysWhyItDoesNothing', () => {
  assert.deepEqual(buttonOf({}), {action: 'start', why: null});
  assert.deepEqual(buttonOf({link: 'lost'}).why, {key: 'whyNoLink'});
  assert.deepEqual(buttonOf({role: 'view'}).why, {key: 'whyWatching'});
  assert.deepEqual(buttonOf({role: null}).why, {key: 'whyUnknown'});
  assert.deepEqual(buttonOf({unmet: null}).why, {key: 'whyUnknown'});
  assert.deepEqual(buttonOf({recipe: null}).why, {key: 'whyNoRecipe'});
  assert.deepEqual(buttonOf({busy: 'start'}).why, {key: 'whySent'});
  assert.deepEqual(buttonOf({unmet: [{code: 'emergency_stop', detail: 'd'}]}).why, {key: 'whyNotReady', cause: 'estop'});
  assert.deepEqual(buttonOf({unmet: [{code: 'store_not_writable', detail: 'd'}]}).why, {key: 'whyNotReady', code: 'store_not_writable'});
  assert.deepEqual(buttonOf({}, {controller_estop: true}).why, {key: 'whyNotReady', cause: 'estop'});
  assert.deepEqual(buttonOf({}, {state: 'EXECUTE'}).why, {key: 'whyRunning'});
  assert.deepEqual(buttonOf({}, {state: 'HOLDING'}).why, {key: 'whyChanging', state: 'HOLDING'});
  assert.deepEqual(buttonOf({}, {state: 'HELD'}), {action: 'resume', why: null});
  assert.deepEqual(buttonOf({}, {state: 'HELD', controller_connected: false}), {action: 'resume', why: {key: 'noController'}});
  for (const state of ['IDLE', 'EXECUTE'] as const) assert.deepEqual(buttonOf({}, {state, by_hand: 'locate'}).why, {key: 'locatingFirst'});
  assert.equal(reasonWords({key: 'whyNotReady', cause: 'estop'}, sayIn('de'), 'de'), 'zuerst: den Not-Halt lösen');
});

test('ClearWaitsForWhatTheControllerStillTells', () => {
  const aborted = take(kOperating, 0, statusWith({sequence: 1, state: 'ABORTED', run_id: '1', ...kLost, controller_estop: true}));
  assert.deepEqual(mainButton(aborted, false), {action: 'clear', why: {key: 'whyNotReady', cause: 'estop'}});
  const released = take(aborted, 0, statusWith({sequence: 2, state: 'ABORTED', run_id: '1', ...kLost, controller_estop: false}));
  assert.deepEqual(mainButton(released, false), {action: 'clear', why: null});
});

test('AFaultWhoseCauseIsStillToldIsAtWorkThoughTheDaemonHasDroppedIt', () => {
  let state = take(kOperating, 0, statusWith({sequence: 1, state: 'ABORTED', run_id: '1', ...kLost, controller_estop: true}));
  const {key} = state.faults[0]!;
  state = take(state, 0, statusWith({sequence: 2, state: 'STOPPED', run_id: '1', controller_estop: true}));  // cleared by another
  assert.deepEqual(state.faults.map(isAtWork), [true]);
  assert.equal(reduce(state, {type: 'noted', key}).faults.length, 1);
  assert.deepEqual(reduce(state, {type: 'acknowledged', key}).faults.map(isAtWork), [true]);
  state = take(state, 0, statusWith({sequence: 3, state: 'STOPPED', run_id: '1', controller_estop: false}));
  assert.deepEqual(state.faults.map(isAtWork), [false]);
  state = take(state, 0, statusWith({sequence: 4, state: 'STOPPED', run_id: '1', controller_estop: true}));
  assert.deepEqual(state.faults.map(isAtWork), [false], 'another press is another fault');
});

test('APermissionThatWasLostIsCalledByWhatTookIt', () => {
  const cause = (message: string, changes: Partial<Status> = {}) => causeOf('permission_lost', message, statusWith(changes));
  assert.equal(cause('x; the controller tells an emergency stop, no power'), 'estop');
  assert.equal(cause("x; the controller tells an open cell, no power, the mode 'manual'"), 'cell');
  assert.equal(cause("x; the controller tells no power, the mode 'manual'"), 'mode');
  assert.equal(cause('x; the controller tells hold'), 'hold');
  assert.equal(cause('x; the controller tells no power'), 'power');
  assert.equal(cause('power, mode, hold, emergency stop or an opened cell took the permission to move', {controller_estop: true}), 'estop');
  assert.equal(cause('power, mode, hold, emergency stop or an opened cell took the permission to move'), null);
  assert.equal(causeOf('collision', 'm', statusWith({controller_estop: true})), null);
  assert.equal(stickyTitle({code: 'permission_lost', cause: 'estop'}, 'en'), 'emergency stop');
  assert.equal(stickyTitle({code: 'permission_lost', cause: null}, 'de'), 'Bewegung gesperrt');
  assert.equal(stickyTitle({code: 'collision', cause: null}, 'en'), 'collision');
});

test('ACauseThatComesWithTheNextStateNamesTheFaultThen', () => {
  const told = {...kLost, fault_message: 'power, mode, hold, emergency stop or an opened cell took the permission to move'};
  let state = take(kOperating, 0, statusWith({sequence: 1, state: 'HELD', run_id: '1', ...told}));
  assert.equal(state.faults[0]!.cause, null);
  state = take(state, 0, statusWith({sequence: 2, state: 'HELD', run_id: '1', ...told, controller_estop: true, controller_powered: false}));
  assert.equal(state.faults[0]!.cause, 'estop');
});

test('TheTimeForTheKeyIsCountedFromWhenThePageHeardThatItIsAwaited', () => {
  const cell = {confirm_s: 30} as Cell;
  const left = (state: PageState, now_ms: number) => secondsLeft({...state, cell}, now_ms);
  let state = take(kOperating, 0, statusWith({sequence: 1, state: 'STARTING'}));
  assert.equal(left(state, 0), null);
  state = take(state, 1000, statusWith({sequence: 2, state: 'STARTING', waiting_for: 'confirmation'}));
  assert.equal(left(state, 1000), 30);
  assert.equal(left(state, 700), 30, 'the clock of the page ticks behind what it hears');
  state = take(state, 9000, statusWith({sequence: 3, state: 'STARTING', waiting_for: 'confirmation', controller_powered: false}));
  assert.equal(left(state, 11500), 20, 'another change is not another wait');
  assert.equal(left(state, 99000), 0);
  assert.equal(secondsLeft({...state, cell: {} as Cell}, 11500), null, 'an older daemon does not tell it');
  const loaded = take(kOperating, 1000, statusWith({sequence: 2, state: 'STARTING', waiting_for: 'confirmation'}));
  assert.equal(left(loaded, 1000), null, 'a page that was loaded meanwhile does not know');
});

test('EachStateHasItsOwnIcon', () => {
  const states = ['STOPPED', 'RESETTING', 'IDLE', 'STARTING', 'EXECUTE', 'COMPLETING', 'COMPLETE', 'HOLDING', 'HELD', 'UNHOLDING', 'SUSPENDING', 'SUSPENDED',
                  'UNSUSPENDING', 'STOPPING', 'ABORTING', 'ABORTED', 'CLEARING', 'notReady', 'locating', 'motionDisabled', 'blockToMove', 'lost', 'unknown'] as const;
  const paths = states.map((state) => kPaths[state]);
  assert.equal(new Set(paths).size, states.length);
});
