import {useMemo, useState} from 'preact/hooks';
import type {CheckChart, Checks} from '../api/documents.ts';
import {chartLines, chartMarks, markedChecks, rejectedRuns, type ChartLine, type MarkedCheck} from '../model/check_lines.ts';
import {time} from '../model/format.ts';
import type {ChecksState} from '../model/page_state.ts';
import {beyondWords, changedWords, chartFigure, nextCheckWords, quantityWords} from '../words/check_words.ts';
import {Curve, type Mark, type Stroke} from './curve.tsx';
import {Scroll} from './scroll.tsx';
import {Symbol, type Shape} from './symbol.tsx';
import {OuterText, useLanguage, useSay} from './texts.tsx';
import {kVerdictShapes} from './verdict_shapes.ts';

/** When the next check is due, as a line of another view; nothing where no rule says so. */
export function NextCheck({found}: {found: ChecksState}) {
  return found.kind === 'refused' ? <ChecksRefused why={found.why} /> : <Due checks={found.checks} />;
}

function Due({checks}: {checks: Checks}) {
  const say = useSay();
  const words = nextCheckWords(checks, say);
  if (words === null) return null;
  const isWrong = checks.overdue !== false;
  return <p class={isWrong ? 'next-check abnormal' : 'next-check'}>{isWrong ? <Symbol shape="warning" /> : null}{words}</p>;
}

function ChecksRefused({why}: {why: string}) {
  const say = useSay();
  return <p class="next-check abnormal"><Symbol shape="warning" /><OuterText text={say('checksRefused', {why})} /></p>;
}

/** All checks of a calibration: when the next one is due, what the newest shows, a figure from check to check. */
export function ChecksView({found}: {found: ChecksState}) {
  return found.kind === 'refused' ? <ChecksRefused why={found.why} /> : <KnownChecks checks={found.checks} />;
}

function KnownChecks({checks}: {checks: Checks}) {
  const say = useSay();
  const {of_run, every_days, warnings} = checks;
  const marked = useMemo(() => markedChecks(checks), [checks]);
  return (
    <section aria-label={say('checksOf', {run: of_run})}>
      <h2>{say('checksOf', {run: of_run})}</h2>
      {every_days === null ? <p class="hint">{say('checksNotDue')}</p> : <Due checks={checks} />}
      {warnings.length > 0 ? <ul>{warnings.map((warning) => <li key={warning}><OuterText text={warning} isEnglish /></li>)}</ul> : null}
      <Chart checks={checks} marked={marked} />
      {marked.length > 0 ? <MarkedTable marked={marked} /> : null}
    </section>
  );
}

const kThick: Stroke = {dash: 0, width: 1.5, hasPoints: true, isJoined: false};
const kStrokes: Record<ChartLine['kind'], Stroke> = {
  'value': kThick,
  'mean': {...kThick, dash: 1, hasPoints: false, isJoined: true},
  'limit': {...kThick, dash: 2, hasPoints: false, isJoined: true},
  'mean limit': {dash: 4, width: 1, hasPoints: false, isJoined: true},
};
const kRejected: Shape = kVerdictShapes.rejected;

function Chart({checks, marked}: {checks: Checks; marked: MarkedCheck[]}) {
  const say = useSay();
  const language = useLanguage();
  const [chosen, setChosen] = useState<string | null>(null);
  const {charts} = checks;
  const chart = charts.find(({quantity}) => quantity === chosen) ?? charts[0];
  const x = useMemo(() => (chart ? chart.points.map(({run}) => Number(run)) : []), [chart]);
  const lines = useMemo(() => (chart ? chartLines(chart, say).map((line) => ({...line, stroke: kStrokes[line.kind]})) : []), [chart, language]);
  const marks = useMemo((): Mark[] => (chart ? chartMarks(chart, rejectedRuns(checks)) : [])
      .map(({index, value, kind}) => ({index, value, shape: kind === 'rejected' ? kRejected : 'warning'})), [chart, checks]);
  if (!chart) return null;
  const nameOf = ({quantity, unit}: CheckChart): string => `${quantityWords(quantity, say)}, ${unit}`;
  const offered = (one: CheckChart): string => {
    const count = marked.filter(({beyond}) => beyond.some((found) => found.chart === one)).length;
    return count > 0 ? say('checksWithMarks', {what: nameOf(one), count}) : nameOf(one);
  };
  return (
    <>
      <label class="choose">
        <span>{say('checksChart')}</span>
        <select value={chart.quantity} onChange={(event) => setChosen(event.currentTarget.value)}>
          {charts.map((one) => <option key={one.quantity} value={one.quantity}>{offered(one)}</option>)}
        </select>
      </label>
      {chart.points.length < 2 ? null : (
        <Curve title={nameOf(chart)} x={x} xName={say('runColumn')} lines={lines} marks={marks} height={220} isCounted
               write={(value) => chartFigure(value, chart.unit, language)} />
      )}
      <ChartHint chart={chart} checks={checks} />
    </>
  );
}

/** What the chart still waits for, else what its limits and marks say. */
function ChartHint({chart, checks: {reference, base, count, checks}}: {chart: CheckChart; checks: Checks}) {
  const say = useSay();
  const isReference = reference.count < reference.needed;
  const hint = isReference ? say('checksReference', {...reference})
      : chart.points.length < 2 ? say('checksNone')
      : base.count < base.needed ? say('checksFew', {...base})
      : say('checksHint', {needed: base.needed});
  return (
    <p class="hint">
      {hint}{checks.length < count ? ` ${say('checksNewest', {shown: checks.length, count})}` : ''}
    </p>
  );
}

const kMarkedRows = 10;

/** The marks of all charts in words. */
function MarkedTable({marked}: {marked: MarkedCheck[]}) {
  const say = useSay();
  const [whole, setWhole] = useState(false);
  return (
    <>
      <Scroll label={say('checksMarked')}>
        <table class="marked">
          <caption>{say('checksMarked')}</caption>
          <thead>
            <tr>{(['runColumn', 'checkEnded', 'operator', 'checkWhy'] as const).map((key) => <th key={key} scope="col">{say(key)}</th>)}</tr>
          </thead>
          <tbody>{marked.slice(0, whole ? undefined : kMarkedRows).map((check) => <MarkedRow key={check.run} check={check} />)}</tbody>
        </table>
      </Scroll>
      {marked.length > kMarkedRows && !whole
        ? <button type="button" onClick={() => setWhole(true)}>{say('showAll', {count: marked.length})}</button>
        : null}
    </>
  );
}

function MarkedRow({check: {run, row, isRejected, beyond}}: {check: MarkedCheck}) {
  const say = useSay();
  const language = useLanguage();
  return (
    <tr>
      <th scope="row">{run}</th>
      <td>{time(row?.ended_at ?? null)}</td>
      <td><OuterText text={row?.operator ?? ''} /></td>
      <td>
        {isRejected ? <div><Symbol shape={kRejected} /> {changedWords(row, say)}</div> : null}
        {beyond.map((one) => (
          <div key={`${one.chart.quantity}${one.of}`}><Symbol shape="warning" /> {beyondWords(one, say, language)}</div>
        ))}
      </td>
    </tr>
  );
}
