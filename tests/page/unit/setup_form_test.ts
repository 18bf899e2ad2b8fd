import assert from 'node:assert/strict';
import {test} from 'node:test';
import type {SetupAnswers, SetupQuestion, SetupRefused} from 'page/api/setup_documents.ts';
import {armText, keepDraft, keptDraft, kNothingSaid, kSetupBytesMax, placedRefusals, setupCommand, setupIn, setupText, shownValue, textsOf, typedArm, typedNumber, typedNumbers, typedProblem,
        typedText, valueAt, withAnswer, withLength, withSide} from 'page/model/setup_form.ts';
import {kSetupWords, refusalWords, unitWords, type SetupWordKey} from 'page/words/setup_words.ts';
import {kLanguages} from 'page/words/words.ts';

/** As the daemon has them where nothing is said. */
const kAnswers: SetupAnswers = {
  schema: 'touchcal/setup/1', name: 'cell', arm: {file: 'tx90'}, base: null, park_joints_deg: null,
  block: {size_mm: [150, 150, 150], std_mm: 0.005, serial: null, certificate: {number: 'K 1', issued: '2026-01-01'}, places: [],
          sides: [{side: '-x', name: 'near'}, {side: '-y', name: 'top'}]},
  probe: {ball_radius_mm: 3}, controller: {host: '127.0.0.1', port: 11000},
  keep_out_boxes: [{name: 'table', min_mm: [0, 20, 0], max_mm: [1, 60, 1]}], tools: [],
};

const question = (pointer: string, more: Partial<SetupQuestion> = {}): SetupQuestion => ({
  pointer, section: 'arm', kind: 'number', optional: false, count: null, prompt: pointer, unit: '', explanation: '', choices: [], guessed: false, new_entry: null, ...more,
});

test('OnlyWhatWasSaidIsInTheDocument', () => {
  const one = withAnswer(kNothingSaid, kAnswers, '/block/size_mm', [100, 100, 100]);
  assert.deepEqual(one, {schema: 'touchcal/setup/1', block: {size_mm: [100, 100, 100]}});
  assert.deepEqual(withAnswer(one, kAnswers, '/name', 'press 3'), {...one, name: 'press 3'});
  assert.deepEqual(kNothingSaid, {schema: 'touchcal/setup/1'}, 'nothing is changed in its place');
});

test('AnAnswerThatCannotStandAloneBringsTheOthersOfItsPart', () => {
  assert.deepEqual(withAnswer(kNothingSaid, kAnswers, '/controller/port', 11001)['controller'], {host: '127.0.0.1', port: 11001});
  const box = withAnswer(kNothingSaid, kAnswers, '/keep_out_boxes/0/max_mm', [2, 60, 2]);
  assert.deepEqual(box['keep_out_boxes'], [{name: 'table', min_mm: [0, 20, 0], max_mm: [2, 60, 2]}]);
  assert.deepEqual((kAnswers['keep_out_boxes'] as {max_mm: number[]}[])[0]!.max_mm, [1, 60, 1], 'those that were taken stay');
  assert.deepEqual(withAnswer(kNothingSaid, kAnswers, '/base/position_mm', [-700, 0, 0])['base'], {position_mm: [-700, 0, 0], rotation_deg: [90, 0, 0]});
  assert.deepEqual(withAnswer({...kNothingSaid, keep_out_boxes: 7}, kAnswers, '/keep_out_boxes/0/name', 'b')['keep_out_boxes'],
                   [{name: 'b', min_mm: [0, 20, 0], max_mm: [1, 60, 1]}], 'a loaded file may hold anything');
});

