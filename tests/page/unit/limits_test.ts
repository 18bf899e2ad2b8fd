import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import type {Criterion, DecisionRule} from 'page/api/documents.ts';
import {isFailed, limitRow, limitRows, nextSteps, shownFigure} from 'page/model/limit_rows.ts';
import {tipWithin_mm} from 'page/model/tip_rows.ts';
import {reasonsOf} from 'page/words/criterion_words.ts';
import {loadLanguage, sayIn} from 'page/words/words.ts';

before(() => loadLanguage('fr'));

const criterion = (changes: Partial<Criterion>): Criterion => ({
  name: 'held_out_mean', plane: 3, tool: null, unit: 'mm', value: 0.03, side: 'upper', limit: 0.05, expanded_uncertainty: 0.01, within_limit: true,
  proved: true, ...changes,
});
const ruleOf = (criteria: Criterion[], rule: DecisionRule['rule'] = 'simple'): DecisionRule =>
    ({standard: 'ISO 14253-1', rule, text: 't', coverage_factor: 2, criteria});

test('WhatRejectsIsARowThatFailsAndComesFirst', () => {
  const rows = limitRows(ruleOf([criterion({}), criterion({name: 'scale', plane: null, unit: '1', value: 4.2, limit: 3, within_limit: false, proved: null}),
                                 criterion({name: 'complete', plane: null, unit: '1', value: 0, limit: 1, side: 'lower', within_limit: false, proved: null})]));
  assert.deepEqual(rows.map((row) => [row.criterion.name, row.decision]), [['scale', 'missed'], ['complete', 'missed'], ['held_out_mean', 'proved']]);
  assert.deepEqual(nextSteps(rows), ['next_scale', 'nextIncomplete']);
});

test('AGuardedRuleFailsWhatIsWithinItsLimitAndNotProven', () => {
  const unsure = criterion({value: 0.045, proved: false});
  assert.equal(limitRow(unsure, 'simple').decision, 'held');
  assert.equal(limitRow(unsure, 'guarded').decision, 'not proved');
  assert.ok(isFailed(limitRow(unsure, 'guarded')));
  assert.deepEqual(reasonsOf(limitRows(ruleOf([unsure], 'guarded')), null, () => ({place: null, tip: null}), sayIn('en'), 'en'),
                   ['mean of the check touches, Plane 3: 0.045 mm ± 0.010 mm, which is not surely within 0.050 mm']);
});

test('ReasonsAreInThePagesLanguage', () => {
  const rows = limitRows(ruleOf([criterion({value: 0.0617, within_limit: false, proved: false}), criterion({name: 'converged', unit: '1', plane: null, value: 0, limit: 1, within_limit: false})]));
  assert.deepEqual(reasonsOf(rows, null, () => ({place: null, tip: null}), sayIn('fr'), 'fr'),
                   ['moyenne de vérification, Plan 3 : 0,062 mm, la limite est 0,050 mm', 'identification convergée : non']);
});

test('AFigureIsReadBesideItsLimit', () => {
  const fit = criterion({name: 'lack_of_fit', unit: '1', side: 'lower', limit: 0.03, value: 0.0007557, expanded_uncertainty: null});
  assert.equal(shownFigure(fit, fit.limit, 'en'), '0.03');
  assert.equal(shownFigure(fit, fit.value, 'en'), '0.001');
  assert.equal(shownFigure(fit, 1e-14, 'en'), '< 0.001');
  const ofPlane = {...fit, limit: 0.001 / 5, value: 0.73046};
  assert.deepEqual([ofPlane.limit, ofPlane.value, 0.00015].map((p) => shownFigure(ofPlane, p, 'en')), ['0.0002', '0.73', '0.00015']);
  const share = criterion({name: 'rejected_touches', unit: '1', limit: 0.1, value: 0.0222});
  assert.deepEqual([share.limit, share.value, 0].map((part) => shownFigure(share, part, 'en')), ['0.10', '0.02', '0.00']);
  const mean = criterion({});
  assert.equal(shownFigure(mean, mean.expanded_uncertainty, 'en'), '0.010 mm', 'an uncertainty has its unit');
  assert.equal(shownFigure(mean, -0, 'en'), '0.000 mm');
  assert.equal(shownFigure(criterion({name: 'held_out_touches', unit: '1', limit: 1, value: 40}), 40, 'en'), '40');
  assert.equal(shownFigure(mean, null, 'en'), '–');
});

test('ABarIsAShareOfTheLimitAndReachesAsFarAsTheUncertainty', () => {
  const row = limitRow(criterion({}), 'simple');
  assert.ok(Math.abs(row.share! - 0.6) < 1e-12 && Math.abs(row.shareExpanded! - 0.8) < 1e-12);
  const lower = limitRow(criterion({side: 'lower', value: 0.1, expanded_uncertainty: 0.05}), 'simple');
  assert.ok(Math.abs(lower.shareExpanded! - 1) < 1e-12);
  assert.equal(limitRow(criterion({name: 'complete'}), 'simple').share, null);
  assert.equal(limitRow(criterion({limit: 0}), 'simple').share, null);
  assert.equal(limitRow(criterion({value: null}), 'simple').share, null);
});

test('HowFarTheTipMayBeOffIsBySimulationsWhereThereAreAny', () => {
  const tip_uncertainty = {expanded: {k: 2, box_rms_mm: 0.1, box_p95_mm: 0.2, box_max_mm: 0.3}, at_block_rms_mm: null, workspace_box_rms_mm: null,
                           joint_ranges_rms_mm: null, map: null};
  const monte_carlo = {count: 100, converged: 99, box_rms_mm: 0.05, box_p95_mm: 0.15, joint_ranges_rms_mm: null, linear_over_monte_carlo: null};
  assert.equal(tipWithin_mm({tip_uncertainty, monte_carlo: null}), 0.2);
  assert.equal(tipWithin_mm({tip_uncertainty, monte_carlo}), 0.15);
  assert.equal(tipWithin_mm({tip_uncertainty: {...tip_uncertainty, expanded: undefined}}), null);
});
