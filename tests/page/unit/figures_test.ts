import assert from 'node:assert/strict';
import {test} from 'node:test';
import type {Cell, Parameter, Result, Run, UncertaintyMap} from 'page/api/documents.ts';
import {compareHeldOut, trend, trendChoices} from 'page/model/history.ts';
import {layersOf, rangeOf} from 'page/model/map_layers.ts';
import {conditions} from 'page/model/readiness.ts';
import {kTouchFaults, mainAction, mayPause, mood, touchActions} from 'page/model/states.ts';
import {residualsOf} from 'page/model/live_figures.ts';
import {slimResult} from 'page/model/slim_result.ts';
import {tipRows} from 'page/model/tip_rows.ts';
import {verdictOf} from 'page/model/verdict.ts';
import {statusWith} from './statuses.ts';

const parameter = (name: string, error: number | null, std_uncertainty: number | null): Parameter =>
    ({name, group: 'arm', unit: 'mm', nominal: 0, status: error === null ? 'weak' : 'identified', error, std_uncertainty, interval95: null, grouped_with: []});
const resultWith = (parameters: Parameter[]): Result => ({parameters, planes: [], planes_held_out: []} as unknown as Result);

test('ATrendHasTheCompleteRunsOldestFirst', () => {
  const run = (id: string, outcome: Run['outcome']): Run => ({id, outcome} as Run);
  const points = trend([run('11', 'complete'), run('10', 'stopped'), run('9', 'complete'), run('8', 'complete')],
                       {'11': resultWith([parameter('d2', 3, 0)]), '10': resultWith([parameter('d2', 9, 0)]), '9': resultWith([parameter('d2', 2, 0)])},
                       {kind: 'parameter', name: 'd2', unit: 'mm'}, null);
  assert.deepEqual(points, [{run: 9, value: 2}, {run: 11, value: 3}]);
});

const heldOut = (rms: Record<number, number>): Result => ({
  ...resultWith([]), planes_held_out: Object.entries(rms).map(([plane, calibrated_rms_mm]) => ({plane: Number(plane), calibrated_rms_mm})),
} as unknown as Result);

test('PlanesAreComparedByTheirHeldOutDistances', () => {
  assert.deepEqual(compareHeldOut(heldOut({3: 0.5, 1: 0.25}), heldOut({1: 0.75}), null),
                   [{plane: 1, place: null, tip: null, a: 0.25, b: 0.75, difference: 0.5},
                    {plane: 3, place: null, tip: null, a: 0.5, b: null, difference: null}]);
  const results = {'2': heldOut({1: 0.25})};
  const [of] = trendChoices(results, null);
  assert.deepEqual(trend([{id: '2', outcome: 'complete'} as Run], results, of!, null), [{run: 2, value: 0.25}]);
});

test('OnlyWhatHoldsASingleTouchIsMadeAgainOrLeftOut', () => {
  const actions = (fault_code: string) => touchActions(statusWith({state: 'HELD', fault_code}));
  for (const code of kTouchFaults) assert.deepEqual(actions(code), ['retry', 'skip'], code);
  for (const code of ['daemon_restarted', 'cell_open', 'not_confirmed', 'block_moved', 'block_to_move']) assert.deepEqual(actions(code), [], code);
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
  assert.deepEqual((['IDLE', 'COMPLETE', 'HELD', 'SUSPENDED', 'STOPPED', 'ABORTED', 'EXECUTE'] as const).map((state) => mainAction(state, false)),
                   ['start', 'start', 'resume', 'resume', 'reset', 'clear', null]);
  assert.deepEqual((['IDLE', 'COMPLETE', 'HELD', 'STOPPED'] as const).map((state) => mainAction(state, true)),
                   ['reset', 'start', 'resume', 'reset']);
  assert.ok(mayPause('EXECUTE') && !mayPause('HELD'));
});

test('AnAbnormalStateLooksAbnormal', () => {
  assert.equal(mood(statusWith({state: 'IDLE'})), 'rest');
  assert.equal(mood(statusWith({state: 'EXECUTE'})), 'work');
  assert.equal(mood(statusWith({state: 'RESETTING'})), 'rest');
  assert.equal(mood(statusWith({state: 'RESETTING', controller_permit: 'granted'})), 'work');
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

const expanded = (rms: number) => ({k: 2, box_rms_mm: rms, box_p95_mm: 1.5 * rms, box_max_mm: 2 * rms});
const tipOf = (more: object): Result => ({
  ...resultWith([]),
  tip_uncertainty: {expanded: expanded(0.1), arm_frame: {at_block_rms_mm: 9, expanded: expanded(0.25)}, at_block_rms_mm: 9, map: null}, ...more,
} as unknown as Result);

test('TheTipsUncertaintyIsThatOfBothFramesAndOfSimulationsWhereThereAreAny', () => {
  const linear = [{name: 'tipBlockFrame', rms_mm: 0.1, p95_mm: 0.15000000000000002, worst_mm: 0.2},
                  {name: 'tipArmFrame', rms_mm: 0.25, p95_mm: 0.375, worst_mm: 0.5}];
  assert.deepEqual(tipRows(slimResult(tipOf({monte_carlo: null}))), linear);
  const monte_carlo = {count: 100, converged: 99, box_rms_mm: 0.06, box_p95_mm: 0.11, joint_ranges_rms_mm: 0.2, linear_over_monte_carlo: 0.9};
  assert.deepEqual(tipRows(slimResult(tipOf({monte_carlo}))),
                   [...linear, {name: 'tipSimulated', rms_mm: 0.12, p95_mm: 0.11, worst_mm: null}]);
  assert.deepEqual(tipRows(tipOf({monte_carlo: {...monte_carlo, box_rms_mm: null, box_p95_mm: null}})).at(-1),
                   {name: 'tipSimulated', rms_mm: null, p95_mm: null, worst_mm: null});
  assert.deepEqual(tipRows(tipOf({tip_uncertainty: {at_block_rms_mm: 9, map: null}})), [], 'of an older daemon');
});

test('TheResidualsOfAFaceFoundInPlaceAreFromWhereItWasFound', () => {
  const cell = {acceptance: {held_out_mean_max_mm: 0.05, held_out_rms_max_mm: 0.05}} as unknown as Cell;
  const plane = {plane: 5, reference_mm: 0, calibrated_mean_mm: 0.5, calibrated_rms_mm: 0.01};
  const mean = (estimated_offset_mm?: number | null) =>
      residualsOf({planes: [{...plane, estimated_offset_mm}], planes_held_out: []} as unknown as Result, cell)[0]!.fit;
  assert.deepEqual(mean(0.5), {mean_mm: 0, rms_mm: 0.01, isWithin: true});
  assert.equal(mean(null)?.isWithin, false);
  assert.equal(mean()?.mean_mm, 0.5);
});