test('WhatIsNotKnownIsNull', () => {
  const placed = withAnswer(kNothingSaid, kAnswers, '/base/rotation_deg', [90, 0, 5]);
  assert.equal(withAnswer(placed, kAnswers, '/base/position_mm', null)['base'], null, 'both are said together');
  assert.deepEqual(valueAt(withAnswer(kNothingSaid, kAnswers, '/block/certificate/number', null), '/block/certificate'), {issued: '2026-01-01'});
  const tools = {...kAnswers, tools: [{name: 'a', position_mm: [0, 0, 1], rotation_deg: [0, 0, 0], tip: null}]};
  const tip = withAnswer(kNothingSaid, tools, '/tools/0/tip/radius_mm', 4);
  assert.deepEqual(valueAt(tip, '/tools/0/tip'), {radius_mm: 4});
  assert.equal(valueAt(withAnswer(tip, tools, '/tools/0/tip/radius_mm', null), '/tools/0/tip'), null);
  assert.equal(valueAt(withAnswer(kNothingSaid, kAnswers, '/park_joints_deg', null), '/park_joints_deg'), null);
});

test('AListGrowsByWhatTheDaemonSaysAndTakesNoNameTwice', () => {
  const tools = question('/tools', {kind: 'count', new_entry: {name: 'tool1', position_mm: [0, 0, 200]}});
  const two = withLength(withLength(kNothingSaid, kAnswers, tools, 1), kAnswers, tools, 2);
  assert.deepEqual((two['tools'] as {name: string}[]).map(({name}) => name), ['tool1', 'tool2']);
  const named = withAnswer(withLength(two, kAnswers, tools, 1), kAnswers, '/tools/0/name', 'tool2');
  assert.deepEqual((withLength(named, kAnswers, tools, 2)['tools'] as {name: string}[]).map(({name}) => name), ['tool2', 'tool3']);
  assert.deepEqual(withLength(two, kAnswers, tools, 0)['tools'], []);
});

test('ANumberIsTakenWithPointOrCommaAndNothingElseIsOne', () => {
  for (const [text, value] of [['0.5', 0.5], [' 0,5 ', 0.5], ['0,125', 0.125], ['1500,25', 1500.25], ['-12', -12], ['2.36e-5', 2.36e-5], ['.5', 0.5], ['1.', 1]] as const) assert.equal(typedNumber(text), value, text);
  for (const none of ['NaN', 'Infinity', '1e999', '0x10', '1 2', '1,2,3', '1,500', '-12,000', '--1', 'e', '١٢', 'null']) {
    const typed = typedNumber(none);
    assert.equal(typed, none, 'it stays as it was typed');
    assert.equal(typedProblem(question('/a'), typed), 'noNumber', none);
  }
  for (const nothing of ['', '  ', '-']) assert.equal(typedNumber(nothing), null);
  assert.equal(typedNumbers(['', '', '']), null);
  assert.deepEqual(typedNumbers(['1', 'x', '']), [1, 'x', null]);
});

test('WhatIsMissingOrNoNumberIsToldBeforeTheDaemonIsAsked', () => {
  assert.equal(typedProblem(question('/a'), null), 'empty');
  assert.equal(typedProblem(question('/a', {optional: true}), null), null);
  assert.equal(typedProblem(question('/a', {kind: 'numbers', count: 3}), [1, null, 3]), 'empty');
  assert.equal(typedProblem(question('/a', {kind: 'numbers', count: 3}), [1, 'x', 3]), 'noNumber');
  assert.equal(typedProblem(question('/a', {kind: 'numbers', count: 3}), [1, 2, 3]), null);
  assert.equal(typedProblem(question('/a', {kind: 'text'}), typedText('  ', false)), 'empty');
  assert.equal(typedProblem(question('/a', {kind: 'arm'}), {file: ''}), 'empty');
  assert.equal(typedProblem(question('/a', {kind: 'sides'}), []), null, 'the daemon says which are too few');
  assert.equal(typedText(' - ', true), null);
});

test('AnArmIsReadAsItIsWritten', () => {
  for (const text of ['tx90', 'arms/my arm.json', 'urdf ur5.urdf base_link tool0', 'dh ur5.csv', 'dh ur5.csv modified']) assert.equal(armText(typedArm(text)), text);
  assert.deepEqual(typedArm('urdf a b c'), {urdf: 'a', base_link: 'b', tip_link: 'c'});
  assert.deepEqual(typedArm('urdf'), {file: 'urdf'});
  assert.equal(armText(null), '');
});

