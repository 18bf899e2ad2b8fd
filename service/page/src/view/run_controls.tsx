import type {Desk} from '../model/desk.ts';
import {leadsToSignIn, mainButton, reasonOfRole} from '../model/main_button.ts';
import type {PageState} from '../model/page_state.ts';
import {mayStop} from '../model/session.ts';
import {startBody, type Conditions} from '../model/start_body.ts';
import {mayPause} from '../model/states.ts';
import {reasonWords} from '../words/reason_words.ts';
import {HoldButton} from './hold_button.tsx';
import {useLanguage, useSay} from './texts.tsx';

interface Props { state: PageState; desk: Desk; conditions: Conditions; onStart: () => void }

/** START and its like, PAUSE, STOP MOTION: always in the same places. */
export function RunControls({state, desk, conditions, onStart}: Props) {
  const say = useSay();
  const language = useLanguage();
  const {status, link} = state;
  const reached = link === 'live' || link === 'polling';
  const why = reasonOfRole(state);
  const pausable = reached && status !== null && mayPause(status.state);
  return (
    <aside class="run-controls" aria-label={say('runControls')}>
      <MainButton state={state} desk={desk} conditions={conditions} onStart={onStart} />
      <button
        type="button"
        class="run pause"
        disabled={!pausable || why !== null}
        aria-keyshortcuts="Alt+P"
        onClick={() => void desk.command('pause')}
      >
        <span class="label">{say('pause')}</span>
        {pausable && why ? <span class="note">{reasonWords(why, say, language)}</span> : null}
      </button>
      <button
        type="button"
        class="run stop"
        disabled={!mayStop(state)}
        aria-keyshortcuts="Alt+S"
        onClick={() => void desk.command('stop')}
      >
        <span class="label">{say('stopMotion')}</span>
        <span class="note">{say('stopNote')}</span>
      </button>
    </aside>
  );
}

/** What leads on from here, or why nothing does. */
function MainButton({state, desk, conditions, onStart}: Props) {
  const say = useSay();
  const language = useLanguage();
  const {status, recipe} = state;
  const body = startBody(recipe ?? '', conditions, state.cell?.block ?? null);
  const {action, why} = mainButton(state, body.block_temperature_c !== undefined, !conditions.kind);
  if (leadsToSignIn(why)) {
    return (
      <div role="group" aria-label={say('nextStep')}>
        <button type="button" class="run main" onClick={() => desk.showAccount(true)}>
          <span class="label">{say('signInButton')}</span>
          <span class="note">{why ? reasonWords(why, say, language) : ''}</span>
        </button>
      </div>
    );
  }
  const disabled = why !== null;
  const note = why ? reasonWords(why, say, language) : say(action === 'reset' ? (status?.retract_due ? 'resetBackWords' : 'resetWords') : 'startHold');
  return (
    <div role="group" aria-label={say('nextStep')}>
      {action === 'reset' ? (
        <button type="button" class="run main" disabled={disabled} onClick={() => void desk.command('reset')}>
          <span class="label">{say('reset')}</span>
          <span class="note">{note}</span>
        </button>
      ) : (
        <HoldButton class="main" note={note} disabled={disabled} onHeld={action === 'start' ? onStart : () => void desk.command(action)}>
          {say(action === 'start' && conditions.kind ? `start_${conditions.kind}` : action)}
        </HoldButton>
      )}
    </div>
  );
}
