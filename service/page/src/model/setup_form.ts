// From what is typed into a form to a document of schema touchcal/setup/1, and back. The daemon says what is asked and what is wrong.
import type {SetupAnswers, SetupQuestion, SetupRefused, SetupSection} from '../api/setup_documents.ts';

export const kSetupSchema = 'touchcal/setup/1';
/** The daemon takes no larger one. */
export const kSetupBytesMax = 65536;

/** What a person has said so far: nothing is in it that nobody has said. */
export const kNothingSaid: SetupAnswers = {schema: kSetupSchema};

/** Why what is typed is no answer, before the daemon is asked. */
export type TypedProblem = 'empty' | 'noNumber';

const kNumber = /^[+-]?(\d+([.,]\d*)?|[.,]\d+)(e[+-]?\d{1,3})?$/i;
/** Thousands to some and decimals to others: 1,500 is taken as none. */
const kAmbiguous = /^[+-]?[1-9]\d{0,2},\d{3}$/;

export interface TouchedSide { side: string; name: string }

const isObject = (value: unknown): value is Record<string, unknown> => typeof value === 'object' && value !== null && !Array.isArray(value);

export function stepsOf(pointer: string): string[] {
  return pointer.split('/').slice(1).map((step) => step.replace(/~1/g, '/').replace(/~0/g, '~'));
}

/** What stands at a pointer; undefined where nothing does. */
export function valueAt(document: unknown, pointer: string): unknown {
  let here: unknown = document;
  for (const step of stepsOf(pointer)) {
    if (Array.isArray(here)) here = /^\d+$/.test(step) ? here[Number(step)] : undefined;
    else here = isObject(here) && Object.hasOwn(here, step) ? here[step] : undefined;
  }
  return here;
}

/** What a field shows: what was said, else what is taken for it. */
export function shownValue(given: SetupAnswers, answers: SetupAnswers, pointer: string): unknown {
  const said = valueAt(given, pointer);
  if (said !== undefined) return said;
  // What is missing in a part that was said together was taken out; the bodies of an arm follow its file.
  const unit = unitOf(pointer);
  const isOut = unit !== pointer && unit !== '/arm' && valueAt(given, unit) !== undefined;
  return isOut ? null : valueAt(answers, pointer);
}

/** The part of the document that is said together with what stands at a pointer. */
function unitOf(pointer: string): string {
  const steps = stepsOf(pointer);
  return `/${steps.slice(0, kSparse.has(steps[0]!) ? 2 : 1).join('/')}`;
}

/** These hold answers one by one; what is in another part of the document is said together. */
const kSparse = new Set(['block', 'probe', 'limits']);
const kBase = {position_mm: [null, null, null], rotation_deg: [90, 0, 0]};

function placedIn(here: unknown, steps: string[], value: unknown): unknown {
  const [step, ...rest] = steps;
  if (step === undefined) return value;
  if (Array.isArray(here)) {
    const list = [...here];
    list[Number(step)] = placedIn(list[Number(step)], rest, value);
    return list;
  }
  const part = isObject(here) ? here : {};
  return {...part, [step]: placedIn(part[step], rest, value)};
}

/** A part of the document that is said together, as it was said, where that is of the right form. */
function wholePart(given: SetupAnswers, answers: SetupAnswers, unit: string): unknown {
  const said = valueAt(given, unit);
  const taken = valueAt(answers, unit) ?? (unit === '/base' ? kBase : {});
  return typeof said === 'object' && said !== null && Array.isArray(said) === Array.isArray(taken) ? said : taken;
}

/**
 * What was said with this answer in it. An answer that cannot stand alone, as one of a list, brings the others of its part with
 * it as they are taken now (`answers`).
 */
