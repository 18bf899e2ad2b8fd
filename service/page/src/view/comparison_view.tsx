import type {ComparedPart, Comparison as Compared} from '../api/documents.ts';
import {planeNumber} from '../model/faces.ts';
import {number} from '../model/format.ts';
import {compareHeldOut} from '../model/history.ts';
import {comparedPair, comparisonKey, type PageState} from '../model/page_state.ts';
import {verdictOf} from '../model/verdict.ts';
import {Scroll} from './scroll.tsx';
import {Symbol} from './symbol.tsx';
import {OuterText, useLanguage, useSay} from './texts.tsx';
import {kVerdictShapes} from './verdict_shapes.ts';

/** Two runs: whether the arm has changed between them, and how right each is on touches that were never fitted. */
export function Comparison({state}: {state: PageState}) {
  const say = useSay();
  const pair = comparedPair(state.compared);
  if (!pair) return <p class="hint">{say('compareHint')}</p>;
  const [earlier, later] = pair;
  const found = state.comparisons[comparisonKey(pair)];
  return (
    <section aria-label={say('comparison', {a: earlier, b: later})}>
      <h2>{say('comparison', {a: earlier, b: later})}</h2>
      {!found ? <p class="hint">{say('comparisonBusy')}</p>
        : found.kind === 'refused' ? <p><OuterText text={say('comparisonRefused', {why: found.why})} /></p>
        : <KnownComparison comparison={found.comparison} />}
      <HeldOut state={state} earlier={earlier} later={later} />
    </section>
  );
}

const verdictOfPart = ({changed}: ComparedPart) => (changed === null ? 'none' : changed ? 'rejected' : 'accepted');
const kPartWords = {none: 'comparedUnknown', rejected: 'comparedChanged', accepted: 'comparedSame'} as const;

function KnownComparison({comparison}: {comparison: Compared}) {
  const say = useSay();
  const language = useLanguage();
  const {arm, tool, growth_ppm, std_growth_ppm, tip_difference_mm, std_tip_difference_mm} = comparison;
  return (
    <>
      {([['comparedArm', arm], ['comparedStylus', tool]] as const).map(([what, part]) => (
        <p key={what} class={part.changed ? 'abnormal' : ''}>
          <Symbol shape={kVerdictShapes[verdictOfPart(part)]} /> {say(kPartWords[verdictOfPart(part)], {what: say(what)})}
        </p>
      ))}
      <p>{say('comparedGrowth', {growth: number(growth_ppm, 0, language), std: number(std_growth_ppm, 0, language)})}</p>
      <p>{say('comparedTip', {tip: number(tip_difference_mm, 3, language), chance: number(std_tip_difference_mm, 3, language)})}</p>
      <Combinations arm={arm} tool={tool} />
    </>
  );
}

const kShown = 5;  // of each part: the most striking ones say it all

function Combinations({arm, tool}: {arm: ComparedPart; tool: ComparedPart}) {
  const say = useSay();
  const rows = ([['comparedArm', arm], ['comparedStylus', tool]] as const)
      .flatMap(([what, part]) => part.combinations.slice(0, kShown).map((combination, k) => ({what, combination, key: `${what}${k}`})));
  return (
    <>
      <Scroll label={say('combinations')}>
        <table>
          <caption>{say('combinations')}</caption>
          <thead>
            <tr><th scope="col">{say('comparedPart')}</th><th scope="col">E<sub>n</sub></th><th scope="col">{say('combination')}</th></tr>
          </thead>
          <tbody>{rows.map(({what, combination, key}) => <CombinationRow key={key} what={say(what)} combination={combination} />)}</tbody>
        </table>
      </Scroll>
      <p class="hint">{say('combinationHint')}</p>
    </>
  );
}

function CombinationRow({what, combination: {e_n, shares}}: {what: string; combination: ComparedPart['combinations'][number]}) {
  const language = useLanguage();
  const isBeyond = e_n !== null && Math.abs(e_n) > 1;
  const signed = (value: number | null): string => `${value !== null && value >= 0 ? '+' : ''}${number(value, 1, language)}`;
  return (
    <tr>
      <th scope="row">{what}</th>
      <td class={isBeyond ? 'figure abnormal' : 'figure'}>{isBeyond ? <Symbol shape="warning" /> : null}{number(e_n, 2, language)}</td>
      <td>{shares.map(({parameter, share}) => `${signed(share)} ${parameter}`).join('  ')}</td>
    </tr>
  );
}

function HeldOut({state, earlier, later}: {state: PageState; earlier: string; later: string}) {
  const say = useSay();
  const language = useLanguage();
  const [first, second] = [state.results[earlier], state.results[later]];
  if (!first || !second) return null;
  return (
    <Scroll label={say('comparedFigures')}>
      <table>
        <caption>{say('comparedFigures')}</caption>
        <thead>
          <tr>
            <th scope="col">{say('verifiedWhat')}</th>
            <th scope="col">{earlier}</th>
            <th scope="col">{later}</th>
            <th scope="col">{say('difference')}</th>
            <th scope="col">{say('unit')}</th>
          </tr>
        </thead>
        <tbody>
          <tr>
            <th scope="row">{say('verdict')}</th>
            <td>{say(`verdict_${verdictOf(earlier, first, state)}`)}</td>
            <td>{say(`verdict_${verdictOf(later, second, state)}`)}</td>
            <td /><td />
          </tr>
          {compareHeldOut(first, second, state.cell).map((row) => (
            <tr key={`${row.plane} ${row.place} ${row.tip}`}>
              <th scope="row">{say('heldOutOf', {plane: planeNumber(state.cell, row.plane, say, () => row)})}</th>
              {[row.a, row.b, row.difference].map((value, i) => <td key={i} class="figure">{number(value, 3, language)}</td>)}
              <td>mm</td>
            </tr>
          ))}
        </tbody>
      </table>
    </Scroll>
  );
}
