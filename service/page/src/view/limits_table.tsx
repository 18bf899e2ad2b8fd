import type {Criterion, DecisionRule} from '../api/documents.ts';
import {number} from '../model/format.ts';
import {sayName} from '../words/words.ts';
import {Scroll} from './scroll.tsx';
import {Symbol} from './symbol.tsx';
import {useLanguage, useSay} from './texts.tsx';

/** Each figure against the cell's limit, and by which rule it was decided. */
export function LimitsTable({rule}: {rule: DecisionRule}) {
  const say = useSay();
  if (rule.criteria.length === 0) return null;
  return (
    <section>
      <Scroll label={say('limits')}>
        <table>
          <caption>{say('limits')}</caption>
          <thead>
            <tr>
              {(['criterion', 'value', 'limit', 'expanded', 'decision'] as const).map((key) => <th key={key} scope="col">{say(key)}</th>)}
            </tr>
          </thead>
          <tbody>{rule.criteria.map((criterion) => <Row key={`${criterion.name}${criterion.plane}${criterion.tool}`} criterion={criterion} />)}</tbody>
        </table>
      </Scroll>
      <p class="hint">{rule.standard}: {say(rule.rule === 'guarded' ? 'ruleGuarded' : 'ruleSimple')}</p>
    </section>
  );
}

function Row({criterion}: {criterion: Criterion}) {
  const say = useSay();
  const language = useLanguage();
  const {name, plane, tool, unit, value, side, limit, expanded_uncertainty, within_limit, proved} = criterion;
  // A probability or a share needs more digits than a condition number.
  const digits = unit === 'mm' ? 3 : limit > 0 && limit < 1 ? 4 : 1;
  const shownUnit = unit === '1' ? '' : ` ${unit}`;
  return (
    <tr>
      <th scope="row">{sayName(language, 'criterion_', name)}{plane ? `, ${say('plane', {plane})}` : ''}{tool ? `, ${tool}` : ''}</th>
      <td class="figure">{number(value, digits, language)}{shownUnit}</td>
      <td class="figure">{side === 'lower' ? '≥ ' : ''}{number(limit, digits, language)}{shownUnit}</td>
      <td class="figure">{number(expanded_uncertainty, digits, language)}</td>
      <td class={within_limit ? '' : 'abnormal'}>
        {within_limit ? null : <Symbol shape="warning" />}
        {say(within_limit ? (proved ? 'limitProved' : 'limitHeld') : 'limitMissed')}
      </td>
    </tr>
  );
}
