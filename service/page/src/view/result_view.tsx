import {useState} from 'preact/hooks';
import type {Parameter, PlaneDistances, Result, VerdictName} from '../api/documents.ts';
import type {Desk} from '../model/desk.ts';
import {number, type Language} from '../model/format.ts';
import type {PageState} from '../model/page_state.ts';
import {isActive} from '../model/states.ts';
import {sayName, type Say, type WordKey} from '../words/words.ts';
import {Symbol, type Shape} from './symbol.tsx';
import {OuterText, useLanguage, useSay} from './texts.tsx';
import {UncertaintyMapView} from './uncertainty_map.tsx';

/** What a run found, in plain words first. */
export function ResultView({state}: {state: PageState; desk: Desk}) {
  const say = useSay();
  const run_id = state.shownRun ?? state.status?.run_id ?? state.runs[0]?.id ?? null;
  const result = run_id ? state.results[run_id] : undefined;
  const why = run_id ? state.missing[run_id] : undefined;
  if (run_id && !result && why) return <p class="empty"><OuterText text={say('noResult', {why})} /></p>;
  if (!run_id || !result) return <p class="empty">{say('noResultYet')}</p>;
  const isLive = run_id === state.status?.run_id && isActive(state.status.state);
  return (
    <div class="result-view">
      <h2>{say('runOf', {run: run_id, recipe: result.recipe})}</h2>
      <Verdict result={result} verdict={verdictOf(result, isLive)} isLive={isLive} />
      <Downloads run_id={run_id} />
      <TipErrors result={result} />
      <Distances result={result} />
      <Errors result={result} />
      {result.tip_uncertainty.map && <UncertaintyMapView map={result.tip_uncertainty.map} />}
      <Remarks result={result} />
    </div>
  );
}

/** An incomplete set is neither good nor bad. */
function verdictOf(result: Result, isLive: boolean): VerdictName {
  if (isLive) return 'none';
  if (!result.complete) return 'incomplete';
  return result.verdict.accepted ? 'accepted' : 'rejected';
}

const kVerdictWords: Record<VerdictName, WordKey> =
    {accepted: 'acceptedWords', rejected: 'rejectedWords', incomplete: 'incompleteWords', none: 'liveWords'};
const kVerdictShapes: Record<VerdictName, Shape> = {accepted: 'ok', rejected: 'fault', incomplete: 'warning', none: 'work'};

function Verdict({result, verdict, isLive}: {result: Result; verdict: VerdictName; isLive: boolean}) {
  const say = useSay();
  return (
    <section class={`verdict ${verdict}`} aria-label={say(`verdict_${verdict}`)}>
      <p class="big"><Symbol shape={kVerdictShapes[verdict]} />{isLive ? say('EXECUTE') : say(`verdict_${verdict}`)}</p>
      <p>{say(kVerdictWords[verdict])}</p>
      {!isLive && result.verdict.reasons.length > 0
        ? <ul>{result.verdict.reasons.map((reason) => <li key={reason}><OuterText text={reason} isEnglish /></li>)}</ul>
        : null}
    </section>
  );
}

function Downloads({run_id}: {run_id: string}) {
  const say = useSay();
  const base = `/api/v1/runs/${run_id}`;
  return (
    <p class="downloads">
      <a href={`${base}/report?format=html`} target="_blank" rel="noopener">{say('report')} (HTML)</a>
      <a href={`${base}/report?format=pdf`} download={`run-${run_id}.pdf`}>PDF</a>
      <a href={`${base}/report?format=csv`} download={`run-${run_id}.csv`}>CSV</a>
      <a href={`${base}/result`} download={`run-${run_id}-result.json`}>{say('resultFile')}</a>
      <a href={`${base}/touches`} download={`run-${run_id}-touches.json`}>{say('rawTouches')}</a>
      <a href={`${base}/arm`} download={`run-${run_id}-arm.json`}>{say('calibratedArm')}</a>
    </p>
  );
}

function TipErrors({result}: {result: Result}) {
  const say = useSay();
  const language = useLanguage();
  const tip = result.tip_uncertainty;
  const {scale} = result;
  return (
    <section>
      <h3>{say('tipError')}</h3>
      <dl class="figures">
        <div><dt>{say('atBlock')}</dt><dd>{number(tip.at_block_rms_mm, 3, language)} mm</dd></div>
        <div><dt>{say('inBox')}</dt><dd>{number(tip.workspace_box_rms_mm, 3, language)} mm</dd></div>
        <div><dt>{say('inRanges')}</dt><dd>{number(tip.joint_ranges_rms_mm, 3, language)} mm</dd></div>
        <div><dt>{say('rank')}</dt><dd>{result.identifiable_count}</dd></div>
        <div><dt>{say('conditionNumber')}</dt><dd>{number(result.condition_number, 1, language)}</dd></div>
        <div class={scale.warning ? 'wide abnormal' : 'wide'}>
          <dt>{say('scale')}</dt>
          <dd>
            {scale.source ? sayName(language, 'scale_', scale.source) : say('unknown')};{' '}
            {say('scaleUncertainty', {ppm: number(scale.std_uncertainty_ppm, 0, language)})};{' '}
            {say('scaleStretch', {ppm: number(scale.stretch_ppm, 0, language)})}
            {scale.warning ? <p><Symbol shape="warning" /><OuterText text={scale.warning} isEnglish /></p> : null}
          </dd>
        </div>
      </dl>
    </section>
  );
}

