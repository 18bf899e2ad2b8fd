import type {Ref} from 'preact';
import {useState} from 'preact/hooks';
import {keepIsKeypad, keptIsKeypad} from './settings.ts';
import {useSay} from './texts.tsx';

/** The daemon's rule, told before it has to refuse. */
export const kSecretMin = 6;
const kSecretMax = 128;

/** How the secrets of a form are typed: with which keys, and seen or not. */
export interface SecretEntry { isKeypad: boolean; isShown: boolean }
interface Choices { entry: SecretEntry; onEntry: (entry: SecretEntry) => void }

export function useSecretEntry(): [SecretEntry, (entry: SecretEntry) => void] {
  return useState<SecretEntry>(() => ({isKeypad: keptIsKeypad(), isShown: false}));
}

interface Field {
  label: string;
  value: string;
  entry: SecretEntry;
  isNew?: boolean;
  place?: Ref<HTMLInputElement>;
  onInput: (secret: string) => void;
}

export function SecretField({label, value, entry: {isKeypad, isShown}, isNew, place, onInput}: Field) {
  return (
    <label>
      <span>{label}</span>
      <input {...(isShown ? {type: 'text' as const} : {type: 'password' as const})} ref={place ?? null} inputMode={isKeypad ? 'numeric' : 'text'} maxLength={kSecretMax} value={value}
             autocomplete={isNew ? 'new-password' : 'current-password'} autocapitalize="none" autocorrect="off" spellcheck={false} enterkeyhint="go"
             onInput={(event) => onInput(event.currentTarget.value)} />
    </label>
  );
}

/** A PIN is typed with large digits on a tablet. */
export function SecretChoices({entry, onEntry}: Choices) {
  const say = useSay();
  const takeKeypad = (isKeypad: boolean): void => {
    keepIsKeypad(isKeypad);
    onEntry({...entry, isKeypad});
  };
  return (
    <div class="secret-choices">
      <label class="check">
        <input type="checkbox" checked={entry.isKeypad} onChange={(event) => takeKeypad(event.currentTarget.checked)} />
        <span>{say('secretKeypad')}</span>
      </label>
      <label class="check">
        <input type="checkbox" checked={entry.isShown} onChange={(event) => onEntry({...entry, isShown: event.currentTarget.checked})} />
        <span>{say('secretShow')}</span>
      </label>
    </div>
  );
}
