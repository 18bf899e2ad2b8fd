import {secondsLeft} from '../model/countdown.ts';
import {time} from '../model/format.ts';
import type {PageState, PausedBy} from '../model/page_state.ts';
import {furtherPlace, kFirstPlace} from '../model/places.ts';
import {isBlockToMove, isPaused, kBlockToMove} from '../model/states.ts';
import {toldFault} from '../model/sticky_faults.ts';
import {stickyTitle} from '../words/sticky_title.ts';
import {sayName, type Say} from '../words/words.ts';
import {Symbol} from './symbol.tsx';
import {OuterText, useLanguage, useSay} from './texts.tsx';

/** What a person at the cell is waited for, and how long still. */
export function WaitPanel({state, now_ms}: {state: PageState; now_ms: number}) {
  const say = useSay();
  const language = useLanguage();
  const waiting = state.status?.waiting_for;
  if (!waiting) return null;
  return (
    <section class="card wait" role="alert">
      <h2><Symbol shape="wait" />{say('waitTitle')}</h2>
      <p class="big"><OuterText text={sayName(language, 'wait_', waiting)} /></p>
      <Countdown state={state} now_ms={now_ms} />
    </section>
  );
}

/** Only the key has a time that the controller keeps; it is not read aloud each second. */
function Countdown({state, now_ms}: {state: PageState; now_ms: number}) {
  const say = useSay();
  const left_s = secondsLeft(state, now_ms);
  if (left_s === null) return null;
  const whole_s = state.cell?.confirm_s ?? 1;
  return (
    <p class="countdown" aria-live="off">
      <progress max={whole_s} value={left_s} aria-label={say('waitTitle')} />
      <span class="left">{left_s > 0 ? say('waitLeft', {seconds: left_s}) : say('waitOver')}</span>
    </p>
  );
}

/** Why the run does not go on, who asked for that, and how it goes on. */
export function HoldPanel({state}: {state: PageState}) {
  const say = useSay();
  const language = useLanguage();
  const {status} = state;
  if (!status || status.waiting_for) return null;
  if (isPaused(status) && !status.by_hand) {
    return (
      <section class="card hold" role="status">
        <h2><Symbol shape="HELD" /><OuterText text={pausedWords(state.pausedBy, say)} /></h2>
        <p>{say(status.state === 'HELD' ? 'pausedNext' : 'pausingNext')}</p>
      </section>
    );
  }
  if (isBlockToMove(status)) return <BlockToMove state={state} />;
  if (status.fault_code === kBlockToMove) return <p class="card hold" role="status"><Symbol shape="blockToMove" /> {say('blockAway')}</p>;
  const fault = toldFault(state.faults);
  if (!fault || status.state !== 'SUSPENDED') return null;  // a fault that holds the run has its own card
  const words = say('suspendedBy', {fault: stickyTitle(fault, language)});
  return <p class="card hold" role="status"><Symbol shape="SUSPENDED" /> <OuterText text={words} /></p>;
}

/** Where the block is to be brought, and how the run goes on then. */
function BlockToMove({state}: {state: PageState}) {
  const say = useSay();
  const place = state.status?.block_place ?? null;
  const isBack = place === kFirstPlace;
  return (
    <section class="card wait" role="alert">
      <h2><Symbol shape="blockToMove" />{say('blockToMove')}</h2>
      <p class="big"><OuterText text={isBack ? say('bringBack') : say('bringBlock', {place: place ?? '–'})} /></p>
      {isBack ? null : <WhereInPlace state={state} place={place} />}
      <p>{say('bringNext')}</p>
    </section>
  );
}

/** A known place has dowels; of one that the touches find the daemon's message says how far off it may be. */
function WhereInPlace({state: {cell, status}, place}: {state: PageState; place: string | null}) {
  const say = useSay();
  if (cell && furtherPlace(cell, place)?.is_known) return <p>{say('bringKnown')}</p>;
  const message = status?.fault_message ?? '';
  const [, mm] = message.match(/, within (\d+) mm of where the block's file has it$/) ?? [];
  return <p>{mm ? say('bringFound', {mm}) : <OuterText text={message} isEnglish />}</p>;
}

function pausedWords(pausedBy: PausedBy | null, say: Say): string {
  if (!pausedBy) return say('pausedBySomebody');
  const {name, from, at} = pausedBy;
  return say('pausedBy', {who: name ? say('whoNamed', {name, from}) : say('whoOperate', {from}), at: time(at)});
}
