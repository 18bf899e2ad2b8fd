import type {CheckChart} from '../api/documents.ts';
import type {Say} from '../words/words.ts';

/** A figure of the checks with its weighted mean and the limits of one check; none of these before there are limits. */
export function chartLines({centre, points}: CheckChart, say: Say): {name: string; values: (number | null)[]}[] {
  const value = {name: say('verifiedFigure'), values: points.map((point) => point.value)};
  if (centre === null) return [value];
  const limit = (side: 1 | -1): (number | null)[] =>
    points.map(({shewhart_limit}) => (shewhart_limit === null ? null : centre + side * shewhart_limit));
  return [
    value,
    {name: say('checksMean'), values: points.map((point) => point.weighted_mean)},
    {name: say('checksUpper'), values: limit(1)},
    {name: say('checksLower'), values: limit(-1)},
  ];
}
