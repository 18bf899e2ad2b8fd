import assert from 'node:assert/strict';
import {test} from 'node:test';
import type {Checks, Run, Status, Verification} from 'page/api/documents.ts';
import {checkedRun, dataAge_ms, kFirstState, newestRun, reduce, type PageState} from 'page/model/page_state.ts';
import {statusWith} from './statuses.ts';

const take = (state: PageState, ...statuses: Status[]): PageState => reduce(state, {type: 'statuses', statuses, heard_ms: 0});
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
  state = reduce(state, {type: 'acknowledged', key: state.faults[0]!.key});
  assert.deepEqual(state.faults.map(({code}) => code), ['probe_bounced']);
});

test('AWarningThatEndsByItselfGoesWithItsCause', () => {
  const slow = statusWith({sequence: 1, state: 'EXECUTE', run_id: '1', warning_code: 'computation_slow', warning_message: 'w'});
  assert.deepEqual(take(kFirstState, slow).faults.map(({code}) => code), ['computation_slow']);
  assert.deepEqual(take(kFirstState, slow, statusWith({sequence: 2, state: 'EXECUTE', run_id: '1'})).faults, []);
});

test('AWarningThatAPersonHasNotedStaysAwayBehindOneThatPasses', () => {
  const told = {state: 'EXECUTE', run_id: '1'} as const;
  const bounced = {...told, warning_code: 'probe_bounced', warning_message: 'w'};
  const first = take(kFirstState, statusWith({sequence: 1, ...bounced}));
  const noted = reduce(first, {type: 'noted', key: first.faults[0]!.key});
  const slow = statusWith({sequence: 2, ...told, warning_code: 'store_slow', warning_message: 's'});
  const uncovered = statusWith({sequence: 3, ...bounced});
  assert.deepEqual(take(noted, slow, uncovered).faults, []);
  assert.deepEqual(take(first, slow, uncovered).faults.map(({code}) => code), ['probe_bounced'], 'nobody has noted it');
  const newer = statusWith({sequence: 3, ...bounced, warning_message: 'another'});
  assert.deepEqual(take(noted, slow, newer).faults.map(({message}) => message), ['another']);
  const ofNext = statusWith({sequence: 3, ...bounced, run_id: '2'});
  assert.deepEqual(take(noted, slow, ofNext).faults.map(({code}) => code), ['probe_bounced']);
});

test('AnAcknowledgementTakesOnlyTheFaultThatItWasOf', () => {
  const held = {...kFault, fault_code: 'probe_stuck', fault_message: 'the probe still reads touched'};
  let state = take(kFirstState, statusWith({sequence: 1, state: 'HELD', run_id: '1', ...held}),
                   statusWith({sequence: 2, state: 'EXECUTE', run_id: '1'}),
                   statusWith({sequence: 3, state: 'ABORTED', run_id: '1', ...kFault}));
  const {key} = state.faults[0]!;
  state = take(state, statusWith({sequence: 4, state: 'STOPPED', run_id: '1'}));  // the daemon's drop is heard before its answer
  state = reduce(state, {type: 'acknowledged', key});
  assert.deepEqual(state.faults.map(({code}) => code), ['probe_stuck']);
});

