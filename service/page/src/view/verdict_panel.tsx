import type {Cell, Result, VerdictName} from '../api/documents.ts';
import {roundedUp} from '../model/format.ts';
import {limitRows, nextSteps, type LimitRow} from '../model/limit_rows.ts';
import {whereByResult} from '../model/places.ts';
import {tipWithin_mm} from '../model/tip_rows.ts';
import {reasonsOf} from '../words/criterion_words.ts';
import type {WordKey} from '../words/words.ts';
import {Symbol} from './symbol.tsx';
import {OuterText, useLanguage, useSay} from './texts.tsx';
import {kVerdictShapes} from './verdict_shapes.ts';

const kVerdictWords: Record<VerdictName, WordKey> =
    {accepted: 'acceptedWords', rejected: 'rejectedWords', incomplete: 'incompleteWords', none: 'liveWords'};

/** The result in one look: the verdict, how good the tip is, why not, what to do next. */
export function Verdict({result, verdict, run_id, cell}: {result: Result; verdict: VerdictName; run_id: string; cell: Cell | null}) {
  const say = useSay();
  const language = useLanguage();
  const isLive = verdict === 'none';
  const rule = result.verdict.decision_rule;
  const rows = rule ? limitRows(rule) : [];
  // Of a result that is one touch behind its run, the reasons are not the run's.
  const tellsReasons = !isLive && verdict !== 'accepted' && (result.complete || verdict === 'incomplete');
  const translated = reasonsOf(rows, cell, whereByResult(result), say, language);
  const isOwn = language === 'en' || translated.length === 0;  // the daemon's sentences say more than the figures
  const within_mm = tipWithin_mm(result);
  return (
    <section class={`verdict ${verdict}`} aria-label={say(`verdict_${verdict}`)}>
      <p class="word"><Symbol shape={kVerdictShapes[verdict]} />{isLive ? say('EXECUTE') : say(`verdict_${verdict}`)}</p>
      {verdict === 'accepted'
        ? <p class="tip-within">{within_mm === null ? say('tipUnknown') : say('tipWithin', {mm: roundedUp(within_mm, language)})}</p>
        : null}
      <p>{say(kVerdictWords[verdict])}</p>
      {tellsReasons && isOwn ? <ul>{result.verdict.reasons.map((reason) => <li key={reason}><OuterText text={reason} isEnglish /></li>)}</ul> : null}
      {tellsReasons && !isOwn ? <ul>{translated.map((reason) => <li key={reason}><OuterText text={reason} /></li>)}</ul> : null}
      {isLive ? null : <NextSteps verdict={verdict} rows={rows} run_id={run_id} />}
    </section>
  );
}

function NextSteps({verdict, rows, run_id}: {verdict: VerdictName; rows: LimitRow[]; run_id: string}) {
  const say = useSay();
  const keys: WordKey[] = verdict === 'accepted' ? ['nextAccepted'] : verdict === 'incomplete' ? ['nextIncomplete'] : nextSteps(rows);
  if (keys.length === 0) return null;
  return (
    <div class="next">
      <h3>{say('nextTitle')}</h3>
      <ul>{keys.map((key) => <li key={key}>{say(key, {run: run_id})}</li>)}</ul>
    </div>
  );
}
