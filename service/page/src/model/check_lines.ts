import type {CheckChart, CheckRow, Checks} from '../api/documents.ts';
import type {Say} from '../words/words.ts';

/** A line of a chart; the view knows how each kind is drawn. */
export interface ChartLine { kind: 'value' | 'mean' | 'limit' | 'mean limit'; name: string; values: (number | null)[] }

/** A figure of the checks with its weighted mean, and the limits of both; none of these before there are limits. */
export function chartLines({centre, points}: CheckChart, say: Say): ChartLine[] {
  const value: ChartLine = {kind: 'value', name: say('verifiedFigure'), values: points.map((point) => point.value)};
  if (centre === null) return [value];
  const limit = (side: 1 | -1, of: 'shewhart_limit' | 'ewma_limit'): (number | null)[] =>
    points.map((point) => (point[of] === null ? null : centre + side * point[of]));
  return [
    value,
    {kind: 'mean', name: say('checksMean'), values: points.map((point) => point.weighted_mean)},
    {kind: 'limit', name: say('checksUpper'), values: limit(1, 'shewhart_limit')},
    {kind: 'limit', name: say('checksLower'), values: limit(-1, 'shewhart_limit')},
    {kind: 'mean limit', name: say('checksMeanUpper'), values: limit(1, 'ewma_limit')},
    {kind: 'mean limit', name: say('checksMeanLower'), values: limit(-1, 'ewma_limit')},
  ];
}

/** A point of a chart that is looked at: where it is drawn, and whether its check was not accepted or a limit was passed. */
export interface ChartMark { index: number; value: number; kind: 'rejected' | 'beyond' }

export function chartMarks({points}: CheckChart, rejected: ReadonlySet<string>): ChartMark[] {
  return points.flatMap((point, index) => {
    const marks: ChartMark[] = [];
    const isRejected = rejected.has(point.run);
    if (point.value !== null && (isRejected || point.beyond_shewhart)) marks.push({index, value: point.value, kind: isRejected ? 'rejected' : 'beyond'});
    if (point.weighted_mean !== null && point.beyond_ewma) marks.push({index, value: point.weighted_mean, kind: 'beyond'});
    return marks;
  });
}

export const rejectedRuns = ({checks}: Checks): ReadonlySet<string> =>
    new Set(checks.filter(({accepted}) => accepted === false).map(({run}) => run));

/** A figure that is beyond its limit: of the check itself, or the weighted mean. `limit` is the one on its side. */
export interface Beyond { chart: CheckChart; of: 'value' | 'mean'; value: number; limit: number }
/** A check that is marked in a chart, and why; its row where it is told. */
export interface MarkedCheck { run: string; row: CheckRow | null; isRejected: boolean; beyond: Beyond[] }

/** The newest first. */
export function markedChecks({checks, charts}: Checks): MarkedCheck[] {
  const beyond = new Map<string, Beyond[]>();
  for (const chart of charts) {
    for (const point of chart.points) {
      const found = beyondOf(chart, point);
      if (found.length > 0) beyond.set(point.run, [...(beyond.get(point.run) ?? []), ...found]);
    }
  }
  const rows = new Map(checks.map((row) => [row.run, row]));
  const runs = new Set([...beyond.keys(), ...checks.filter(({accepted}) => accepted === false).map(({run}) => run)]);
  return [...runs].sort((a, b) => Number(b) - Number(a)).map((run) => {
    const row = rows.get(run) ?? null;
    return {run, row, isRejected: row?.accepted === false, beyond: beyond.get(run) ?? []};
  });
}

function beyondOf(chart: CheckChart, point: CheckChart['points'][number]): Beyond[] {
  const found: Beyond[] = [];
  const add = (of: Beyond['of'], value: number | null, width: number | null): void => {
    if (chart.centre === null || value === null || width === null) return;
    found.push({chart, of, value, limit: chart.centre + (value < chart.centre ? -width : width)});
  };
  if (point.beyond_shewhart) add('value', point.value, point.shewhart_limit);
  if (point.beyond_ewma) add('mean', point.weighted_mean, point.ewma_limit);
  return found;
}
