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

export function keptOperator(): Conditions {
  const operator = read('operator');
  return operator ? {operator} : {};
}
export const keepOperator = ({operator}: Conditions): void => write('operator', operator ?? '');