function Distances({result}: {result: Result}) {
  const say = useSay();
  const language = useLanguage();
  const row = (kind: WordKey) => (distances: PlaneDistances) => (
    <tr key={`${kind}${distances.plane}`}>
      <th scope="row">{say('plane', {plane: distances.plane})}</th>
      <td>{say(kind)} ({distances.touch_count})</td>
      <td class="figure">{number(distances.reference_mm, 3, language)}</td>
      <td class="figure">{number(distances.nominal_mean_mm, 3, language)}</td>
      <td class="figure">{number(distances.calibrated_mean_mm, 3, language)}</td>
      <td class="figure">{number(distances.nominal_rms_mm, 3, language)}</td>
      <td class="figure">{number(distances.calibrated_rms_mm, 3, language)}</td>
      <td class="figure">{number(distances.error_removed_percent, 2, language)}</td>
    </tr>
  );
  return (
    <Scroll label={say('distances')}>
      <table>
        <caption>{say('distances')}</caption>
        <thead>
          <tr>
            {(['plane', 'role', 'reference', 'before', 'after', 'rmsBefore', 'rmsAfter', 'removed'] as const).map((key) => (
              <th key={key} scope="col">{say(key, {plane: ''})}</th>
            ))}
          </tr>
        </thead>
        <tbody>{result.planes.map(row('residualsFit'))}{result.planes_held_out.map(row('residualsHeld'))}</tbody>
      </table>
    </Scroll>
  );
}

/** A wide table scrolls by itself, by keyboard too. */
export function Scroll({label, children}: {label: string; children: preact.ComponentChildren}) {
  return <div class="scroll" role="region" aria-label={label} tabIndex={0}>{children}</div>;
}

function Errors({result}: {result: Result}) {
  const say = useSay();
  const language = useLanguage();
  return (
    <Scroll label={say('errorsFound')}>
      <table class="errors">
        <caption>{say('errorsFound')}</caption>
        <thead>
          <tr>
            {(['parameter', 'nominal', 'error', 'interval', 'unit', 'statusColumn'] as const).map((key) => (
              <th key={key} scope="col">{say(key)}</th>
            ))}
          </tr>
        </thead>
        <tbody>
          {result.parameters.map((parameter) => (
            <tr key={parameter.name}>
              <th scope="row">{parameter.name}</th>
              <td class="figure">{inUnit(parameter, parameter.nominal, language)}</td>
              <td class="figure">{inUnit(parameter, parameter.error, language)}</td>
              <td class="figure">{intervalText(parameter, language)}</td>
              <td>{shownUnit(parameter)}</td>
              <td>{statusText(parameter, say, language)}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </Scroll>
  );
}

export const shownUnit = ({unit}: Parameter): string => unit;

export function inUnit(parameter: Parameter, value: number | null, language: Language): string {
  return number(value, parameter.unit === 'rad' ? 5 : 3, language);
}

function intervalText(parameter: Parameter, language: Language): string {
  const {interval95} = parameter;
  return interval95 ? `${inUnit(parameter, interval95[0], language)} … ${inUnit(parameter, interval95[1], language)}` : '';
}

function statusText(parameter: Parameter, say: Say, language: Language): string {
  if (parameter.status !== 'grouped') return sayName(language, 'status_', parameter.status);
  return say('status_grouped', {others: parameter.grouped_with.map(({name}) => name).join(', ')});
}

function Remarks({result}: {result: Result}) {
  const say = useSay();
  const language = useLanguage();
  const [whole, setWhole] = useState(false);
  const rejected = whole ? result.rejected_touches : result.rejected_touches.slice(0, 10);
  return (
    <section>
      {result.warnings.length > 0 && (
        <>
          <h3>{say('warnings')}</h3>
          <ul>{result.warnings.map((warning) => <li key={warning}><OuterText text={warning} isEnglish /></li>)}</ul>
        </>
      )}
      {rejected.length > 0 && (
        <>
          <h3>{say('rejectedTouches')}</h3>
          <ul>
            {rejected.map(({touch, residual_mm}) => (
              <li key={touch}>{say('touchNumber', {touch, residual: number(residual_mm, 3, language)})}</li>
            ))}
          </ul>
          {result.rejected_touches.length > 10 && !whole
            ? <button type="button" onClick={() => setWhole(true)}>{say('showAll', {count: result.rejected_touches.length})}</button>
            : null}
        </>
      )}
    </section>
  );
}
