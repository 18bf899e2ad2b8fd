import type {Language} from '../model/format.ts';
import type {StickyFault} from '../model/sticky_faults.ts';
import {faultTitle} from './fault_words.ts';
import {sayIn} from './words.ts';

/** A fault's title: a permission that was lost is called by what took it, where that is known. */
export function stickyTitle({code, cause}: Pick<StickyFault, 'code' | 'cause'>, language: Language): string {
  if (code !== 'permission_lost') return faultTitle(language, code);
  const say = sayIn(language);
  switch (cause) {
    case 'estop':
    case 'cell':
    case 'mode':
    case 'power':
    case 'hold':
      return say(`lost_${cause}`);
    default:
      return say('lost_any');
  }
}
