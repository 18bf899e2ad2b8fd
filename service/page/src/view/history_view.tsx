import {useMemo, useState} from 'preact/hooks';
import type {Run} from '../api/documents.ts';
import type {Desk} from '../model/desk.ts';
import {planeNumber} from '../model/faces.ts';
import {kUnknown, number, time} from '../model/format.ts';
import {trend, trendChoices, type TrendOf} from '../model/history.ts';
import type {PageState} from '../model/page_state.ts';
import {faultTitle, hasTitle} from '../words/fault_words.ts';
import {sayName} from '../words/words.ts';
import {Curve} from './curve.tsx';
import {FleetFrame} from './fleet_frame.tsx';
import {Later, Part} from './later.tsx';
import {Scroll} from './scroll.tsx';
import {Symbol} from './symbol.tsx';
import {OuterText, useLanguage, useSay} from './texts.tsx';

const comparison = new Part(() => import('./comparison_view.tsx').then((file) => file.Comparison));

/** All runs, how their figures went, and two of them side by side. */
export function HistoryView({state, desk}: {state: PageState; desk: Desk}) {
  const say = useSay();
  const fleet = typeof state.status?.archive_behind === 'number' ? <FleetFrame desk={desk} /> : null;
  if (state.runs.length === 0 && state.damagedRuns.length === 0) return <><p class="empty">{say('noRuns')}</p>{fleet}</>;
  return (
    <div class="history-view">
      <RunsTable state={state} desk={desk} />
      <Later part={comparison} props={{state}} />
      <Trends state={state} />
      {fleet}
    </div>
  );
}

function RunsTable({state, desk}: {state: PageState; desk: Desk}) {
  const say = useSay();
  return (
    <section>
      <h2>{say('history')}</h2>
      <Scroll label={say('history')}>
        <table>
          <thead>
            <tr>
              <th scope="col">№</th>
              <th scope="col">{say('started')}</th>
              <th scope="col">{say('recipe')}</th>
              <th scope="col">{say('touches')}</th>
              <th scope="col">{say('outcome')}</th>
              <th scope="col">{say('show')}</th>
              <th scope="col">{say('compare')}</th>
            </tr>
          </thead>
          <tbody>{state.runs.map((run) => <RunRow key={run.id} run={run} state={state} desk={desk} />)}</tbody>
        </table>
      </Scroll>
      {state.damagedRuns.map(({id, detail}) => (
        <p class="note" key={id}>{say('damagedRun', {run: id})} <OuterText text={detail} isEnglish /></p>
      ))}
      {state.nextBefore && <button type="button" onClick={() => void desk.loadRuns(state.nextBefore)}>{say('more')}</button>}
    </section>
  );
}

function RunRow({run, state, desk}: {run: Run; state: PageState; desk: Desk}) {
  const say = useSay();
  const language = useLanguage();
  const isBad = run.verdict === 'rejected' || run.outcome === 'aborted';
  return (
    <tr>
      <th scope="row">{run.id}</th>
      <td>{time(run.started_at)}</td>
      <td>
        <OuterText text={run.recipe} />
        {run.kind === 'calibration' ? null : <>, {say(`kind_${run.kind}`, {run: run.of_run ?? kUnknown})}</>}
      </td>
      <td class="figure">{run.touches_done}{run.touches_total ? ` / ${run.touches_total}` : ''}</td>
      <td class={isBad ? 'abnormal' : ''}>
        {isBad ? <Symbol shape="warning" /> : null}
        {sayName(language, 'outcome_', run.outcome)}{run.verdict === 'none' ? '' : `, ${say(`verdict_${run.verdict}`)}`}
        {run.fault_code ? <> · <RunFault run={run} /></> : null}
      </td>
      <td><button type="button" disabled={run.touches_done < 1} onClick={() => desk.showRun(run.id)}>{say('show')} {run.id}</button></td>
      <td>
        <label class="check">
          <input type="checkbox" checked={state.compared.includes(run.id)}
                 disabled={run.touches_done < 1 || run.kind !== 'calibration'}
                 onChange={() => desk.compare(run.id)} />
          <span>{say('compare')} {run.id}</span>
        </label>
      </td>
    </tr>
  );
}

/** Why a run ended: by its title where the page's language has one, else in the daemon's words. */
function RunFault({run: {fault_code, fault_message}}: {run: Run}) {
  const language = useLanguage();
  if (fault_code && hasTitle(language, fault_code)) return <>{faultTitle(language, fault_code)}</>;
  return <OuterText text={fault_message ?? fault_code ?? ''} isEnglish />;
}

const keyOf = (of: TrendOf): string => (of.kind === 'plane' ? ['plane', of.plane, of.place, of.tip].filter((part) => part !== null).join(' ') : of.name);

function Trends({state}: {state: PageState}) {
  const say = useSay();
  const language = useLanguage();
  const choices = useMemo(() => trendChoices(state.results, state.cell), [state.results, state.cell]);
  const [chosen, setChosen] = useState<string | null>(null);
  const of = choices.find((choice) => keyOf(choice) === chosen) ?? choices[0];
  const points = useMemo(() => (of ? trend(state.runs, state.results, of, state.cell) : []), [state.runs, state.results, of, state.cell]);
  const x = useMemo(() => points.map(({run}) => run), [points]);
  const lines = useMemo(() => [{name: of ? keyOf(of) : '', values: points.map(({value}) => value)}], [points, of]);
  const nameOf = (choice: TrendOf): string => (choice.kind === 'plane' ? `${say('heldOutOf', {plane: planeNumber(state.cell, choice.plane, say, () => choice)})}, mm` : `${choice.name}, ${choice.unit}`);
  return (
    <section>
      <h2>{say('trends')}</h2>
      {of && points.length > 1 ? (
        <>
          <label class="choose">
            <span>{say('trendOf')}</span>
            <select value={keyOf(of)} onChange={(event) => setChosen(event.currentTarget.value)}>
              {choices.map((choice) => <option key={keyOf(choice)} value={keyOf(choice)}>{nameOf(choice)}</option>)}
            </select>
          </label>
          <Curve title={nameOf(of)} x={x} xName={say('runColumn')} lines={lines} height={180} isCounted write={(value) => number(value, of.kind === 'plane' ? 3 : 4, language)} />
        </>
      ) : <p class="hint">{say('trendNone')}</p>}
    </section>
  );
}