export function withAnswer(given: SetupAnswers, answers: SetupAnswers, pointer: string, value: unknown): SetupAnswers {
  const steps = stepsOf(pointer);
  // null: nothing is said of the base, the tip or the certificate's text at all.
  if (value === null && steps[0] === 'base') return {...given, base: null};
  if (value === null && pointer.endsWith('/tip/radius_mm')) return withAnswer(given, answers, pointer.slice(0, -'/radius_mm'.length), null);
  if (value === null && pointer.startsWith('/block/certificate/')) {
    const others = {...(shownValue(given, answers, '/block/certificate') as object)} as Record<string, unknown>;
    delete others[steps[2]!];
    return withAnswer(given, answers, '/block/certificate', others);
  }
  const radii = valueAt(given, '/arm/body_radii_mm');
  if (pointer === '/arm' && isObject(value) && !('file' in value) && radii !== undefined)  // they were measured
    return {...given, arm: {...value, body_radii_mm: radii}} as SetupAnswers;
  const unit = unitOf(pointer);
  const whole = unit === pointer ? undefined : wholePart(given, answers, unit);
  const brought = whole === undefined ? given : placedIn(given, stepsOf(unit), whole) as SetupAnswers;
  return placedIn(brought, steps, value) as SetupAnswers;
}

/** The list that a question asks the length of, one entry longer or shorter. */
export function withLength(given: SetupAnswers, answers: SetupAnswers, question: SetupQuestion, length: number): SetupAnswers {
  const present = shownValue(given, answers, question.pointer);
  const list: unknown[] = Array.isArray(present) ? present.slice(0, length) : [];
  while (list.length < length && question.new_entry) {
    const taken = new Set(list.map((entry) => valueAt(entry, '/name')));
    const stem = String(question.new_entry['name']).replace(/\d+$/, '');
    let number = list.length + 1;
    while (taken.has(`${stem}${number}`)) ++number;
    list.push({...question.new_entry, name: `${stem}${number}`});
  }
  return withAnswer(given, answers, question.pointer, list);
}

/** A typed number; what is none stays as it was typed, for the daemon and the next load of the page. Empty and - are null. */
export function typedNumber(text: string): number | string | null {
  const bare = text.trim();
  if (bare === '' || bare === '-') return null;
  const value = kNumber.test(bare) && !kAmbiguous.test(bare) ? Number(bare.replace(',', '.')) : NaN;
  return Number.isFinite(value) ? value : bare;
}

export function typedText(text: string, isOptional: boolean): string | null {
  const bare = text.trim();
  return isOptional && (bare === '' || bare === '-') ? null : bare;
}

/** Numbers of which all are left empty are null together. */
export function typedNumbers(texts: string[]): (number | string | null)[] | null {
  const numbers = texts.map(typedNumber);
  return numbers.every((number) => number === null) ? null : numbers;
}

/** As it is typed: a number with a point, and nothing for what is not there. */
export function textOf(value: unknown): string {
  return value === null || value === undefined ? '' : String(value);
}

export function textsOf(value: unknown, count: number): string[] {
  return Array.from({length: count}, (_, i) => textOf(Array.isArray(value) ? value[i] : null));
}

/** The arm as one types it: a shipped name, a path, "urdf FILE BASE TIP" or "dh FILE standard". */
export function armText(arm: unknown): string {
  if (!isObject(arm)) return textOf(arm);
  if (arm['urdf'] !== undefined) return ['urdf', arm['urdf'], arm['base_link'], arm['tip_link']].map(textOf).join(' ').trimEnd();
  if (arm['dh'] !== undefined) return ['dh', arm['dh'], arm['dh_convention']].map(textOf).join(' ').trimEnd();
  return textOf(arm['file']);
}

export function typedArm(text: string): Record<string, unknown> {
  const [kind, file, first, second, ...more] = text.trim().split(/\s+/);
  if (kind === 'urdf' && file && more.length === 0) return {urdf: file, base_link: first ?? '', tip_link: second ?? ''};
  if (kind === 'dh' && file && !second) return first ? {dh: file, dh_convention: first} : {dh: file};
  return {file: text.trim()};
}

