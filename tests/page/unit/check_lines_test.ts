import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import type {CheckChart, CheckPoint, CheckRow, Checks} from 'page/api/documents.ts';
import {chartLines, chartMarks, markedChecks, rejectedRuns} from 'page/model/check_lines.ts';
import {beyondWords, changedWords, nextCheckWords, quantityWords} from 'page/words/check_words.ts';
import {kLanguages, loadLanguage, packOf, sayIn} from 'page/words/words.ts';

before(() => Promise.all(kLanguages.map(loadLanguage)));

const point = (run: string, value: number, changes: Partial<CheckPoint> = {}): CheckPoint =>
    ({run, value, weighted_mean: null, shewhart_limit: null, ewma_limit: null, beyond_shewhart: false, beyond_ewma: false, ...changes});
const limited = (run: string, value: number, changes: Partial<CheckPoint> = {}): CheckPoint =>
    point(run, value, {weighted_mean: value / 2, shewhart_limit: 3, ewma_limit: 1, ...changes});
const row = (run: string, changes: Partial<CheckRow> = {}): CheckRow =>
    ({run, ended_at: '2026-11-20T08:00:00.000Z', operator: null, reference: false, accepted: true, cause: null, joint: null, ...changes});
const growth = (centre: number | null, points: CheckPoint[]): CheckChart => ({quantity: 'growth', unit: 'ppm', centre, points});
const checksWith = (changes: Partial<Checks>): Checks => ({
  of_run: '1', count: 0, reference: {count: 3, needed: 3}, base: {count: 10, needed: 10}, every_days: null, due_at: null, overdue: null,
  warnings: [], checks: [], charts: [], ...changes,
});

test('LimitsOfChecksAreOnBothSidesOfTheCentreAndBeginBehindTheBase', () => {
  const lines = chartLines(growth(1, [point('4', 2), limited('5', 4)]), sayIn('en'));
  assert.deepEqual(lines.map(({kind, name, values}) => [kind, name, values]), [
    ['value', 'Value', [2, 4]], ['mean', 'Weighted mean', [null, 2]], ['limit', 'Upper limit', [null, 4]], ['limit', 'Lower limit', [null, -2]],
    ['mean limit', 'Upper limit of the mean', [null, 2]], ['mean limit', 'Lower limit of the mean', [null, 0]],
  ]);
});

test('BeforeThereAreLimitsTheFigureStandsAlone', () => {
  const lines = chartLines(growth(null, [point('4', 2)]), sayIn('en'));
  assert.deepEqual(lines, [{kind: 'value', name: 'Value', values: [2]}]);
});

test('ARejectedCheckIsNoPartOfTheWeightedMean', () => {
  const lines = chartLines(growth(0, [limited('4', 2), limited('5', 9, {weighted_mean: null, ewma_limit: null})]), sayIn('en'));
  assert.deepEqual(lines.map(({values}) => values[1]), [9, null, 3, -3, null, null]);
});

test('APointIsMarkedWhereItIsBeyondAndARejectedCheckAlwaysAtItsValue', () => {
  const chart = growth(0, [limited('4', 1), limited('5', 4, {beyond_shewhart: true}), limited('6', 2.5, {beyond_ewma: true}),
                           limited('7', 8, {weighted_mean: null, ewma_limit: null, beyond_shewhart: true}), limited('8', 9, {beyond_shewhart: true, beyond_ewma: true})]);
  assert.deepEqual(chartMarks(chart, new Set(['7'])), [
    {index: 1, value: 4, kind: 'beyond'}, {index: 2, value: 1.25, kind: 'beyond'}, {index: 3, value: 8, kind: 'rejected'},
    {index: 4, value: 9, kind: 'beyond'}, {index: 4, value: 4.5, kind: 'beyond'},
  ]);
});

