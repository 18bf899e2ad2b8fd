import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import type {Box, Cell, Face, Recipes, Result, Vector} from 'page/api/documents.ts';
import {faceLabel, faceWords, planeNumber} from 'page/model/faces.ts';
import {compareHeldOut, trend, trendChoices} from 'page/model/history.ts';
import {apply, placePose} from 'page/model/kinematics.ts';
import {mainButton} from 'page/model/main_button.ts';
import {kFirstState, reduce, type PageState} from 'page/model/page_state.ts';
import {furtherPlace, numberingOf, ownPlane, touchesAt, whereByNumber, whereByResult} from 'page/model/places.ts';
import {isBlockToMove, mood, touchActions} from 'page/model/states.ts';
import {blockMeshes} from 'page/scene/meshes.ts';
import {handWords} from 'page/words/hand_words.ts';
import {loadLanguage, sayIn} from 'page/words/words.ts';
import {statusWith} from './statuses.ts';

before(() => loadLanguage('fr'));

const kStand = {name: 'stand', is_known: true, shift_mm: [10, -300, 20] as Vector, turn_deg: [0, 90, 0] as Vector};
const kSide = {...kStand, name: 'side', is_known: false};
const kCell = {block: {faces: [1, 2, 3, 4, 5, 6].map((plane) => ({plane})), places: [kSide, kStand]}} as unknown as Cell;
const kRecipes = {recipes: [{name: 'high', places: ['stand', 'side']}, {name: 'quick', places: []}, {name: 'old'}]} as unknown as Recipes;
const kHigh = whereByNumber(kCell, numberingOf(kRecipes, 'high'));

test('PlanesAreNumberedOnFromPlaceToPlace', () => {
  assert.deepEqual([1, 6, 7, 12, 13].map((plane) => ownPlane(kCell, plane, [])),
                   [[1, 0], [6, 0], [1, 1], [6, 1], [1, 2]].map(([plane, place]) => ({plane, place, tip: 0})));
  assert.deepEqual(ownPlane(null, 8, []), {plane: 8, place: 0, tip: 0}, 'the cell is not heard yet');
  assert.deepEqual([2, 8, 14, 20].map((plane) => kHigh(plane).place), [null, 'stand', 'side', null]);
});

test('APlaneIsCalledWithItsFurtherPlace', () => {
  const say = sayIn('en');
  assert.deepEqual([2, 8, 14].map((plane) => faceWords(kCell, plane, say, kHigh)), ['Plane 2', 'Plane 2, stand', 'Plane 2, side']);
  assert.equal(faceWords(kCell, 8, sayIn('fr'), kHigh), 'Plan 2, stand');
  assert.deepEqual([2, 8].map((plane) => faceLabel(kCell, plane, say, kHigh)), ['2', '2, stand']);
  assert.deepEqual([2, 8].map((plane) => planeNumber(kCell, plane, say, kHigh)), ['2', '2 (stand)']);
  for (const name of ['old', 'gone', null]) {
    const whereOf = whereByNumber(kCell, numberingOf(kRecipes, name));
    assert.equal(faceWords(kCell, 8, say, whereOf), 'Plane 8', 'the number as the daemon has it');
  }
  const named = {block: {...kCell.block, faces: kCell.block.faces.map((face) => ({...face, name: face.plane === 2 ? 'top' : ''}))}} as Cell;
  assert.equal(faceWords(named, 8, say, kHigh), 'top, stand');
  const guided = statusWith({by_hand: 'guided', by_hand_step: 'touch', by_hand_plane: 8, by_hand_words: 'w'});
  assert.match(handWords(guided, 'fr', kCell, kHigh), /^Palpez le plan 2 \(stand\) à peu près/);
});

const rowsOf = (rows: [number, string | undefined, number][]): Result => ({
  parameters: [], planes: [],
  planes_held_out: rows.map(([plane, place, calibrated_rms_mm]) => ({plane, place, calibrated_rms_mm})),
} as unknown as Result);

test('TheSameNumberAtAnotherPlaceIsAnotherPlane', () => {
  const [one, other] = [rowsOf([[2, undefined, 0.25], [8, 'stand', 0.5]]), rowsOf([[2, undefined, 0.125], [8, 'side', 0.75]])];
  assert.deepEqual([2, 8].map((plane) => whereByResult(one)(plane).place), [null, 'stand']);
  assert.deepEqual(compareHeldOut(one, other, kCell).map(({plane, place, a, b}) => [plane, place, a, b]),
                   [[2, null, 0.25, 0.125], [2, 'stand', 0.5, null], [2, 'side', null, 0.75]]);
  const choices = trendChoices({'1': one, '2': other}, kCell);
  assert.equal(choices.length, 3);
  const runs = ['2', '1'].map((id) => ({id, outcome: 'complete'})) as unknown as PageState['runs'];
  assert.deepEqual(trend(runs, {'1': one, '2': other}, choices[1]!, kCell), [{run: 1, value: 0.5}, {run: 2, value: null}]);
});

