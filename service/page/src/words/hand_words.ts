import type {Cell, Status} from '../api/documents.ts';
import {faceName, planeNumber} from '../model/faces.ts';
import type {Language} from '../model/format.ts';
import type {WhereOf} from '../model/places.ts';
import {withButtons} from './fault_words.ts';
import {sayIn, type Say} from './words.ts';

/** What a person with the pendant is to do; the daemon's own words are English and name commands where the page has buttons. */
export function handWords(status: Status, language: Language, cell: Cell | null, whereOf: WhereOf): string {
  const {by_hand, by_hand_step: step, by_hand_plane, by_hand_words} = status;
  const say = sayIn(language);
  if (language === 'en' && by_hand_words) return handButtons(by_hand_words, status, say);
  const name = by_hand_plane === null ? null : faceName(cell, by_hand_plane);
  const plane = by_hand_plane === null ? '–' : name ? `${by_hand_plane} (${name})` : planeNumber(cell, by_hand_plane, say, whereOf);
  if (step === null) return handButtons(by_hand_words ?? '', status, say);
  if (step !== 'touch') return say(`hand_${step}`);
  if (by_hand === 'guided' || by_hand === 'tool') return say(`hand_${by_hand}`, {plane});
  return say(cell?.probe.tips?.length ? 'hand_locate_star' : 'hand_locate', {plane, spot: spotWords(by_hand_words ?? '', language)});
}

/** Where the place is found, the command that began the search is the button that goes around the block. */
export function handButtons(text: string, {by_hand, by_hand_step}: Status, say: Say): string {
  const going = by_hand_step === 'pass' ? text.replace(/\btouchcal locate\b/g, say('quoted', {text: say('handGoAround')})) : text;
  const cancel = by_hand === 'locate' ? going.replace(/\btouchcal stop\b/g, say('quoted', {text: say('cancelLocating')})) : going;
  return withButtons(cancel, say);
}

/** Where on its face a touch of the place is: ", towards plane 2 and its +x edge". */
function spotWords(words: string, language: Language): string {
  const say = sayIn(language);
  const [, spot] = words.match(/^touch plane \d+(, [^:]*):/) ?? [];
  if (!spot) return '';
  if (spot === ', in its middle') return say('spotMiddle');
  const near = spot.replace(/^, towards /, '').split(' and ').map((one) => {
    const [, plane] = one.match(/^plane (\d+)$/) ?? [];
    const [, edge] = one.match(/^its ([+-][xyz]) edge$/) ?? [];
    if (plane) return say('spotPlane', {plane});
    return edge ? say('spotEdge', {edge}) : one;
  });
  return say('spotTowards', {near: near.join(say('spotAnd'))});
}
