import type {Desk} from '../model/desk.ts';
import type {PageState} from '../model/page_state.ts';
import {isReadyFor} from '../model/readiness.ts';
import {startBody, type Conditions} from '../model/start_body.ts';
import {isLocating, mainAction, mayPause} from '../model/states.ts';
import {HoldButton} from './hold_button.tsx';
import {useSay} from './texts.tsx';

interface Props { state: PageState; desk: Desk; conditions: Conditions; onStart: () => void }

/** START and its like, PAUSE, STOP MOTION: always in the same places. */
export function RunControls({state, desk, conditions, onStart}: Props) {
  const say = useSay();
  const {status, link, role} = state;
  const reached = link === 'live' || link === 'polling';
  const operates = role === 'operate';
  return (
    <aside class="run-controls" aria-label={say('runControls')}>
      <MainButton state={state} desk={desk} conditions={conditions} onStart={onStart} usable={reached && operates} />
      <button
        type="button"
        class="run pause"
        disabled={!reached || !operates || !status || !mayPause(status.state)}
        aria-keyshortcuts="Alt+P"
        onClick={() => void desk.command('pause')}
      >
        <span class="label">{say('pause')}</span>
      </button>
      <button
        type="button"
        class="run stop"
        disabled={!operates}
        aria-keyshortcuts="Alt+S"
        onClick={() => void desk.command('stop')}
      >
        <span class="label">{say('stopMotion')}</span>
        <span class="note">{say('stopNote')}</span>
      </button>
    </aside>
  );
}

function MainButton({state, desk, conditions, onStart, usable}: Props & {usable: boolean}) {
  const say = useSay();
  const {status, busy, recipe} = state;
  const action = status ? mainAction(status.state, status.retract_due === true) : null;
  const disabled = !usable || busy === 'start' || action === null;
  const isLinked = status?.controller_connected ?? false;
  if (action === 'resume') {
    return (
      <HoldButton class="main" note={say(isLinked ? 'startHold' : 'noController')} disabled={disabled || !isLinked}
                  onHeld={() => void desk.command('resume')}>
        {say('resume')}
      </HoldButton>
    );
  }
  if (action === 'clear') {
    return (
      <HoldButton class="main" note={say('startHold')} disabled={disabled} onHeld={() => void desk.command('clear')}>
        {say('clear')}
      </HoldButton>
    );
  }
  if (action === 'reset') {
    return (
      <button type="button" class="run main" disabled={disabled} onClick={() => void desk.command('reset')}>
        <span class="label">{say('reset')}</span>
        <span class="note">{say(status?.retract_due ? 'resetBackWords' : 'resetWords')}</span>
      </button>
    );
  }
  const locating = status !== null && isLocating(status);
  const body = startBody(recipe ?? '', conditions, state.cell?.block ?? null);
  const isReady = isReadyFor(state.unmet, body.block_temperature_c !== undefined);
  return (
    <HoldButton class="main" note={say(locating ? 'locatingFirst' : action ? 'startHold' : 'wait')}
                disabled={disabled || locating || !isReady || !recipe} onHeld={onStart}>
      {say('start')}
    </HoldButton>
  );
}
