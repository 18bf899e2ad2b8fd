import {fill, type Language} from '../model/format.ts';
import {en} from './en.ts';

export type WordKey = keyof typeof en;
/** A dictionary that lacks a word does not compile. */
export type Words = Readonly<Record<WordKey, string>>;

/** What a person reads of a fault. */
export interface FaultWords { cause: string; robot_action: string; next_step: string }

/** All that a language is: the page's words, and those of the daemon's faults by code (English: the daemon's own). */
export interface Pack {
  words: Words;
  titles: Readonly<Record<string, string>>;
  faults: Readonly<Record<string, FaultWords>>;
}

/** What a language is called in itself: for the switch, before its words are here. */
export const kLanguageNames: Readonly<Record<Language, string>> = {en: 'English', fr: 'Français', de: 'Deutsch'};
export const kLanguages = Object.keys(kLanguageNames) as Language[];
export const isLanguage = (name: string | null): name is Language => name !== null && name in kLanguageNames;

const kEnglish: Pack = {words: en, titles: {}, faults: {}};
const loaded: Partial<Record<Language, Pack>> = {en: kEnglish};

const kFiles: Record<Language, () => Promise<Pack>> = {
  en: () => Promise.resolve(kEnglish),
  fr: () => import('./fr.ts').then((file) => file.default),
  de: () => import('./de.ts').then((file) => file.default),
};

/** Brings the words of a language, once. Until then, and where they cannot be had, the page speaks English. */
export async function loadLanguage(language: Language): Promise<void> {
  loaded[language] ??= await kFiles[language]();
}

export const packOf = (language: Language): Pack => loaded[language] ?? kEnglish;

/** The words of a key, filled in; `key` itself where the daemon knows a name that the page does not. */
export type Say = (key: WordKey, values?: Record<string, string | number>) => string;

export function sayIn(language: Language): Say {
  return (key, values = {}) => fill(packOf(language).words[key], values);
}

/** The words of a name that the daemon gave, under a prefix; the name itself when there are none. */
export function sayName(language: Language, prefix: string, name: string): string {
  const words: Record<string, string> = packOf(language).words;
  return words[`${prefix}${name}`] ?? name;
}