test('TouchesAreThoseOfThePlaceWhereTheBlockStands', () => {
  const touches = [1, 8, 14, 3, 7].map((plane) => ({plane}));
  const planesAt = (place: string | null) => touchesAt(touches, place, kCell, {places: ['stand', 'side'], tips: []}).map(({plane}) => plane);
  assert.deepEqual([planesAt(null), planesAt('first'), planesAt('stand'), planesAt('side')], [[1, 3], [1, 3], [8, 7], [14]]);
});

test('AtAPlaceTheBlockIsTurnedAndShifted', () => {
  const at = placePose(kStand);
  const near = (point: Vector, expected: Vector) => point.forEach((value, i) => assert.ok(Math.abs(value - expected[i]!) < 1e-9, `${point}`));
  near(apply(at, [0, 0, 0]), [10, -300, 20]);
  near(apply(at, [1, 0, 0]), [10, -300, 19]);
  near(apply(at, [0, 0, 1]), [11, -300, 20]);
  near(apply(placePose({shift_mm: [1, 2, 3], turn_deg: [0, 0, 0]}), [4, 5, 6]), [5, 7, 9]);
  const length = 120 / Math.sqrt(3);
  near(apply(placePose({shift_mm: [0, 0, 0], turn_deg: [length, length, length]}), [1, 2, 3]), [3, 1, 2]);
  assert.equal(furtherPlace(kCell, 'stand'), kStand);
  for (const name of ['first', null, undefined]) assert.equal(furtherPlace(kCell, name), null);
});

test('OnlyWhatIsLiftedMovesWithTheBlock', () => {
  const table: Box = {name: 'table', min_mm: [-500, 75, -500], max_mm: [500, 100, 500]};
  const block: Box = {name: 'block', min_mm: [-75, -75, -75], max_mm: [75, 75, 75]};
  const face = {plane: 1, outward: [0, -1, 0], center_mm: [0, -75, 0]} as unknown as Face;
  const ball = {...face, plane: 2, sphere: {center_mm: [0, -100, 0], radius_mm: 15}} as unknown as Face;
  assert.deepEqual(blockMeshes([table, block], [face, ball]).map(({isMoving}) => isMoving), [false, true, true]);
  assert.deepEqual(blockMeshes([table], [face]).map(({isMoving}) => isMoving), [true], 'the face lies on none of them');
});

const kToMove = {
  fault_code: 'block_to_move', fault_message: 'the block is to be brought to another place: to "stand", into its dowels', fault_robot_action: 'a', fault_next_step: 'b',
};
const take = (state: PageState, ...statuses: ReturnType<typeof statusWith>[]): PageState => reduce(state, {type: 'statuses', statuses, heard_ms: 0});

test('ABlockThatIsToBeMovedIsAStepOfTheWorkAndNoFault', () => {
  const held = statusWith({state: 'HELD', run_id: '1', block_place: 'stand', ...kToMove});
  assert.ok(isBlockToMove(held));
  assert.equal(mood(held), 'wait');
  assert.equal(mood(statusWith({state: 'STOPPED', run_id: '1', ...kToMove})), 'rest');
  assert.equal(mood({...held, controller_estop: true}), 'wrong');
  assert.deepEqual(touchActions(held), []);
  assert.ok(!isBlockToMove(statusWith({state: 'EXECUTE', run_id: '1'})));
  const operating: PageState = {...kFirstState, link: 'live', role: 'operate', unmet: []};
  assert.deepEqual(mainButton(take(operating, held), false), {action: 'resume', why: null});
});

test('NobodyHasToNoteThatTheBlockWasMoved', () => {
  const lost = {...kToMove, fault_code: 'link_lost', fault_message: 'the link is lost'};
  const state = take(kFirstState, statusWith({sequence: 1, state: 'HELD', run_id: '1', ...lost}),
                     statusWith({sequence: 2, state: 'HELD', run_id: '1', ...kToMove}));
  assert.deepEqual(state.faults.map(({code, isOver}) => [code, isOver]), [['link_lost', true]], 'what was told before is still to be read');
  assert.equal(take(state, statusWith({sequence: 3, state: 'EXECUTE', run_id: '1'})).faults.length, 1);
});