test('MarkedChecksAreToldOfAllChartsTheNewestFirstWithTheLimitOnTheirSide', () => {
  const checks = checksWith({
    checks: [row('9', {accepted: false, cause: 'block'}), row('10'), row('11', {reference: true, accepted: null})],
    charts: [growth(1, [point('9', 2), limited('10', -4, {beyond_shewhart: true})]),
             {quantity: 'joint_3', unit: 'mrad', centre: 0, points: [point('9', 2), limited('10', 2.5, {beyond_ewma: true})]}],
  });
  assert.deepEqual([...rejectedRuns(checks)], ['9']);
  assert.deepEqual(markedChecks(checks).map(({run, isRejected, beyond}) => [run, isRejected, beyond.map(({chart, of, value, limit}) => [chart.quantity, of, value, limit])]),
                   [['10', false, [['growth', 'value', -4, -2], ['joint_3', 'mean', 1.25, 1]]], ['9', true, []]]);
});

test('AMarkOfACheckWhoseRowIsNotToldIsKept', () => {
  const [marked] = markedChecks(checksWith({charts: [growth(0, [limited('5', 4, {beyond_shewhart: true})])]}));
  assert.deepEqual([marked?.run, marked?.row, marked?.isRejected], ['5', null, false]);
});

test('AMarkSaysWhichFigureIsBeyondWhichLimit', () => {
  const chart = growth(1, []);
  assert.equal(beyondWords({chart, of: 'value', value: -4, limit: -2}, sayIn('en'), 'en'), 'Growth of the arm: -4.0 ppm is beyond the limit -2.0 ppm');
  assert.equal(beyondWords({chart: {...chart, quantity: 'joint_3', unit: 'mrad'}, of: 'mean', value: 0.0214, limit: 0.02}, sayIn('de'), 'de'),
               'Achse 3, wenn nur sie sich geändert hätte: Der gewichtete Mittelwert 0,021 mrad liegt jenseits seiner Grenze 0,020 mrad, eine langsame Änderung');
  assert.equal(changedWords(row('9', {accepted: false, cause: 'joint', joint: 3}), sayIn('en')), 'Changed: joint 3');
  assert.equal(changedWords(row('9', {accepted: false, cause: 'stylus'}), sayIn('fr')), 'Changé : le stylet');
  assert.equal(changedWords(row('9', {accepted: false}), sayIn('en')), 'Changed: cause not known');
  assert.equal(changedWords(row('9', {accepted: false, cause: 'cable'}), sayIn('en')), 'Changed: cable');
});

test('WhatTheArmsGrowthDoesNotExplainIsNoDistanceFromTheBlock', () => {
  for (const language of kLanguages) assert.notEqual(quantityWords('residual', sayIn(language)), sayIn(language)('verifiedRms'));
  assert.equal(quantityWords('joint_3', sayIn('en')), 'Joint 3, if it alone had changed');
  assert.equal(quantityWords('wear', sayIn('en')), 'wear', 'a newer daemon charts more');
});

test('TheNextCheckIsDueOverdueOrNotKnownAndNothingWithoutARule', () => {
  const say = sayIn('en');
  const due = {every_days: 7, due_at: '2026-11-20T00:00:00.000Z', overdue: false};
  assert.equal(nextCheckWords(checksWith({}), say), null);
  assert.equal(nextCheckWords(checksWith(due), say), 'The next check is due on 2026-11-20 00:00:00 (UTC).');
  assert.equal(nextCheckWords(checksWith({...due, overdue: true}), say), 'A check was due on 2026-11-20 00:00:00 (UTC). Check the cell now.');
  assert.match(nextCheckWords(checksWith({every_days: 7}), say)!, /not known: the clock/);
});

test('NoLimitOfTheChecksIsSaidToBeThreeDeviations', () => {
  for (const language of kLanguages) {
    const {words} = packOf(language);
    for (const [key, text] of Object.entries(words)) {
      if (key.startsWith('check')) assert.doesNotMatch(text, /sigma|σ|deviation|Standardabweichung|écart/i, key);
    }
    assert.match(words.checksHint, /30/, language);
  }
});
