import type {Language} from '../model/format.ts';
import type {Reason} from '../model/main_button.ts';
import {faultTitle} from './fault_words.ts';
import type {Say} from './words.ts';

/** Why a button does nothing now, as it stands on it. */
export function reasonWords({key, cause, code, state}: Reason, say: Say, language: Language): string {
  const what = cause ? say(`release_${cause}`) : code ? faultTitle(language, code) : '';
  return say(key, {what, state: state ? say(state) : ''});
}
