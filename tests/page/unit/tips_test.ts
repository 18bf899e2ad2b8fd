import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import type {Cell, Recipes, Result, Touch, Vector} from 'page/api/documents.ts';
import {faceLabel, faceWords, planeNumber} from 'page/model/faces.ts';
import {compareHeldOut} from 'page/model/history.ts';
import {touchPoints} from 'page/model/live_figures.ts';
import {furtherTip, numberingOf, ownPlane, touchesAt, whereByNumber, whereByResult} from 'page/model/places.ts';
import {slimResult} from 'page/model/slim_result.ts';
import {handWords} from 'page/words/hand_words.ts';
import {kLanguages, loadLanguage, sayIn} from 'page/words/words.ts';
import {statusWith} from './statuses.ts';

before(() => Promise.all(kLanguages.map(loadLanguage)));

const kTips = [{name: 'right', center_mm: [-40, 0, -30], radius_mm: 1.5}, {name: 'left', center_mm: [40, 0, -30], radius_mm: 1.5}];
const kStill = {alpha_rad: 0, d_mm: 0, theta_rad: 0, r_mm: 0, beta_rad: 0};
const kCell = {
  block: {faces: [1, 2, 3, 4, 5, 6].map((plane) => ({plane, name: plane === 5 ? 'top' : null}))}, probe: {tips: kTips},
  scene: {frames: [...Array(7).fill(kStill), {...kStill, r_mm: 100}], gains: [1, 1, 1, 1, 1, 1]},
} as unknown as Cell;
const kRecipes = {recipes: [
  {name: 'star', places: [], tips: ['left', 'right']}, {name: 'both', places: ['stand'], tips: ['left']}, {name: 'high', places: ['stand']},
]} as unknown as Recipes;
const [kStar, kBoth] = [numberingOf(kRecipes, 'star'), numberingOf(kRecipes, 'both')];

test('AtEachPlacePlanesAreNumberedOnFromTipToTip', () => {
  assert.deepEqual([6, 7, 13, 18].map((plane) => ownPlane(kCell, plane, kStar.tips)),
                   [[6, 0, 0], [1, 0, 1], [1, 0, 2], [6, 0, 2]].map(([plane, place, tip]) => ({plane, place, tip})));
  const where = whereByNumber(kCell, kBoth);
  assert.deepEqual([2, 8, 14, 20, 26].map((plane) => [where(plane).place, where(plane).tip]),
                   [[null, null], [null, 'left'], ['stand', null], ['stand', 'left'], [null, null]]);
});

test('APlaneIsCalledWithTheFurtherTipThatTouchesIt', () => {
  const where = whereByNumber(kCell, kBoth);
  const called = (language: 'en' | 'fr' | 'de') => [2, 8, 14, 20].map((plane) => faceWords(kCell, plane, sayIn(language), where));
  assert.deepEqual(called('en'), ['Plane 2', 'Plane 2, tip left', 'Plane 2, stand', 'Plane 2, stand, tip left']);
  assert.deepEqual(called('fr').slice(1), ['Plan 2, bille left', 'Plan 2, stand', 'Plan 2, stand, bille left']);
  assert.deepEqual(called('de').slice(1), ['Fläche 2, Kugel left', 'Fläche 2, stand', 'Fläche 2, stand, Kugel left']);
  const say = sayIn('en');
  assert.equal(faceWords(kCell, 11, say, where), 'top, tip left');
  assert.deepEqual([8, 20].map((plane) => faceLabel(kCell, plane, say, where)), ['2, tip left', '2, stand, tip left']);
  assert.deepEqual([8, 20].map((plane) => planeNumber(kCell, plane, say, where)), ['2 (tip left)', '2 (stand, tip left)']);
  const guided = statusWith({by_hand: 'guided', by_hand_step: 'touch', by_hand_plane: 20, by_hand_words: 'w'});
  assert.match(handWords(guided, 'de', kCell, where), /^Fläche 2 \(stand, Kugel left\) etwa/);
});

test('TouchesAtAPlaceAreThoseOfAllTips', () => {
  const touches = [2, 8, 14, 20].map((plane) => ({plane}));
  const planesAt = (place: string | null) => touchesAt(touches, place, kCell, kBoth).map(({plane}) => plane);
  assert.deepEqual([planesAt(null), planesAt('stand')], [[2, 8], [14, 20]]);
});

test('ATouchIsDrawnWhereTheBallThatTouchesIs', () => {
  assert.equal(furtherTip(kCell, 2, kStar), null);
  assert.deepEqual([8, 14].map((plane) => furtherTip(kCell, plane, kStar)?.name), ['left', 'right']);
  const touches = [2, 8, 14].map((plane) => ({plane, joints_deg: [0, 0, 0, 0, 0, 0]})) as unknown as Touch[];
  assert.deepEqual(touchPoints(kCell, touches, kStar), [[0, 0, 100], [40, 0, 70], [-40, 0, 70]] as Vector[]);
  const old = {...kCell, probe: {name: 'p', stylus_radius_mm: 1.5}} as Cell;
  assert.deepEqual(touchPoints(old, touches, kStar), [[0, 0, 100], [0, 0, 100], [0, 0, 100]], 'a daemon that does not tell the tips');
});

const heldOut = (rows: [number, string | undefined, string | undefined, number][]): Result => ({
  parameters: [], planes: [], tip_uncertainty: {},
  planes_held_out: rows.map(([plane, place, tip, calibrated_rms_mm]) => ({plane, place, tip, calibrated_rms_mm})),
} as unknown as Result);

test('TheSamePlaneIsComparedWhateverElseTheRecipesTouched', () => {
  const [one, star] = [heldOut([[2, undefined, undefined, 0.25], [8, 'stand', undefined, 0.5]]),
                       heldOut([[2, undefined, undefined, 0.125], [8, undefined, 'left', 1], [14, 'stand', undefined, 0.75]])];
  assert.deepEqual(compareHeldOut(one, star, kCell).map(({plane, place, tip, a, b}) => [plane, place, tip, a, b]),
                   [[2, null, null, 0.25, 0.125], [2, 'stand', null, 0.5, 0.75], [2, null, 'left', null, 1]]);
  assert.deepEqual(whereByResult(star)(8), {place: null, tip: 'left'});
  assert.equal(slimResult(star).planes_held_out[1]!.tip, 'left');
});