/** The sides that are touched with one of them taken, named or left (null). */
export function withSide(sides: unknown, side: string, name: string | null): TouchedSide[] {
  const list = (Array.isArray(sides) ? sides : []).filter(isObject).map((one) => ({side: textOf(one['side']), name: textOf(one['name'])}));
  if (name === null) return list.filter((one) => one.side !== side);
  return list.some((one) => one.side === side) ? list.map((one) => (one.side === side ? {side, name} : one)) : [...list, {side, name}];
}

/** What can be told without the daemon. */
export function typedProblem({kind, optional}: SetupQuestion, value: unknown): TypedProblem | null {
  if (kind === 'text') return !optional && (value === null || value === '') ? 'empty' : null;
  if (kind === 'arm') return armText(value) === '' ? 'empty' : null;
  if (kind !== 'number' && kind !== 'numbers') return null;
  if (value === null || value === undefined) return optional ? null : 'empty';
  const all: unknown[] = kind === 'numbers' && Array.isArray(value) ? value : [value];
  if (all.some((one) => one === null || one === undefined || one === '')) return 'empty';
  return all.every((one) => typeof one === 'number' && Number.isFinite(one)) ? null : 'noNumber';
}

const isWithin = (pointer: string, place: string): boolean => pointer === place || pointer.startsWith(`${place}/`);

/** What is refused, by where a person sees it: beside a question, at the head of a section, or of the whole. */
export interface PlacedRefusals {
  questions: Record<string, SetupRefused[]>;
  sections: Partial<Record<SetupSection, SetupRefused[]>>;
  whole: SetupRefused[];
}

export function placedRefusals(questions: SetupQuestion[], refused: SetupRefused[]): PlacedRefusals {
  const placed: PlacedRefusals = {questions: {}, sections: {}, whole: []};
  for (const one of refused) {
    const isOfFile = one.file !== null;
    const near = isOfFile ? [] : questions.filter(({pointer}) => isWithin(one.pointer, pointer)).sort((a, b) => b.pointer.length - a.pointer.length);
    const above = isOfFile || one.pointer === '' ? undefined : questions.find(({pointer}) => isWithin(pointer, one.pointer));
    if (near[0]) (placed.questions[near[0].pointer] ??= []).push(one);
    else if (above) (placed.sections[above.section] ??= []).push(one);
    else placed.whole.push(one);
  }
  return placed;
}

/** A document that was loaded as a file or kept, if it is one. */
export function setupIn(text: string): SetupAnswers | null {
  if (new TextEncoder().encode(text).length > kSetupBytesMax) return null;
  try {
    const document: unknown = JSON.parse(text);
    return isObject(document) && document['schema'] === kSetupSchema ? document : null;
  } catch {
    return null;
  }
}

/** As the file is downloaded. */
export const setupText = (answers: SetupAnswers): string => `${JSON.stringify(answers, null, 2)}\n`;

/** The command that writes the cell's files from it. */
export function setupCommand(answers: SetupAnswers): string {
  const name = textOf(answers['name']).normalize('NFKD').replace(/[^A-Za-z0-9]+/g, '-').replace(/^-+|-+$/g, '').toLowerCase().slice(0, 40);
  return `touchcal setup ${name || 'cell'} --answers setup.json`;
}

// The draft outlives a reload of the page, in this window only.

const kDraftKey = 'touchcal.setup';

export function keepDraft(given: SetupAnswers): void {
  try {
    sessionStorage.setItem(kDraftKey, JSON.stringify(given));
  } catch {
    // This browser keeps nothing for pages, or is full: the form itself has it.
  }
}

export function keptDraft(): SetupAnswers | null {
  try {
    const text = sessionStorage.getItem(kDraftKey);
    return text === null ? null : setupIn(text);
  } catch {
    return null;
  }
}
