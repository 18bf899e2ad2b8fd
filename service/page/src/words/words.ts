import {fill, type Language} from '../model/format.ts';
import {en} from './en.ts';
import {fr} from './fr.ts';

export type WordKey = keyof typeof en;
/** A dictionary that lacks a word does not compile. */
export type Words = Readonly<Record<WordKey, string>>;

export const kWords: Record<Language, Words> = {en, fr};

/** The words of a key, filled in; `key` itself where the daemon knows a name that the page does not. */
export type Say = (key: WordKey, values?: Record<string, string | number>) => string;

export function sayIn(language: Language): Say {
  return (key, values = {}) => fill(kWords[language][key], values);
}

/** The words of a name that the daemon gave, under a prefix; the name itself when there are none. */
export function sayName(language: Language, prefix: string, name: string): string {
  const words: Record<string, string> = kWords[language];
  return words[`${prefix}${name}`] ?? name;
}
