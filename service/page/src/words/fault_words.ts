import type {FaultEntry} from '../api/documents.ts';
import type {Language} from '../model/format.ts';
import {kFaultTitlesFr} from './fault_titles_fr.ts';
import {kFaultsFr} from './faults_fr.ts';
import type {Say, WordKey} from './words.ts';

/** What a person reads of a fault. */
export interface FaultWords { cause: string; robot_action: string; next_step: string }

/** A fault of the daemon's table in the page's language; the daemon's own words where there are no others. */
export function faultWords(language: Language, code: string, table: Record<string, FaultEntry>): FaultWords | null {
  const entry = table[code] ?? null;
  const french = language === 'fr' ? kFaultsFr[code] : undefined;
  return french ?? entry;
}

export const hasTitle = (language: Language, code: string): boolean => language === 'fr' && code in kFaultTitlesFr;

/** "link_lost" as a title. */
export function faultTitle(language: Language, code: string): string {
  return (language === 'fr' ? kFaultTitlesFr[code] : undefined) ?? code.replace(/_/g, ' ');
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
