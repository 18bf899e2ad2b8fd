import {useState} from 'preact/hooks';
import type {Cell, Parameter, PlaneDistances, Result} from '../api/documents.ts';
import type {Desk} from '../model/desk.ts';
import {faceWords} from '../model/faces.ts';
import {number, type Language} from '../model/format.ts';
import {newestRun, type PageState} from '../model/page_state.ts';
import {whereByResult, whereOfPlane} from '../model/places.ts';
import {tipRows} from '../model/tip_rows.ts';
import {verdictOf} from '../model/verdict.ts';
import {sayName, type Say, type WordKey} from '../words/words.ts';
import {ChecksView} from './checks_view.tsx';
import {LimitsTable} from './limits_table.tsx';
import {Scroll} from './scroll.tsx';
import {Symbol} from './symbol.tsx';
import {OuterText, useLanguage, useSay} from './texts.tsx';
import {UncertaintyMapView} from './uncertainty_map.tsx';
import {Verdict} from './verdict_panel.tsx';
import {VerificationView} from './verification_view.tsx';

/** What a run found, in plain words first. */
export function ResultView({state, desk}: {state: PageState; desk: Desk}) {
  const say = useSay();
  const newest = newestRun(state);
  const run_id = state.shownRun ?? newest;
  const result = run_id ? state.results[run_id] : undefined;
  const why = run_id ? state.missing[run_id] : undefined;
  const recipe = result?.recipe ?? state.runs.find(({id}) => id === run_id)?.recipe ?? '';
  if (!run_id) return <p class="empty">{say('noResultYet')}</p>;
  const which = <Which run_id={run_id} recipe={recipe} isEarlier={run_id !== newest} desk={desk} />;
  const verification = state.verifications[run_id];
  if (verification) {
    const checks = verification.schema === 'touchcal/check/1' ? state.checks[verification.of_run] : undefined;
    return <div class="result-view">{which}<VerificationView verification={verification} /><Downloads run_id={run_id} desk={desk} offers={kOfferedOfVerification} />{checks ? <ChecksView found={checks} /> : null}</div>;
  }
  if (!result) return <>{which}<p class="empty"><OuterText text={why ? say('noResult', {why}) : say('noResultYet')} /></p></>;
  const verdict = verdictOf(run_id, result, state);
  return (
    <div class="result-view">
      {which}
      <Verdict result={result} verdict={verdict} run_id={run_id} cell={state.cell} />
      {result.verdict.decision_rule ? <LimitsTable rule={result.verdict.decision_rule} cell={state.cell} whereOf={whereByResult(result)} /> : null}
      <Downloads run_id={run_id} desk={desk} offers={kOffered} />
      <h2>{say('detail')}</h2>
      <TipExpanded result={result} />
      <TipErrors result={result} />
      <Distances result={result} cell={state.cell} />
      <Errors result={result} />
      {result.tip_uncertainty.map && <UncertaintyMapView map={result.tip_uncertainty.map} />}
      <Remarks result={result} />
    </div>
  );
}

/** Of which run all of this is; an earlier one is not taken for the one that was just made. */
function Which({run_id, recipe, isEarlier, desk}: {run_id: string; recipe: string; isEarlier: boolean; desk: Desk}) {
  const say = useSay();
  return (
    <div class={isEarlier ? 'which card warning' : 'which'}>
      <h2>
        {isEarlier ? <Symbol shape="warning" /> : null}
        <OuterText text={say(isEarlier ? 'runEarlier' : 'runOf', {run: run_id, recipe})} />
      </h2>
      {isEarlier ? <button type="button" onClick={() => desk.showRun(null)}>{say('showNewest')}</button> : null}
    </div>
  );
}

interface Offered { words: WordKey; form: string; path: string; ending: string }
const kOffered: Offered[] = [
  {words: 'report', form: 'HTML', path: 'report?format=html', ending: '.html'},
  {words: 'report', form: 'CSV', path: 'report?format=csv', ending: '.csv'},
  {words: 'report', form: 'JSON', path: 'report?format=json', ending: '.json'},
  {words: 'resultFile', form: 'JSON', path: 'result', ending: '-result.json'},
  {words: 'rawTouches', form: 'JSON', path: 'touches', ending: '-touches.json'},
  {words: 'calibratedArm', form: 'JSON', path: 'arm', ending: '-arm.json'},
];