test('ASideIsTakenNamedAndLeft', () => {
  const sides = withSide([{side: '-x', name: 'near'}], '+z', '+z');
  assert.deepEqual(withSide(sides, '+z', 'left'), [{side: '-x', name: 'near'}, {side: '+z', name: 'left'}]);
  assert.deepEqual(withSide(sides, '-x', null), [{side: '+z', name: '+z'}]);
  assert.deepEqual(withSide('none', '-x', 'near'), [{side: '-x', name: 'near'}]);
});

test('ARefusalStandsBesideItsAnswerElseAtItsPartElseOfTheWhole', () => {
  const questions = [question('/name'), question('/block/size_mm', {section: 'block'}), question('/tools', {section: 'tools', kind: 'count'}),
                     question('/tools/0/name', {section: 'tools'})];
  const at = (pointer: string, file: string | null = null): SetupRefused => ({pointer, sentence: 'is wrong', remedy: '', file});
  const placed = placedRefusals(questions, ['/block/size_mm/1', '/tools/0/name', '/tools/0', '/block', '/names', ''].map((pointer) => at(pointer)).concat(at('/name', 'cell.json')));
  const pointers = (list: SetupRefused[] = []): string[] => list.map(({pointer}) => pointer);
  assert.deepEqual(pointers(placed.questions['/block/size_mm']), ['/block/size_mm/1']);
  assert.deepEqual(pointers(placed.questions['/tools/0/name']), ['/tools/0/name']);
  assert.deepEqual(pointers(placed.questions['/tools']), ['/tools/0']);
  assert.deepEqual(pointers(placed.sections.block), ['/block']);
  assert.deepEqual(pointers(placed.whole), ['/names', '', '/name'], 'a place in a file is no answer');
});

test('AFieldShowsWhatWasSaidElseWhatIsTakenForIt', () => {
  assert.equal(shownValue(kNothingSaid, kAnswers, '/name'), 'cell');
  assert.equal(shownValue({...kNothingSaid, name: null}, kAnswers, '/name'), null, 'that nothing is there was said');
  const certified = {...kAnswers, block: {certificate: {number: 'K 1', laboratory: 'L'}}};
  const cleared = withAnswer(kNothingSaid, certified, '/block/certificate/number', null);
  assert.equal(shownValue(cleared, certified, '/block/certificate/number'), null, 'what was cleared stays so before the daemon has answered');
  assert.equal(shownValue(cleared, certified, '/block/certificate/laboratory'), 'L');
  assert.equal(shownValue({...kNothingSaid, arm: {file: 'tx90'}}, {...kAnswers, arm: {file: 'tx90', body_radii_mm: [1]}}, '/arm/body_radii_mm')?.toString(), '1', 'bodies follow the arm');
  const turned = withAnswer(kNothingSaid, {...kAnswers, base: null}, '/base/rotation_deg', [0, 0, 90]);
  assert.deepEqual(valueAt(turned, '/base/position_mm'), [null, null, null], 'a place that nobody gave is none');
  const made = {urdf: 'a.urdf', base_link: 'b', tip_link: 'c', body_radii_mm: [1, 2, 3, 4, 5, 6]};
  const renamed = withAnswer({...kNothingSaid, arm: made}, kAnswers, '/arm', {urdf: 'a.urdf', base_link: 'b', tip_link: 'cc'});
  assert.deepEqual(valueAt(renamed, '/arm/body_radii_mm'), [1, 2, 3, 4, 5, 6], 'measured radii stay');
  assert.equal(valueAt(withAnswer({...kNothingSaid, arm: made}, kAnswers, '/arm', {file: 'tx90'}), '/arm/body_radii_mm'), undefined);
  assert.deepEqual(textsOf(null, 3), ['', '', '']);
  assert.deepEqual(textsOf([1, 'x'], 3), ['1', 'x', '']);
  assert.equal(valueAt({a: {toString: 1}}, '/a/toString'), 1);
  for (const none of ['/constructor', '/__proto__', '/block/size_mm/length']) assert.equal(valueAt(kAnswers, none), undefined, none);
});

