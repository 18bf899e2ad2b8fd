import type {Desk} from '../model/desk.ts';
import {number} from '../model/format.ts';
import type {PageState} from '../model/page_state.ts';
import {numberingOf, whereByNumber} from '../model/places.ts';
import {handButtons, handWords} from '../words/hand_words.ts';
import {HoldButton} from './hold_button.tsx';
import {Symbol} from './symbol.tsx';
import {OuterText, useLanguage, useSay} from './texts.tsx';

/** What a person with the pendant is to do: to find the block, or to make a run's touches. */
export function HandPanel({state, desk}: {state: PageState; desk: Desk}) {
  const say = useSay();
  const language = useLanguage();
  const {status} = state;
  if (!status?.by_hand || !status.by_hand_step) return null;
  const {by_hand_step: step, by_hand_index: index, by_hand_total: total} = status;
  const reached = state.link === 'live' || state.link === 'polling';
  const disabled = !reached || state.role !== 'operate';
  const whereOf = whereByNumber(state.cell, numberingOf(state.recipes, status.recipe));
  return (
    <section class="card wait" role="alert">
      <h2>
        <Symbol shape="wait" />
        {status.by_hand === 'locate' ? say('locate') : say('handTitle')}
        {index && total ? <small>{say('handCount', {done: index, total})}</small> : null}
      </h2>
      <p class="big"><OuterText text={handWords(status, language, state.cell, whereOf)} /></p>
      {status.by_hand_problem
        ? <p class="abnormal"><Symbol shape="warning" /><OuterText text={handButtons(status.by_hand_problem, status, say)} isEnglish /></p>
        : null}
      {status.by_hand_joints_deg
        ? <p>{say('handPosture')}: {status.by_hand_joints_deg.map((joint) => number(joint, 0, language)).join(' / ')}</p>
        : null}
      <div class="actions">
        {step === 'touch' && status.by_hand !== 'guided' && <button type="button" disabled={disabled} onClick={() => void desk.command('take')}>{say('take')}</button>}
        {step !== 'passing' && (index ?? 1) > 1
          ? <button type="button" disabled={disabled} onClick={() => void desk.command('undo')}>{say('undo')}</button>
          : null}
        {step === 'pass' && (
          <HoldButton class="inline" note={say('startHold')} disabled={disabled} onHeld={() => void desk.command('locate')}>
            {say('handGoAround')}
          </HoldButton>
        )}
        {status.by_hand === 'locate'
          ? <button type="button" disabled={disabled} onClick={() => void desk.command('stop')}>{say('cancelLocating')}</button>
          : null}
      </div>
    </section>
  );
}
