import type {FaultEntry} from '../api/documents.ts';
import type {Language} from '../model/format.ts';
import {packOf, type FaultWords, type Say, type WordKey} from './words.ts';

/** A fault of the daemon's table in the page's language; the daemon's own words where there are no others. */
export function faultWords(language: Language, code: string, table: Record<string, FaultEntry>): FaultWords | null {
  return packOf(language).faults[code] ?? table[code] ?? null;
}

export const hasTitle = (language: Language, code: string): boolean => code in packOf(language).titles;

/** "link_lost" as a title. */
export function faultTitle(language: Language, code: string): string {
  return packOf(language).titles[code] ?? code.replace(/_/g, ' ');
}

const kButtons: Record<string, WordKey> = {
  retry: 'retry', skip: 'skip', stop: 'stopMotion', clear: 'clear', reset: 'reset', resume: 'resume', pause: 'pause',
  acknowledge: 'acknowledge', locate: 'locateStart', take: 'take', undo: 'undo', start: 'start', abort: 'abort',
};

/** A command as its button names it. */
export function commandWords(command: string, say: Say): string {
  const key = kButtons[command];
  return key ? say(key) : command;
}

/** The daemon names commands of the command line; this page has buttons for them. */
export function withButtons(text: string, say: Say): string {
  return text.replace(/\btouchcal ([a-z]+)\b/g, (whole, command: string) => {
    const key = kButtons[command];
    return key ? say('quoted', {text: say(key)}) : whole;
  });
}