test('OnlyAnswersAreLoaded', () => {
  assert.deepEqual(setupIn(setupText(kAnswers)), kAnswers);
  for (const none of ['', '{', '[]', '7', 'null', '{"schema":"touchcal/cell/3"}', `{"schema":"touchcal/setup/1","name":"${'a'.repeat(kSetupBytesMax)}"}`]) assert.equal(setupIn(none), null);
});

test('TheCommandNamesADirectoryThatAShellTakesAsItStands', () => {
  const command = (name: unknown): string => setupCommand({...kAnswers, name});
  assert.equal(command('Press 3'), 'touchcal setup press-3 --answers setup.json');
  assert.equal(command('; rm -rf ~'), 'touchcal setup rm-rf --answers setup.json');
  assert.equal(command('\u05ea\u05d0'), 'touchcal setup cell --answers setup.json');
  assert.equal(command('x'.repeat(200)), `touchcal setup ${'x'.repeat(40)} --answers setup.json`);
});

test('ADraftIsKeptForThisWindowAndABrowserThatKeepsNothingIsNoTrouble', () => {
  assert.equal(keptDraft(), null, 'there is no sessionStorage here');
  keepDraft(kAnswers);
  const kept = new Map<string, string>();
  Object.assign(globalThis, {sessionStorage: {getItem: (key: string) => kept.get(key) ?? null, setItem: (key: string, text: string) => kept.set(key, text)}});
  try {
    assert.equal(keptDraft(), null);
    keepDraft(kAnswers);
    assert.deepEqual(keptDraft(), kAnswers);
    kept.set('touchcal.setup', '[1');
    assert.equal(keptDraft(), null);
  } finally {
    Reflect.deleteProperty(globalThis, 'sessionStorage');
  }
});

test('TheFormsWordsAreInEachLanguageAndFillInTheSameValues', () => {
  const names = (text: string): string[] => [...text.matchAll(/\{(\w+)\}/g)].map((match) => match[1]!).sort();
  const kAlike: Record<string, SetupWordKey[]> = {en: [], fr: [], de: ['sections_block', 'numberOf']};
  for (const language of kLanguages.filter((name) => name !== 'en')) {
    const keys = Object.keys(kSetupWords.en) as SetupWordKey[];
    for (const key of keys) assert.deepEqual(names(kSetupWords[language][key]), names(kSetupWords.en[key]), key);
    assert.deepEqual(keys.filter((key) => kSetupWords[language][key] === kSetupWords.en[key]).sort(), kAlike[language]!.sort(), language);
  }
  assert.equal(unitWords('deg', 'fr'), '°');
  assert.equal(unitWords('mm/s', 'fr'), 'mm/s');
});

test('WhatIsSaidMostOfANumberIsSaidInThePagesLanguage', () => {
  const said = (sentence: string, remedy: string, language: 'en' | 'fr' | 'de', file: string | null = null): string | null => refusalWords({pointer: '/a', sentence, remedy, file}, language);
  assert.equal(said('is 500', 'give 0.1 to 100', 'fr'), 'vaut 500 ; donnez de 0.1 à 100');
  assert.equal(said('is -1', 'give at least 0', 'de'), 'ist -1; geben Sie mindestens 0');
  assert.equal(said('is 70000', 'give a whole number from 1 to 65535', 'de'), 'ist 70000; geben Sie eine ganze Zahl von 1 bis 65535');
  assert.equal(said('is 500', 'give 0.1 to 100', 'en'), null);
  assert.equal(said('is 500', 'give 0.1 to 100', 'fr', 'cell.json'), null);
  assert.equal(said('is {1}', 'give at least 0', 'fr'), 'vaut {1} ; donnez au moins 0', 'what was typed is filled in as it is');
  assert.equal(said('leave the place of the block open', 'touch sides in three directions', 'fr'), null);
});
