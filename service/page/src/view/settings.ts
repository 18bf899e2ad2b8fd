// What a person chose on this browser. A browser that keeps nothing begins anew each time.
import type {Language} from '../model/format.ts';
import type {Conditions} from '../model/start_body.ts';
import {isLanguage} from '../words/words.ts';

export type Theme = 'light' | 'dark';

function read(key: string): string | null {
  try {
    return localStorage.getItem(`touchcal.${key}`);
  } catch {
    return null;
  }
}

function write(key: string, value: string): void {
  try {
    localStorage.setItem(`touchcal.${key}`, value);
  } catch {
    // as above
  }
}

export function firstLanguage(): Language {
  const kept = read('language');
  if (isLanguage(kept)) return kept;
  const asked = navigator.language.toLowerCase().slice(0, 2);
  return isLanguage(asked) ? asked : 'en';
}

export function firstTheme(): Theme {
  const kept = read('theme');
  if (kept === 'light' || kept === 'dark') return kept;
  return matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
}

export const keepLanguage = (language: Language): void => write('language', language);
export const keepTheme = (theme: Theme): void => write('theme', theme);

/** Who signed in here last: the name only, never the secret. */
export const keptName = (): string => read('name') ?? '';
export const keepName = (name: string): void => write('name', name);
/** Secrets are typed with the keys of digits. */
export const keptIsKeypad = (): boolean => read('keypad') === 'yes';
export const keepIsKeypad = (isKeypad: boolean): void => write('keypad', isKeypad ? 'yes' : 'no');

export function keptOperator(): Conditions {
  const operator = read('operator');
  return operator ? {operator} : {};
}
export const keepOperator = ({operator}: Conditions): void => write('operator', operator ?? '');
