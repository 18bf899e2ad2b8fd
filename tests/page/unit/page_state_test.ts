import assert from 'node:assert/strict';
import {test} from 'node:test';
import type {Status} from 'page/api/documents.ts';
import {dataAge_ms, kFirstState, reduce, type PageState} from 'page/model/page_state.ts';
import {statusWith} from './statuses.ts';

const take = (state: PageState, ...statuses: Status[]): PageState => reduce(state, {type: 'statuses', statuses});
const kFault = {fault_code: 'no_contact', fault_message: 'the search ended without contact', fault_robot_action: 'a', fault_next_step: 'b'};

test('AFaultStaysUntilAPersonHasNotedIt', () => {
  let state = take(kFirstState, statusWith({sequence: 1, state: 'HELD', run_id: '1', ...kFault}));
  assert.equal(state.faults.length, 1);
  const {key} = state.faults[0]!;
  assert.equal(reduce(state, {type: 'noted', key}).faults.length, 1, 'the daemon still tells it');
  state = take(state, statusWith({sequence: 2, state: 'EXECUTE', run_id: '1'}));
  assert.deepEqual(state.faults.map(({isOver}) => isOver), [true], 'the run goes on and it is still there to be read');
  assert.equal(reduce(state, {type: 'noted', key}).faults.length, 0);
});

test('AnAcknowledgedFaultGoesAndAWarningStays', () => {
  let state = take(kFirstState, statusWith({sequence: 1, state: 'EXECUTE', run_id: '1'}),
                   statusWith({sequence: 2, state: 'EXECUTE', run_id: '1', warning_code: 'probe_bounced', warning_message: 'w'}),
                   statusWith({sequence: 3, state: 'HELD', run_id: '1', warning_code: 'probe_bounced', warning_message: 'w', ...kFault}));
  assert.deepEqual(state.faults.map(({code}) => code), ['no_contact', 'probe_bounced']);
  state = reduce(state, {type: 'acknowledged'});
  assert.deepEqual(state.faults.map(({code}) => code), ['probe_bounced']);
});

test('TheSameFaultIsNotToldTwiceByAStatusThatChangesOtherwise', () => {
  const state = take(kFirstState, statusWith({sequence: 1, state: 'HELD', run_id: '1', ...kFault}),
                     statusWith({sequence: 2, state: 'HELD', run_id: '1', controller_powered: false, ...kFault}));
  assert.equal(state.faults.length, 1);
});

test('WhatIsToldAgainChangesNothingButTheCurves', () => {
  const now = take(kFirstState, statusWith({sequence: 9, state: 'EXECUTE', run_id: '1', touches_done: 3, condition_number: 50}));
  const state = take(now, statusWith({sequence: 7, state: 'EXECUTE', run_id: '1', touches_done: 2, condition_number: 60}),
                     statusWith({sequence: 5, state: 'IDLE', run_id: '0', touches_done: 8}));
  assert.equal(state.status, now.status);
  assert.deepEqual(state.series.points.map(({touch, condition_number}) => [touch, condition_number]), [[2, 60], [3, 50]]);
});

test('ADaemonThatStartedAnewIsBelievedThoughItsNumbersBeginAgain', () => {
  const state = take(kFirstState, statusWith({sequence: 900, state: 'EXECUTE', run_id: '1'}),
                     statusWith({sequence: 2, instance_id: 'b', state: 'HELD', run_id: '1', fault_code: 'daemon_restarted', fault_message: 'm'}));
  assert.equal(state.status?.state, 'HELD');
  assert.deepEqual(state.faults.map(({code}) => code), ['daemon_restarted']);
});

test('AStartShowsTheRunAndItsEndTheResult', () => {
  let state = take(kFirstState, statusWith({sequence: 1}));
  assert.equal(state.view, 'cell');
  state = take(state, statusWith({sequence: 2, state: 'STARTING', run_id: '1'}));
  assert.equal(state.view, 'live');
  assert.equal(take(state, statusWith({sequence: 3, state: 'COMPLETE', run_id: '1'})).view, 'result');
  const elsewhere = reduce(state, {type: 'patch', patch: {view: 'history'}});
  assert.equal(take(elsewhere, statusWith({sequence: 3, state: 'COMPLETE', run_id: '1'})).view, 'history', 'who looks elsewhere stays there');
});

test('TheAgeOfTheDataGrowsWithTheTimeSinceTheyWereHeard', () => {
  const joints = {joints_deg: null, data_age_ms: 40, sequence: 1, instance_id: 'a'};
  assert.equal(dataAge_ms({joints, heard_ms: 1000}, 3500), 2540);
  assert.equal(dataAge_ms({joints: {...joints, data_age_ms: null}, heard_ms: 1000}, 3500), null, 'never heard is not new');
  assert.equal(dataAge_ms(null, 3500), null);
});

test('AThousandTouchesKeepAPointEachAndNoMore', () => {
  let state: PageState = kFirstState;
  for (let i = 1; i <= 3000; ++i) state = take(state, statusWith({sequence: i, state: 'EXECUTE', run_id: '1', touches_done: Math.ceil(i / 3)}));
  assert.equal(state.series.points.length, 1000);
});
