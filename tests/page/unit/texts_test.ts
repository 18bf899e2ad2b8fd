import assert from 'node:assert/strict';
import {readdirSync, readFileSync} from 'node:fs';
import {join} from 'node:path';
import {before, test} from 'node:test';
import {EventText} from 'page/api/event_text.ts';
import type {Cell} from 'page/api/documents.ts';
import {tokenIn} from 'page/api/token.ts';
import {faceWords} from 'page/model/faces.ts';
import {age, cut, duration, figure, fill, number, roundedUp, time} from 'page/model/format.ts';
import {behindOf} from 'page/api/live.ts';
import {en} from 'page/words/en.ts';
import {withButtons} from 'page/words/fault_words.ts';
import dePack from 'page/words/de.ts';
import frPack from 'page/words/fr.ts';
import {handWords} from 'page/words/hand_words.ts';
import {kTouchFaults} from 'page/model/states.ts';
import {kLanguages, loadLanguage, packOf, sayIn, type Pack, type WordKey} from 'page/words/words.ts';
import {statusWith} from './statuses.ts';

const root = process.env.TOUCHCAL_SOURCE_DIR ?? '.';
const faultTable = readFileSync(join(root, 'service/run/fault_table.cpp'), 'utf8');
const faultNames = [...faultTable.matchAll(/FaultEntry\{\s*FaultCode::k\w+, "(\w+)"/g)].map((match) => match[1]!);

const kTranslations: Record<string, Pack> = {fr: frPack, de: dePack};
before(() => Promise.all(kLanguages.map(loadLanguage)));

test('EventsAreTheSameHoweverTheirTextIsCutInPieces', () => {
  const text = 'retry: 2000\n\nevent: status\nid: a-1\ndata: {"x":\ndata: 1}\n\n: nothing new\n\nevent: reset\nid: a-2\ndata: {}\n\nevent: cut';
  const whole = new EventText().push(text);
  assert.deepEqual(whole, [{event: 'status', id: 'a-1', data: '{"x":\n1}'}, {event: 'reset', id: 'a-2', data: '{}'}]);
  for (let size = 1; size < 20; ++size) {
    const pieces = new EventText();
    const events = [];
    for (let from = 0; from < text.length; from += size) events.push(...pieces.push(text.slice(from, from + size)));
    assert.deepEqual(events, whole, `pieces of ${size}`);
  }
});

test('OnlyAWholeTokenIsTakenFromAFragment', () => {
  assert.equal(tokenIn('#token=ab12'), 'ab12');
  for (const none of ['', '#', '#token=', '#other=1', `#token=${'a'.repeat(600)}`, '#token=a%0ab']) assert.equal(tokenIn(none), null, none);
});

test('WhatIsNotKnownIsNotShownAsANumber', () => {
  for (const unknown of [null, undefined, NaN, Infinity]) {
    assert.equal(number(unknown, 3, 'en'), '–');
    assert.equal(duration(unknown), '–');
  }
  assert.equal(age(null), '–');
  assert.equal(time(null), '–');
  assert.equal(time('soon'), '–');
});

test('NumbersAndTimesReadAsAPersonWritesThem', () => {
  assert.equal(number(0.0547, 3, 'en'), '0.055');
  assert.equal(number(0.0547, 3, 'fr'), '0,055');
  assert.equal(number(-0.000001, 5, 'en'), '0.00000');
  assert.equal(number(-0.00001, 5, 'en'), '-0.00001');
  assert.equal(number(-0, 0, 'en'), '0');
  assert.equal(number(0.0547, 3, 'de'), '0,055');
  assert.equal(figure(0.00007557, 3, 'en'), '< 0.001');
  assert.equal(figure(0.0007557, 3, 'en'), '0.001');
  assert.equal(figure(0, 3, 'en'), '0.000');
  assert.deepEqual([0.0571, 0.06, 0.197, 1.21, 23.1].map((mm) => roundedUp(mm, 'en')), ['0.058', '0.060', '0.20', '1.3', '24']);
  assert.equal(duration(9.4), '9 s');
  assert.equal(duration(75), '1 min 15 s');
  assert.equal(duration(4020), '1 h 07 min');
  assert.equal(age(400), '< 1 s');
  assert.equal(time('2026-11-22T07:26:37.090Z'), '2026-11-22 07:26:37');
  assert.equal(fill('{a} of {b} {c}', {a: 1, b: 2}), '1 of 2 {c}');
  assert.equal(cut('x'.repeat(10000))?.length, 300);
  assert.equal(cut('short'), null);
});

test('EveryLanguageIsAFileOfItsOwnAndIsLoaded', () => {
  const others = kLanguages.filter((language) => language !== 'en');
  assert.deepEqual(others, Object.keys(kTranslations));
  for (const language of others) assert.equal(packOf(language), kTranslations[language], language);
});

test('AllLanguagesFillInTheSameValues', () => {
  const names = (text: string): string[] => [...text.matchAll(/\{(\w+)\}/g)].map((match) => match[1]!).sort();
  for (const {words} of Object.values(kTranslations)) {
    for (const key of Object.keys(en) as WordKey[]) assert.deepEqual(names(words[key]), names(en[key]), key);
  }
});

/** What is written alike in two languages, key by key: a text that was forgotten is not among them. */
const kAlike: Record<string, WordKey[]> = {
  fr: ['title', 'pause', 'met', 'nominal', 'verdict'],
  de: ['title', 'start', 'pause', 'met', 'parameter', 'arm', 'comparedArm', 'temperature', 'personName'],
};

test('NoTextIsLeftInEnglish', () => {
  for (const [language, {words}] of Object.entries(kTranslations)) {
    const alike = (Object.keys(en) as WordKey[]).filter((key) => /[a-z]{2}/i.test(en[key].replace(/\{\w+\}|mm|ppm/g, '')) && words[key] === en[key]);
    assert.deepEqual(alike.sort(), kAlike[language]!.sort(), language);
  }
});

test('TheShippedRecipesAreDescribedAsInTheirFiles', () => {
  const names = ['recipes', 'cells'].flatMap((folder) => readdirSync(join(root, 'config', folder), {recursive: true}).map((name) => join(root, 'config', folder, String(name))));
  const files = names.filter((name) => name.endsWith('.json')).map((name) => JSON.parse(readFileSync(name, 'utf8')))
      .filter(({schema}) => schema?.startsWith('touchcal/recipe/'));
  assert.ok(files.some(({name}) => name === 'two-places'), 'one beside its cell');
  const words: Record<string, string> = en;
  for (const {name, description} of files) assert.equal(words[`recipe_${name}`], description, name);
});

test('EveryFaultOfTheDaemonHasItsWordsInEachLanguage', () => {
  assert.ok(faultNames.length >= 42);
  for (const [language, {faults, titles}] of Object.entries(kTranslations)) {
    assert.deepEqual(Object.keys(faults).sort(), [...faultNames].sort(), language);
    assert.deepEqual(Object.keys(titles).sort(), [...faultNames].sort(), language);
  }
});

test('EveryCommandThatAFaultNamesIsNamedInItsTranslationToo', () => {
  const commands = (text: string): string[] => [...new Set([...text.matchAll(/touchcal ([a-z]+)/g)].map((match) => match[1]!))].sort();
  const entries = faultTable.split(/FaultEntry\{\s*FaultCode::/).slice(1).map((entry) => entry.replace(/"\s*\n\s*"/g, ''));
  for (const entry of entries) {
    const name = entry.match(/^k\w+, "(\w+)"/)?.[1];
    if (!name) continue;
    for (const {faults} of Object.values(kTranslations)) assert.deepEqual(commands(faults[name]!.next_step), commands(entry), name);
    if (commands(entry).includes('skip')) assert.ok(kTouchFaults.has(name), `${name} has its buttons`);
    if (kTouchFaults.has(name)) assert.match(entry, /FaultKind::kHeld/, name);
  }
});

test('CommandsOfTheCommandLineBecomeTheButtonsOfThePage', () => {
  assert.equal(withButtons('touchcal retry, or touchcal stop', sayIn('en')), '“Touch again”, or “STOP”');
  assert.equal(withButtons('touchcal completion', sayIn('en')), 'touchcal completion');
});

test('WhatAHandIsToDoIsWholeInFrench', () => {
  const at = (words: string) => handWords(statusWith({by_hand: 'locate', by_hand_step: 'touch', by_hand_plane: 3, by_hand_words: words}), 'fr', null, () => ({place: null, tip: null}));
  assert.match(at('touch plane 3, towards plane 2 and its +x edge: in manual mode jog'), /^Palpez le plan 3, vers le plan 2 et son bord \+x : en mode manuel/);
  assert.match(at('touch plane 3, in its middle: in manual mode jog'), /^Palpez le plan 3, en son milieu :/);
  assert.match(at('other words'), /^Palpez le plan 3 :/);
});

test('WhatAHandIsToldInEnglishNamesButtonsAndNoCommands', () => {
  const at = (by_hand_step: 'undo' | 'pass', words: string) =>
      handWords(statusWith({by_hand: 'locate', by_hand_step, by_hand_words: words}), 'en', null, () => ({place: null, tip: null}));
  assert.equal(at('undo', 'touchcal undo takes it back; touchcal stop ends this'), '“Undo the last” takes it back; “CANCEL LOCATING” ends this');
  assert.equal(at('pass', 'jog clear, then touchcal locate once more'), 'jog clear, then “GO AROUND” once more');
});

test('AFaceIsCalledByItsNameWhereTheBlocksFileHasOne', () => {
  const cell = {block: {faces: [{plane: 1, name: 'top'}, {plane: 2}]}} as unknown as Cell;
  assert.equal(faceWords(cell, 1, sayIn('en')), 'top');
  assert.equal(faceWords(cell, 2, sayIn('en')), 'Plane 2');
  assert.equal(faceWords(null, 2, sayIn('de')), 'Fläche 2');
});

test('AStreamIsBehindUntilItHasBroughtWhatThePulseTold', () => {
  const behind = behindOf(null, 5, 4, 100);
  assert.deepEqual(behind, {sequence: 5, since_ms: 100});
  assert.equal(behindOf(behind, 9, 4, 900), behind, 'since the first that is missing');
  assert.deepEqual(behindOf(behind, 9, 8, 900), {sequence: 9, since_ms: 900}, 'a stream that comes after is not stalled');
  assert.equal(behindOf(behind, 9, 9, 900), null);
});
