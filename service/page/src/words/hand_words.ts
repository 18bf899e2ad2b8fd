import type {Status} from '../api/documents.ts';
import type {Language} from '../model/format.ts';
import {sayIn} from './words.ts';

/** What a person with the pendant is to do; the daemon's own words are English. */
export function handWords(status: Status, language: Language): string {
  const {by_hand, by_hand_step: step, by_hand_plane, by_hand_words} = status;
  if (language === 'en' && by_hand_words) return by_hand_words;
  const say = sayIn(language);
  const plane = by_hand_plane ?? '–';
  if (step === null) return by_hand_words ?? '';
  if (step !== 'touch') return say(`hand_${step}`);
  if (by_hand === 'guided') return say('hand_guided', {plane});
  return say('hand_locate', {plane, spot: spotWords(by_hand_words ?? '', language)});
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
