import type {Cell, DecisionRule} from '../api/documents.ts';
import {limitRows, isFailed, shownFigure, type Decision, type LimitRow} from '../model/limit_rows.ts';
import type {WhereOf} from '../model/places.ts';
import {criterionWords} from '../words/criterion_words.ts';
import type {WordKey} from '../words/words.ts';
import {Scroll} from './scroll.tsx';
import {Symbol} from './symbol.tsx';
import {useLanguage, useSay} from './texts.tsx';

/** Each figure against the cell's limit with a bar of it, what rejects first, and by which rule it was decided. */
export function LimitsTable({rule, cell, whereOf}: {rule: DecisionRule; cell: Cell | null; whereOf: WhereOf}) {
  const say = useSay();
  if (rule.criteria.length === 0) return null;
  return (
    <section>
      <Scroll label={say('limits')}>
        <table class="limits">
          <caption>{say('limits')}</caption>
          <thead>
            <tr>
              {(['criterion', 'decision', 'bar', 'value', 'limit', 'expanded'] as const).map((key) => <th key={key} scope="col">{say(key)}</th>)}
            </tr>
          </thead>
          <tbody>
            {limitRows(rule).map((row) => (
              <Row key={`${row.criterion.name}${row.criterion.plane}${row.criterion.tool}`} row={row} cell={cell} whereOf={whereOf} />
            ))}
          </tbody>
        </table>
      </Scroll>
      <p class="hint">{rule.standard}: {say(rule.rule === 'guarded' ? 'ruleGuarded' : 'ruleSimple')}</p>
    </section>
  );
}

const kDecisionWords: Record<Decision, WordKey> =
    {proved: 'limitProved', held: 'limitHeld', 'not proved': 'limitNotProved', missed: 'limitMissed'};

function Row({row, cell, whereOf}: {row: LimitRow; cell: Cell | null; whereOf: WhereOf}) {
  const say = useSay();
  const language = useLanguage();
  const {criterion, decision, isYesOrNo} = row;
  const {value, side, limit, expanded_uncertainty: expanded} = criterion;
  const limitText = shownFigure(criterion, limit, language);
  return (
    <tr class={isFailed(row) ? 'failed' : ''}>
      <th scope="row">{criterionWords(criterion, cell, whereOf, say, language)}</th>
      <td class={isFailed(row) ? 'abnormal' : ''}>
        <Symbol shape={isFailed(row) ? 'fault' : 'ok'} />
        {say(kDecisionWords[decision])}
      </td>
      <td>{row.share === null ? null : <Bar row={row} />}</td>
      <td class="figure">{isYesOrNo ? say(value === 1 ? 'yes' : 'no') : shownFigure(criterion, value, language)}</td>
      <td class="figure">{isYesOrNo ? '' : side === 'lower' ? say('needed', {limit: limitText}) : limitText}</td>
      <td class="figure">{expanded === null ? '' : shownFigure(criterion, expanded, language)}</td>
    </tr>
  );
}

const kWidth = 160;
const kLimit = kWidth * (2 / 3);

/** The value as a bar, its uncertainty as a thinner one, the limit as a line at two thirds. */
function Bar({row}: {row: LimitRow}) {
  const {share, shareExpanded} = row;
  const place = (of_limit: number): number => Math.min(kWidth, Math.max(0, of_limit) * kLimit);
  const [from, to] = [place(share ?? 0), place(shareExpanded ?? share ?? 0)].sort((a, b) => a - b) as [number, number];
  return (
    <svg viewBox={`0 0 ${kWidth} 14`} preserveAspectRatio="none" class={isFailed(row) ? 'bar beyond' : 'bar'} aria-hidden="true">
      <rect class="ground" x="0" y="3" width={kWidth} height="8" />
      <rect class="value" x="0" y="3" width={place(share ?? 0)} height="8" />
      <rect class="expanded" x={from} y="5.5" width={to - from} height="3" />
      <path class="limit" d={`M${kLimit} 0v14`} />
    </svg>
  );
}
