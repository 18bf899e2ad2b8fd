import type {Status} from '../api/documents.ts';
import type {Link} from '../api/live.ts';
import {faceWords} from '../model/faces.ts';
import {age, cut, duration} from '../model/format.ts';
import {dataAge_ms, type PageState} from '../model/page_state.ts';
import {numberingOf, whereByNumber} from '../model/places.ts';
import {minutesLeft, signedIn} from '../model/session.ts';
import {isActive, isBlockToMove, isLocating, isMotionDisabled, mood} from '../model/states.ts';
import type {Say, WordKey} from '../words/words.ts';
import {Symbol} from './symbol.tsx';
import {useSay} from './texts.tsx';
import {kVerdictShapes} from './verdict_shapes.ts';

const kLinkWords: Record<Link, WordKey> = {
  connecting: 'linkConnecting', live: 'linkLive', polling: 'linkPolling', lost: 'linkLost', refused: 'linkRefused',
};
/** Older data say nothing of the arm any more. */
const kStale_ms = 2000;

/** The state and the verdict, readable from three metres; what the run does; how old all of this is. */
export function Header({state, now_ms}: {state: PageState; now_ms: number}) {
  const say = useSay();
  const {status, link, cell} = state;
  const isLost = link === 'lost' || link === 'refused' || link === 'connecting';
  const age_ms = dataAge_ms(state, now_ms);
  const isOld = age_ms === null || age_ms > kStale_ms;
  const shown = status && !isLost ? shownState(status, state) : null;
  return (
    <header>
      <div class={`state ${isLost || !status ? 'unknown' : mood(status)}`} role="status">
        <Symbol shape={shown ?? (link === 'lost' ? 'lost' : 'unknown')} />
        <h1 tabIndex={-1}>{isLost ? say(kLinkWords[link]) : say(shown ?? 'loading')}</h1>
      </div>
      {status && !isLost ? <ShownVerdict status={status} /> : null}
      <div class="progress">{status && <Progress status={status} isLost={isLost} state={state} />}</div>
      <dl class="link">
        <div class={isLost ? 'abnormal' : ''}>
          <dt>{cell ? <ShortText text={cell.name} /> : say('title')}</dt>
          <dd>{isLost ? <Symbol shape="fault" /> : null}{say(kLinkWords[link])}</dd>
        </div>
        <div class={isOld ? 'abnormal' : ''} data-age={age_ms === null ? '' : Math.round(age_ms)}>
          <dt>{say('dataAge')}</dt>
          <dd>{isOld ? <Symbol shape="warning" /> : null}{age(age_ms)}{isOld ? ` (${say('dataStale')})` : ''}</dd>
        </div>
        <Who state={state} />
      </dl>
    </header>
  );
}

/** Who is signed in; a name that is too long for its line is cut, whichever way it is written. */
function Who({state: {session}}: {state: PageState}) {
  const say = useSay();
  if (!session || session.role === 'none') return null;
  const name = signedIn(session) ?? session.name;
  const left_min = minutesLeft(session, Date.now());
  return (
    <div class={left_min === null ? 'who' : 'who abnormal'}>
      <dt><span class="visually-hidden">{say('signedInAs')}</span><Symbol shape="person" /></dt>
      <dd class="one-line" title={name ?? undefined}>{name === null ? say('accessCode') : <bdi>{name}</bdi>}</dd>
      <dd class="role">· {say(`role_${session.role}`)}</dd>
      {left_min === null ? null : <dd class="left">· {say('sessionLeft', {minutes: left_min})}</dd>}
    </div>
  );
}

/** A name on one line; whole names stand in the views. */
function ShortText({text}: {text: string}) {
  const start = cut(text, 80);
  return <span class="one-line" title={start ?? text}>{start === null ? text : `${start}…`}</span>;
}

type ShownState = Status['state'] | 'locating' | 'notReady' | 'motionDisabled' | 'blockToMove';

/** What is said of the cell in one word: the state, and where a person is waited for, that. */
function shownState(status: Status, {unmet}: PageState): ShownState {
  if (isMotionDisabled(status)) return 'motionDisabled';
  if (isLocating(status)) return 'locating';
  if (isBlockToMove(status)) return 'blockToMove';
  if (status.state === 'IDLE' && unmet !== null && unmet.length > 0) return 'notReady';
  const isAsking = status.waiting_for !== null && (status.state === 'STARTING' || status.state === 'UNHOLDING' || status.state === 'RESETTING');
  return isAsking ? 'SUSPENDED' : status.state;
}

/** Of the run that has ended: while one goes on there is none. */
function ShownVerdict({status: {verdict, state}}: {status: Status}) {
  const say = useSay();
  if (verdict === 'none' || isActive(state)) return null;
  return (
    <p class={`header-verdict ${verdict}`} role="status">
      <Symbol shape={kVerdictShapes[verdict]} />
      <span class="word">{say(`verdict_${verdict}`)}</span>
    </p>
  );
}

/** No time is known before the first touch has told how long one takes. */
function timeLeft({eta_s, touches_done, touches_total}: Status, say: Say): string {
  if (eta_s === null) return '';
  const isKnown = eta_s > 0 || touches_total === null || touches_done >= touches_total;
  return ` · ${isKnown ? say('timeLeft', {time: duration(eta_s)}) : say('timeLeftUnknown')}`;
}

function Progress({status, isLost, state: {cell, recipes}}: {status: Status; isLost: boolean; state: PageState}) {
  const say = useSay();
  if (!status.run_id) return <p>{say('noRun')}</p>;
  const total = status.touches_total;
  const active = isActive(status.state);
  const whereOf = whereByNumber(cell, numberingOf(recipes, status.recipe));
  const count = total ? say('touchOf', {done: status.touches_done, total}) : say('touchesDone', {done: status.touches_done});
  return (
    <div class={isLost ? 'old' : ''}>
      <p class="count">
        {count}
        {active && status.plane ? ` · ${faceWords(cell, status.plane, say, whereOf)}` : ''}
        {active ? timeLeft(status, say) : ''}
      </p>
      <progress max={total ?? 1} value={total ? status.touches_done : 0} aria-label={say('touches')} />
      <p class="run-name"><ShortText text={say('runOf', {run: status.run_id, recipe: status.recipe ?? ''})} /></p>
    </div>
  );
}
