import {useMemo, useState} from 'preact/hooks';
import type {CheckChart, Checks} from '../api/documents.ts';
import {chartLines} from '../model/check_lines.ts';
import {number, time} from '../model/format.ts';
import type {Say} from '../words/words.ts';
import {Curve} from './curve.tsx';
import {Symbol} from './symbol.tsx';
import {OuterText, useLanguage, useSay} from './texts.tsx';

/** All checks of a calibration: when the next one is due, what the newest shows, a figure from check to check. */
export function ChecksView({checks}: {checks: Checks}) {
  const say = useSay();
  const {due_at, overdue, warnings, base} = checks;
  return (
    <section aria-label={say('checksOf', {run: checks.of_run})}>
      <h2>{say('checksOf', {run: checks.of_run})}</h2>
      <p>
        {overdue ? <Symbol shape="warning" /> : null}
        {due_at === null ? say('checksNotDue') : say(overdue ? 'checksOverdue' : 'checksDue', {date: time(due_at)})}
      </p>
      {warnings.length > 0 ? <ul>{warnings.map((warning) => <li key={warning}><OuterText text={warning} isEnglish /></li>)}</ul> : null}
      {base.count < base.needed ? <p class="hint">{say('checksFew', {count: base.count, needed: base.needed})}</p> : null}
      <Chart charts={checks.charts} />
    </section>
  );
}

function nameOf({quantity, unit}: CheckChart, say: Say): string {
  const joint = quantity.match(/^joint_(\d)$/)?.[1];
  const what = joint ? say('verifiedJoint', {joint}) : say(quantity === 'growth' ? 'verifiedGrowth' : 'verifiedRms');
  return `${what}, ${unit}`;
}

function Chart({charts}: {charts: CheckChart[]}) {
  const say = useSay();
  const language = useLanguage();
  const [chosen, setChosen] = useState<string | null>(null);
  const chart = charts.find(({quantity}) => quantity === chosen) ?? charts[0];
  const x = useMemo(() => (chart ? chart.points.map(({run}) => Number(run)) : []), [chart]);
  const lines = useMemo(() => (chart ? chartLines(chart, say) : []), [chart, language]);
  if (!chart) return null;
  return (
    <>
      <label class="choose">
        <span>{say('checksChart')}</span>
        <select value={chart.quantity} onChange={(event) => setChosen(event.currentTarget.value)}>
          {charts.map((one) => <option key={one.quantity} value={one.quantity}>{nameOf(one, say)}</option>)}
        </select>
      </label>
      {chart.points.length < 2 ? <p class="hint">{say('checksNone')}</p> : (
        <Curve title={nameOf(chart, say)} x={x} lines={lines} height={180} isCounted
               write={(value) => number(value, chart.unit === 'ppm' ? 1 : 3, language)} />
      )}
    </>
  );
}
