import {useEffect, useRef, useState} from 'preact/hooks';
import type {Outcome, Pass} from '../model/pass.ts';
import {SecretChoices, SecretField, useSecretEntry} from './secret_field.tsx';
import {keepName, keptName} from './settings.ts';
import {Symbol} from './symbol.tsx';
import {OuterText, useSay} from './texts.tsx';

/** When a name may be tried again, by the clock that only goes forward. */
interface Wait { name: string; until_ms: number }

/** Name and secret. What the daemon says of a wrong one is said in the page's words. */
export function SignInForm({pass, now_ms, onDone}: {pass: Pass; now_ms: number; onDone: () => void}) {
  const say = useSay();
  const [name, setName] = useState(keptName);
  const [secret, setSecret] = useState('');
  const [entry, setEntry] = useSecretEntry();
  const [outcome, setOutcome] = useState<Outcome | null>(null);
  const [wait, setWait] = useState<Wait | null>(null);
  const [isSent, setSent] = useState(false);
  const nameField = useRef<HTMLInputElement>(null), secretField = useRef<HTMLInputElement>(null);
  useEffect(() => (name ? secretField : nameField).current?.focus(), []);
  const left_s = wait && wait.name === name ? Math.max(0, Math.ceil((wait.until_ms - now_ms) / 1000)) : 0;
  const cannot = isSent || left_s > 0 || !name || !secret;
  const signIn = async (): Promise<void> => {
    if (cannot) return;
    setSent(true);
    const came = await pass.signIn(name, secret);
    setSent(false);
    setSecret('');
    setOutcome(came);
    if (came.kind === 'refused' && came.retry_after_s !== null) setWait({name, until_ms: performance.now() + 1000 * came.retry_after_s});
    if (came.kind !== 'done') {
      secretField.current?.focus();
      return;
    }
    keepName(name);
    onDone();
  };
  return (
    <form class="sign-in" onSubmit={(event) => {
      event.preventDefault();
      void signIn();
    }}>
      <label>
        <span>{say('personName')}</span>
        <input ref={nameField} type="text" name="username" dir="auto" maxLength={64} value={name} autocomplete="username" autocapitalize="none" autocorrect="off"
               spellcheck={false} enterkeyhint="next" onInput={(event) => setName(event.currentTarget.value)} />
      </label>
      <SecretField label={say('secret')} value={secret} entry={entry} place={secretField} onInput={setSecret} />
      <SecretChoices entry={entry} onEntry={setEntry} />
      <div role="alert">{outcome && (outcome.kind !== 'done') ? <Refused outcome={outcome} isTooMany={wait !== null && wait.name === name} /> : null}</div>
      {left_s > 0 ? <p class="countdown" aria-live="off"><span class="left">{say('signInWait', {seconds: left_s})}</span></p> : null}
      <button type="submit" disabled={cannot}>{say(isSent ? 'signInSent' : 'signIn')}</button>
    </form>
  );
}

function Refused({outcome, isTooMany}: {outcome: Exclude<Outcome, {kind: 'done'}>; isTooMany: boolean}) {
  const say = useSay();
  if (outcome.kind !== 'refused') return <NotDone outcome={outcome} />;
  if (outcome.status === 401) return <Problem words={say('signInWrong')} />;
  if (outcome.status === 429) return isTooMany ? <Problem words={say('signInTooMany')} /> : null;
  if (outcome.status === 503) return <Problem words={say('signInBusy')} />;
  return <p class="abnormal"><Symbol shape="warning" /> <OuterText text={outcome.detail} isEnglish /></p>;
}

const Problem = ({words}: {words: string}) => <p class="abnormal"><Symbol shape="warning" /> {words}</p>;

/** Why something about persons was not done: the daemon's own words, or that it was not reached. */
export function NotDone({outcome}: {outcome: Outcome | null}) {
  const say = useSay();
  if (!outcome || outcome.kind === 'done') return null;
  if (outcome.kind === 'unkept') return <Problem words={say('notKept')} />;
  if (outcome.kind === 'lost') return <Problem words={say('signInLost')} />;
  if (outcome.status === 401) return <Problem words={say('secretWrong')} />;
  if (outcome.status === 429) return <Problem words={say('secretTooMany', {seconds: outcome.retry_after_s ?? '–'})} />;
  return <p class="abnormal"><Symbol shape="warning" /> <OuterText text={outcome.detail} isEnglish /></p>;
}