/** A proof or a check makes no arm. */
const kOfferedOfVerification = kOffered.filter(({path}) => path !== 'arm');

function Downloads({run_id, desk, offers}: {run_id: string; desk: Desk; offers: Offered[]}) {
  const say = useSay();
  const [failed, setFailed] = useState<Offered | null>(null);
  const save = async (offered: Offered): Promise<void> => {
    const saved = await desk.save(`/api/v1/runs/${run_id}/${offered.path}`, `touchcal-run-${run_id}${offered.ending}`);
    setFailed(saved ? null : offered);
  };
  return (
    <section aria-labelledby="downloads">
      <h3 id="downloads">{say('download')}</h3>
      <p class="downloads">
        {offers.map((offered) => (
          <button key={offered.path} type="button" onClick={() => void save(offered)}>{say(offered.words)} ({offered.form})</button>
        ))}
      </p>
      {failed && <p class="abnormal" role="alert"><Symbol shape="warning" />{say('notSaved', {what: say(failed.words)})}</p>}
    </section>
  );
}

/** Where the result is good, first: the expanded uncertainty of the tip in the workspace box. */
function TipExpanded({result}: {result: Result}) {
  const say = useSay();
  const language = useLanguage();
  const rows = tipRows(result);
  if (rows.length === 0) return null;
  const caption = say('tipExpanded', {k: number(result.tip_uncertainty.expanded?.k ?? null, 0, language)});
  const simulated = result.monte_carlo;
  return (
    <section>
      <Scroll label={caption}>
        <table class="tip-expanded">
          <caption>{caption}</caption>
          <thead>
            <tr>{(['tipFrame', 'tipRms', 'tipP95', 'tipWorst'] as const).map((key) => <th key={key} scope="col">{say(key)}</th>)}</tr>
          </thead>
          <tbody>
            {rows.map(({name, rms_mm, p95_mm, worst_mm}) => (
              <tr key={name}>
                <th scope="row">{say(name)}</th>
                <td class="figure">{number(rms_mm, 3, language)}</td>
                <td class="figure">{number(p95_mm, 3, language)}</td>
                <td class="figure">{name === 'tipSimulated' ? '' : number(worst_mm, 3, language)}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </Scroll>
      {simulated
        ? <p class="hint">
            {say('tipSimulatedCount', {converged: simulated.converged, count: simulated.count,
                                       ratio: number(simulated.linear_over_monte_carlo, 2, language)})}
          </p>
        : null}
    </section>
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

function Distances({result, cell}: {result: Result; cell: Cell | null}) {
  const say = useSay();
  const language = useLanguage();
  const isAnyFound = [...result.planes, ...result.planes_held_out].some(({estimated_offset_mm}) => estimated_offset_mm != null);
  const columns: WordKey[] = ['plane', 'role', 'reference', ...(isAnyFound ? ['foundAt' as const] : []), 'before', 'after', 'rmsBefore',
                              'rmsAfter', 'removed'];
  const row = (kind: WordKey) => (distances: PlaneDistances) => (
    <tr key={`${kind}${distances.plane}`}>
      <th scope="row">{faceWords(cell, distances.plane, say, () => whereOfPlane(distances))}</th>
      <td>{say(kind)} ({distances.touch_count})</td>
      <td class="figure">{number(distances.reference_mm, 3, language)}</td>
      {isAnyFound
        ? <td class="figure">{distances.estimated_offset_mm == null ? '' : number(distances.estimated_offset_mm, 3, language)}</td>
        : null}
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
            {columns.map((key) => (
              <th key={key} scope="col">{say(key, {plane: ''})}</th>
            ))}
          </tr>
        </thead>
        <tbody>{result.planes.map(row('residualsFit'))}{result.planes_held_out.map(row('residualsHeld'))}</tbody>
      </table>
    </Scroll>
  );
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
      <p>{say('noZeroOffsets')}</p>
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
