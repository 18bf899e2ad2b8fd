import assert from 'node:assert/strict';
import {test} from 'node:test';
import type {Parameter, Result, Run, UncertaintyMap} from 'page/api/documents.ts';
import {compareRuns, trend} from 'page/model/history.ts';
import {layersOf, rangeOf} from 'page/model/map_layers.ts';
import {conditions} from 'page/model/readiness.ts';
import {mainAction, mayPause, mood} from 'page/model/states.ts';
import {verdictOf} from 'page/model/verdict.ts';
import {statusWith} from './statuses.ts';

const parameter = (name: string, error: number | null, std_uncertainty: number | null): Parameter =>
    ({name, group: 'arm', unit: 'mm', nominal: 0, status: error === null ? 'weak' : 'identified', error, std_uncertainty, interval95: null, grouped_with: []});
const resultWith = (parameters: Parameter[]): Result => ({parameters, planes: []} as unknown as Result);

test('ADifferenceCountsBeyondBothUncertaintiesOnly', () => {
  const rows = compareRuns(resultWith([parameter('d2', 1, 0.1), parameter('d3', 1, 0.1), parameter('d4', null, null)]),
                           resultWith([parameter('d2', 1.2, 0.1), parameter('d3', 1.4, 0.1), parameter('d4', null, null)]));
  assert.deepEqual(rows.map((row) => [row.parameter.name, row.isSignificant]), [['d2', false], ['d3', true]]);
});

test('ATrendHasTheCompleteRunsOldestFirst', () => {
  const run = (id: string, outcome: Run['outcome']): Run => ({id, outcome} as Run);
  const points = trend([run('11', 'complete'), run('10', 'stopped'), run('9', 'complete'), run('8', 'complete')],
                       {'11': resultWith([parameter('d2', 3, 0)]), '10': resultWith([parameter('d2', 9, 0)]), '9': resultWith([parameter('d2', 2, 0)])},
                       {kind: 'parameter', name: 'd2'});
  assert.deepEqual(points, [{run: 9, value: 2}, {run: 11, value: 3}]);
});

test('TheMapIsReadWithXRunningFastestThenYThenZ', () => {
  const map: UncertaintyMap = {
    box: {name: 'b', min_mm: [0, -20, 0], max_mm: [30, 0, 10]}, counts: [3, 2, 1], cell_mm: [10, 10, 10], values_mm: [1, 2, 3, 4, null, 6],
  };
  assert.deepEqual(layersOf(map), [{y_mm: -15, rows: [[1, 2, 3]]}, {y_mm: -5, rows: [[4, null, 6]]}]);
  assert.deepEqual(rangeOf(map), [1, 6]);
  assert.equal(rangeOf({...map, values_mm: [null]}), null);
});

test('UnknownIsNeverShownAsMet', () => {
  assert.ok(conditions(null, null).every(({state}) => state === 'unknown'));
  const dark = statusWith({controller_connected: false, controller_powered: null, controller_mode: null, controller_estop: null,
                           controller_cell_closed: null, controller_touch_tested: null, probe: null});
  const list = conditions(dark, [{code: 'controller_not_connected', detail: 'no link'}]);
  assert.deepEqual(list.map(({state}) => state), ['unmet', 'unknown', 'unknown', 'unknown', 'unknown', 'unknown', 'unknown']);
  assert.ok(conditions(statusWith({}), null).some(({state}) => state === 'unknown'), 'the daemon did not say that all is met');
});

test('AConditionThatThePageDoesNotKnowIsShownWithTheDaemonsWords', () => {
  const list = conditions(statusWith({}), [{code: 'store_not_writable', detail: 'free disk space'}]);
  assert.deepEqual(list.filter(({state}) => state === 'unmet').map(({code, detail}) => [code, detail]), [['store_not_writable', 'free disk space']]);
});

test('EveryStateAtRestHasItsMainButton', () => {
  assert.deepEqual((['IDLE', 'COMPLETE', 'HELD', 'SUSPENDED', 'STOPPED', 'ABORTED', 'EXECUTE'] as const).map(mainAction),
                   ['start', 'start', 'resume', 'resume', 'reset', 'clear', null]);
  assert.ok(mayPause('EXECUTE') && !mayPause('HELD'));
});

test('AnAbnormalStateLooksAbnormal', () => {
  assert.equal(mood(statusWith({state: 'IDLE'})), 'rest');
  assert.equal(mood(statusWith({state: 'EXECUTE'})), 'work');
  assert.equal(mood(statusWith({state: 'HELD'})), 'wait');
  assert.equal(mood(statusWith({state: 'HELD', fault_code: 'no_contact'})), 'wrong');
  assert.equal(mood(statusWith({state: 'ABORTED'})), 'wrong');
});

test('TheRunSaysItsVerdictAndNotAResultThatIsBehindIt', () => {
  const behind = {complete: false, verdict: {accepted: false}} as Result;
  const whole = {complete: true, verdict: {accepted: true}} as Result;
  const verdict = (status: Parameters<typeof statusWith>[0], result: Result) => verdictOf('1', result, {status: statusWith(status), runs: []});
  assert.equal(verdict({state: 'COMPLETE', run_id: '1', verdict: 'accepted'}, behind), 'accepted');
  assert.equal(verdict({state: 'EXECUTE', run_id: '1', verdict: 'none'}, whole), 'none');
  assert.equal(verdict({state: 'COMPLETE', run_id: '1', verdict: 'incomplete'}, whole), 'incomplete');
  assert.equal(verdict({run_id: '2'}, whole), 'accepted');
  assert.equal(verdict({run_id: '2'}, behind), 'incomplete');
  assert.equal(verdictOf('1', whole, {status: null, runs: [{id: '1', verdict: 'rejected'} as Run]}), 'rejected');
});
