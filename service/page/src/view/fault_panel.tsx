import {useEffect, useRef} from 'preact/hooks';
import type {Desk} from '../model/desk.ts';
import {time} from '../model/format.ts';
import type {PageState} from '../model/page_state.ts';
import {touchActions} from '../model/states.ts';
import {isAtWork, toldFault, type StickyFault} from '../model/sticky_faults.ts';
import {commandWords, hasTitle, faultWords, withButtons} from '../words/fault_words.ts';
import {stickyTitle} from '../words/sticky_title.ts';
import {HoldButton} from './hold_button.tsx';
import {Symbol} from './symbol.tsx';
import {OuterText, useLanguage, useSay} from './texts.tsx';

/** Faults and warnings, until a person has noted each of them; what is over is a line each. */
export function FaultPanel({state, desk}: {state: PageState; desk: Desk}) {
  const say = useSay();
  const reached = state.link === 'live' || state.link === 'polling';
  const place = useRef<HTMLDivElement>(null);
  const told = toldFault(state.faults)?.key ?? null;
  useEffect(() => {
    if (told !== null) showInMain(place.current);  // whatever was read when it came
  }, [told]);
  const past = state.faults.filter((fault) => !fault.isWarning && !isAtWork(fault));
  return (
    <>
      <div class="faults" role="alert" ref={place}>
        {state.faults.filter((fault) => fault.isWarning || isAtWork(fault))
            .map((fault) => <FaultCard key={fault.key} fault={fault} state={state} desk={desk} reached={reached} />)}
        <Refusal state={state} desk={desk} />
      </div>
      {past.length > 0
        ? <ul class="past-faults" aria-label={say('pastFaults')}>{past.map((fault) => <PastFault key={fault.key} fault={fault} desk={desk} />)}</ul>
        : null}
    </>
  );
}

/** Only `main` scrolls: scrollIntoView() would take the header with it where the document can be moved. */
function showInMain(element: HTMLElement | null): void {
  const main = element?.closest('main');
  if (element && main) main.scrollTop += element.getBoundingClientRect().top - main.getBoundingClientRect().top;
}

function Title({fault}: {fault: StickyFault}) {
  const language = useLanguage();
  const isOwn = hasTitle(language, fault.code) || fault.code === 'permission_lost';
  return <OuterText text={stickyTitle(fault, language)} isEnglish={!isOwn} />;
}

/** A fault that is over, until somebody has read it: grey, it asks for nothing any more. */
function PastFault({fault, desk}: {fault: StickyFault; desk: Desk}) {
  const say = useSay();
  return (
    <li>
      <span class="what"><Title fault={fault} /> ({say('faultOver')}, {time(fault.at)})</span>
      <button type="button" class="small" onClick={() => desk.note(fault.key)}>{say('note')}</button>
    </li>
  );
}

function FaultCard({fault, state, desk, reached}: {fault: StickyFault; state: PageState; desk: Desk; reached: boolean}) {
  const say = useSay();
  const language = useLanguage();
  const words = faultWords(language, fault.code, state.faultTable);
  const isShown = !fault.isWarning && !fault.isOver;
  // The daemon's message has what was special about this time behind the table's words.
  const cause = language === 'en' || !words ? fault.message : withDetail(words.cause, fault, state);
  const robot_action = (language === 'en' ? fault.robot_action : null) ?? words?.robot_action ?? null;
  const next_step = (language === 'en' ? fault.next_step : null) ?? words?.next_step ?? null;
  // What holds a run is settled by how the run goes on.
  const holds = isShown && state.status?.state === 'HELD';
  const actions = isShown && state.status && reached && state.role === 'operate' ? touchActions(state.status) : [];
  return (
    <article class={fault.isWarning ? 'card warning' : 'card fault'}>
      <h2>
        <Symbol shape={fault.isWarning ? 'warning' : 'fault'} />
        {say(fault.isWarning ? 'warningTitle' : 'faultTitle')} <Title fault={fault} />
      </h2>
      {fault.isCauseTold && fault.cause ? <p class="big">{say('stillTold', {what: say(`release_${fault.cause}`)})}</p> : null}
      <dl>
        <div><dt>{say('cause')}</dt><dd><OuterText text={cause} /></dd></div>
        {robot_action && <div><dt>{say('robotDid')}</dt><dd><OuterText text={robot_action} /></dd></div>}
        {next_step && <div><dt>{say('nextStep')}</dt><dd><OuterText text={withButtons(next_step, say)} /></dd></div>}
      </dl>
      <div class="actions">
        {actions.map((action) => (
          <HoldButton key={action} class="inline" note={say('startHold')} disabled={!state.status?.controller_connected}
                      onHeld={() => void desk.command(action)}>
            {say(action === 'retry' ? 'retry' : 'skip')}
          </HoldButton>
        ))}
        {isShown && !holds
          ? <button type="button" disabled={state.role !== 'operate' || !reached || fault.isCauseTold}
                    onClick={() => void desk.command('acknowledge')}>{say('acknowledge')}</button>
          : null}
        {fault.isWarning ? <button type="button" onClick={() => desk.note(fault.key)}>{say('note')}</button> : null}
      </div>
    </article>
  );
}

/** The translated cause, and what the daemon's message says beyond its own words for it. */
function withDetail(cause: string, fault: StickyFault, state: PageState): string {
  const own = state.faultTable[fault.code]?.cause ?? '';
  const detail = fault.message.startsWith(own) ? fault.message.slice(own.length).replace(/^[:;,\s]+/, '') : fault.message;
  return detail ? `${cause} (${detail})` : cause;
}

/** A command that was not taken. */
function Refusal({state, desk}: {state: PageState; desk: Desk}) {
  const say = useSay();
  const {notice} = state;
  if (!notice) return null;
  const words = notice.problem?.detail ?? say('noAnswer');
  return (
    <article class="card warning">
      <h2><Symbol shape="warning" />{say('refusedCommand', {command: commandWords(notice.command, say)})}</h2>
      <p><OuterText text={words} isEnglish={notice.problem !== null} /></p>
      <ul>{notice.problem?.errors?.map(({code, detail}) => <li key={code}><OuterText text={detail} isEnglish /></li>)}</ul>
      <div class="actions"><button type="button" onClick={() => desk.dropNotice()}>{say('note')}</button></div>
    </article>
  );
}
