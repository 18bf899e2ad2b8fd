import {useEffect, useRef, useState} from 'preact/hooks';
import type {Desk} from '../model/desk.ts';
import {time} from '../model/format.ts';
import type {PageState} from '../model/page_state.ts';
import type {Outcome, Pass} from '../model/pass.ts';
import {isEngineer, signedIn} from '../model/session.ts';
import {mayMove} from '../model/states.ts';
import {PeoplePanel} from './people_panel.tsx';
import {kSecretMin, SecretChoices, SecretField, useSecretEntry} from './secret_field.tsx';
import {NotDone, SignInForm} from './sign_in_form.tsx';
import {TabletOffer} from './tablet_offer.tsx';
import {useSay} from './texts.tsx';

export interface AccountProps { state: PageState; desk: Desk; now_ms: number }

/** Who is at this page: signs in and out. It stands in the page, not over it: STOP stays in sight and in reach. */
export function AccountPanel({state, desk, now_ms}: AccountProps) {
  const say = useSay();
  const {session} = state;
  const title = useRef<HTMLHeadingElement>(null);
  const [left, setLeft] = useState<Outcome | null>(null);
  const close = (): void => {
    desk.showAccount(false);
    document.querySelector<HTMLElement>('header h1')?.focus();
  };
  useEffect(() => {
    if (!title.current?.closest('.account')?.contains(document.activeElement)) title.current?.focus();  // a form has its own first field
  }, []);
  if (!session) return null;
  const isSomebody = session.role !== 'none';
  return (
    <section class="card account" aria-labelledby="account" onKeyDown={(event) => {
      if (event.key === 'Escape') close();
    }}>
      <div class="account-head">
        <h2 id="account" ref={title} tabIndex={-1}>{say(isSomebody ? 'account' : 'signIn')}</h2>
        <button type="button" onClick={close}>{say('close')}</button>
      </div>
      <div role="alert"><NotDone outcome={left} /></div>
      {isSomebody ? <Somebody state={state} pass={desk.pass} onLeft={setLeft} /> : null}
      {!isSomebody && session.sign_in ? <SignInForm pass={desk.pass} now_ms={now_ms} onDone={close} /> : null}
      {!isSomebody && !session.sign_in ? <p>{say('nobodyYet')}</p> : null}
      {isEngineer(state) ? <PeoplePanel state={state} pass={desk.pass} /> : null}
      {isEngineer(state) ? <SetupOffer desk={desk} /> : null}
      {session.kind === 'token' && isSomebody && session.sign_in ? <OtherPerson desk={desk} now_ms={now_ms} onDone={close} /> : null}
      <TabletOffer />
    </section>
  );
}

/** Another cell, or this one anew: not in the operator's way. */
function SetupOffer({desk}: {desk: Desk}) {
  const say = useSay();
  const open = (): void => {
    desk.showAccount(false);
    desk.show('setup');
  };
  return (
    <div class="setup-offer">
      <h3>{say('setUp')}</h3>
      <p>{say('setUpWords')}</p>
      <button type="button" onClick={open}>{say('setUp')}</button>
    </div>
  );
}

/** Who acts here, and until when. */
function Somebody({state: {session, status}, pass, onLeft}: {state: PageState; pass: Pass; onLeft: (outcome: Outcome) => void}) {
  const say = useSay();
  if (!session || session.role === 'none') return null;
  const person = signedIn(session);
  return (
    <div class="somebody">
      <p class="outer">
        {person === null ? say('byAccessCode') : say('signedInAs')} <bdi><strong>{session.name ?? ''}</strong></bdi>{session.name ? ', ' : ''}{say(`role_${session.role}`)}
        {session.ends_at ? <>, {say('signedInUntil', {at: time(session.ends_at)})}</> : null}
      </p>
      <p>{say(`roleWords_${session.role}`)}</p>
      {person !== null || session.sign_in
        ? <Leaving words={say(person === null ? 'forgetCode' : 'signOut')} mayMove={mayMove(status)} onLeave={() => void pass.signOut().then(onLeft)} />
        : null}
      {person === null ? null : <OwnSecret key={person} pass={pass} />}
    </div>
  );
}

/** Asked twice while the arm may move: without its token this page does not stop it. */
function Leaving({words, mayMove, onLeave}: {words: string; mayMove: boolean; onLeave: () => void}) {
  const say = useSay();
  const [isAsked, setAsked] = useState(false);
  if (!mayMove || !isAsked) return <button type="button" onClick={() => (mayMove ? setAsked(true) : onLeave())}>{words}{mayMove ? '…' : ''}</button>;
  return (
    <div class="card warning" role="alertdialog" aria-labelledby="leaving">
      <p id="leaving">{say('leaveAsk')}</p>
      <div class="actions">
        <button type="button" onClick={onLeave}>{words}</button>
        <button type="button" onClick={() => setAsked(false)}>{say('cancel')}</button>
      </div>
    </div>
  );
}

/** Beside an access code: a person signs in in its place. */
function OtherPerson({desk, now_ms, onDone}: {desk: Desk; now_ms: number; onDone: () => void}) {
  const say = useSay();
  const [isOpen, setOpen] = useState(false);
  if (!isOpen) return <button type="button" onClick={() => setOpen(true)}>{say('signInByName')}</button>;
  return <SignInForm pass={desk.pass} now_ms={now_ms} onDone={onDone} />;
}

function OwnSecret({pass}: {pass: Pass}) {
  const say = useSay();
  const [isOpen, setOpen] = useState(false);
  const [before, setBefore] = useState('');
  const [after, setAfter] = useState('');
  const [entry, setEntry] = useSecretEntry();
  const [outcome, setOutcome] = useState<Outcome | null>(null);
  if (!isOpen) {
    return (
      <>
        <button type="button" onClick={() => setOpen(true)}>{say('secretChange')}</button>
        <p role="status">{outcome?.kind === 'done' ? say('secretChanged') : ''}</p>
      </>
    );
  }
  const cannot = !before || after.length < kSecretMin;
  const change = async (): Promise<void> => {
    if (cannot) return;
    const came = await pass.changeSecret(before, after);
    setOutcome(came);
    setBefore('');
    if (came.kind !== 'done') return;
    setAfter('');
    setOpen(false);
  };
  return (
    <form class="sign-in" onSubmit={(event) => {
      event.preventDefault();
      void change();
    }}>
      <h3>{say('secretChange')}</h3>
      <SecretField label={say('secretNow')} value={before} entry={entry} onInput={setBefore} />
      <SecretField label={say('secretNew')} value={after} entry={entry} isNew onInput={setAfter} />
      <SecretChoices entry={entry} onEntry={setEntry} />
      <p class="hint">{say('secretRule', {count: kSecretMin})}</p>
      <div role="alert"><NotDone outcome={outcome} /></div>
      <div class="actions">
        <button type="submit" disabled={cannot}>{say('secretChange')}</button>
        <button type="button" onClick={() => setOpen(false)}>{say('cancel')}</button>
      </div>
    </form>
  );
}
