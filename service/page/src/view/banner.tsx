import type {Desk} from '../model/desk.ts';
import {age} from '../model/format.ts';
import {dataAge_ms, type PageState} from '../model/page_state.ts';
import {mustSignIn} from '../model/session.ts';
import {Symbol} from './symbol.tsx';
import {OuterText, useSay} from './texts.tsx';

interface Props { state: PageState; desk: Desk; now_ms: number }

/** What is wrong with the page's own means: no daemon, no token, nobody signed in any more. */
export function Banner({state, desk, now_ms}: Props) {
  const say = useSay();
  const {link, role, session} = state;
  const signIn = mustSignIn(state) && !state.isAccountOpen ? () => desk.showAccount(true) : null;
  if (link === 'lost') {
    return <Card title={say('lostTitle')} words={say('lostWords', {age: age(dataAge_ms(state, now_ms))})} kind="fault" onSignIn={null} />;
  }
  if (role === 'ended') {
    return <Card title={say('endedTitle')} words={say('endedWords', {name: session?.name ?? ''})} kind="warning" onSignIn={signIn} />;
  }
  if (role === 'wrong token') {
    return <Card title={say('staleTitle')} words={say(mustSignIn(state) ? 'staleSignIn' : 'staleWords')} kind="warning" onSignIn={signIn} />;
  }
  if (link === 'refused') {
    return mustSignIn(state) ? <Card title={say('signInTitle')} words={say('signInWords')} kind="warning" onSignIn={signIn} />
        : <Card title={say('refusedTitle')} words={say('refusedWords')} kind="warning" onSignIn={null} />;
  }
  if (role === 'none') return <Watching words={say(mustSignIn(state) ? 'watchSignIn' : 'watchOnly')} />;
  if (role !== 'view') return null;
  return <Watching words={say(session?.kind === 'user' ? 'mayLook' : 'viewOnly')} />;
}

function Watching({words}: {words: string}) {
  return <p class="watching"><Symbol shape="later" />{words}</p>;
}

function Card({title, words, kind, onSignIn}: {title: string; words: string; kind: 'fault' | 'warning'; onSignIn: (() => void) | null}) {
  const say = useSay();
  return (
    <section class={`card ${kind}`} role="alert">
      <h2><Symbol shape={kind} />{title}</h2>
      <p><OuterText text={words} /></p>
      {onSignIn ? <div class="actions"><button type="button" onClick={onSignIn}>{say('signIn')}</button></div> : null}
    </section>
  );
}