test('ANewRunIsLookedAtInPlaceOfTheOneThatWasChosen', () => {
  const chosen = reduce(take(kFirstState, statusWith({sequence: 1, state: 'COMPLETE', run_id: '4'})), {type: 'patch', patch: {shownRun: '1'}});
  assert.equal(take(chosen, statusWith({sequence: 2, state: 'COMPLETE', run_id: '4', verdict: 'accepted'})).shownRun, '1');
  assert.equal(take(chosen, statusWith({sequence: 2, state: 'STARTING', run_id: '5'})).shownRun, null);
  assert.equal(newestRun({status: statusWith({run_id: '10'}), runs: [{id: '9'} as Run]}), '10');
  assert.equal(newestRun({status: statusWith({}), runs: [{id: '9'} as Run]}), '9');
  assert.equal(newestRun({status: null, runs: []}), null);
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
  const pulse = {joints, heard_ms: 1000};
  assert.equal(dataAge_ms({pulse, statusKnown_ms: 1000}, 3500), 2540);
  assert.equal(dataAge_ms({pulse, statusKnown_ms: 500}, 3500), 3000, 'the status is older than where the arm is');
  assert.equal(dataAge_ms({pulse: {...pulse, joints: {...joints, data_age_ms: null}}, statusKnown_ms: 1000}, 3500), null, 'never heard is not new');
  assert.equal(dataAge_ms({pulse: null, statusKnown_ms: 1000}, 3500), null);
  assert.equal(dataAge_ms({pulse, statusKnown_ms: null}, 3500), null);
});

test('AStatusThatIsBehindThePulseGrowsOld', () => {
  const known = take(kFirstState, statusWith({sequence: 7}));
  const pulse = (sequence: number, heard_ms: number) =>
      reduce(known, {type: 'joints', joints: {joints_deg: null, data_age_ms: 10, sequence, instance_id: 'a'}, heard_ms});
  assert.equal(pulse(7, 5000).statusKnown_ms, 5000);
  assert.equal(pulse(8, 5000).statusKnown_ms, 0);
});

test('AThousandTouchesKeepAPointEachAndNoMore', () => {
  let state: PageState = kFirstState;
  for (let i = 1; i <= 3000; ++i) state = take(state, statusWith({sequence: i, state: 'EXECUTE', run_id: '1', touches_done: Math.ceil(i / 3)}));
  assert.equal(state.series.points.length, 1000);
});

const found = (of_run: string, overdue: boolean) => ({kind: 'known' as const, checks: {of_run, overdue} as Checks});

test('TheChecksOfTheCalibrationThatCountsAreTheNewestThatWereHeard', () => {
  let state = reduce(kFirstState, {type: 'checks', asked: null, found: found('2', false)});
  assert.deepEqual([state.countingChecks, state.checks], [found('2', false), {2: found('2', false)}]);
  state = reduce(state, {type: 'checks', asked: '1', found: found('1', true)});
  assert.deepEqual(state.countingChecks, found('2', false), 'another calibration');
  state = reduce(state, {type: 'checks', asked: '2', found: found('2', true)});
  assert.deepEqual([state.countingChecks, state.checks], [found('2', true), {1: found('1', true), 2: found('2', true)}]);
});

test('ChecksThatAreRefusedSayWhyAndNoCalibrationSaysNothing', () => {
  const refused = {kind: 'refused' as const, why: 'the store is damaged'};
  const known = reduce(kFirstState, {type: 'checks', asked: null, found: found('2', false)});
  assert.deepEqual(reduce(known, {type: 'checks', asked: '2', found: refused}).checks, {2: refused});
  assert.deepEqual(reduce(known, {type: 'checks', asked: null, found: refused}).countingChecks, refused);
  const none = reduce(known, {type: 'checks', asked: null, found: null});
  assert.deepEqual([none.countingChecks, none.checks], [null, known.checks]);
  const first = reduce(kFirstState, {type: 'checks', asked: '1', found: refused});
  assert.deepEqual([first.countingChecks, first.checks], [null, {1: refused}], 'of a run that is looked at');
});

test('OnlyAShownCheckHasAChartOfItsCalibration', () => {
  const verified = (schema: string): Verification => ({schema, of_run: '1'} as Verification);
  const state = {...kFirstState, runs: [{id: '3'}, {id: '2'}] as Run[], verifications: {2: verified('touchcal/proof/1'), 3: verified('touchcal/check/1')}};
  assert.equal(checkedRun(state), '1');
  assert.equal(checkedRun({...state, shownRun: '2'}), null);
  assert.equal(checkedRun(kFirstState), null);
});
