import assert from 'node:assert/strict';
import {test} from 'node:test';
import type {CheckPoint} from 'page/api/documents.ts';
import {chartLines} from 'page/model/check_lines.ts';
import {sayIn} from 'page/words/words.ts';

const point = (run: string, value: number, shewhart_limit: number | null): CheckPoint =>
    ({run, value, weighted_mean: shewhart_limit === null ? null : value / 2, shewhart_limit, beyond_shewhart: false, beyond_ewma: false});

test('LimitsOfChecksAreOnBothSidesOfTheCentreAndBeginBehindTheBase', () => {
  const lines = chartLines({quantity: 'growth', unit: 'ppm', centre: 1, points: [point('4', 2, null), point('5', 4, 3)]}, sayIn('en'));
  assert.deepEqual(lines.map(({name, values}) => [name, values]),
                   [['Value', [2, 4]], ['Weighted mean', [null, 2]], ['Upper limit', [null, 4]], ['Lower limit', [null, -2]]]);
});

test('BeforeThereAreLimitsTheFigureStandsAlone', () => {
  const lines = chartLines({quantity: 'growth', unit: 'ppm', centre: null, points: [point('4', 2, null)]}, sayIn('en'));
  assert.deepEqual(lines, [{name: 'Value', values: [2]}]);
});
