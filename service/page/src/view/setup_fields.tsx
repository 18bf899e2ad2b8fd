import type {ComponentChildren} from 'preact';
import {useState} from 'preact/hooks';
import type {SetupQuestion, SetupRefused} from '../api/setup_documents.ts';
import {fill, type Language} from '../model/format.ts';
import {armText, textOf, textsOf, typedArm, typedNumber, typedNumbers, typedProblem, typedText, withSide} from '../model/setup_form.ts';
import {kSetupWords, refusalWords, unitWords, type SetupWordKey} from '../words/setup_words.ts';
import {OuterText, useLanguage} from './texts.tsx';

export type SetupSay = (key: SetupWordKey, values?: Record<string, string | number>) => string;
export const saySetupIn = (language: Language): SetupSay => (key, values = {}) => fill(kSetupWords[language][key], values);
export const useSetupSay = (): SetupSay => saySetupIn(useLanguage());

export interface FieldProps {
  question: SetupQuestion;
  value: unknown;                 // as it was said, else as it is assumed
  isSaid: boolean;
  refused: SetupRefused[];
  onValue: (value: unknown) => void;
  onLength: (length: number) => void;
}

export const fieldId = (pointer: string): string => `setup${pointer.replace(/[^A-Za-z0-9]+/g, '-')}`;

/** The daemon's sentences are English; the page has those that are said most in its other languages. */
export function Refusals({refused, id}: {refused: SetupRefused[]; id?: string}) {
  const language = useLanguage();
  if (refused.length === 0) return null;
  return (
    <ul class="setup-errors" id={id}>
      {refused.map((one) => {
        const {pointer, sentence, remedy, file} = one;
        const words = refusalWords(one, language);
        const told = `${file ? `${file}: ${pointer}: ` : ''}${sentence}${remedy ? `; ${remedy}` : ''}`;
        return <li key={`${pointer} ${sentence}`}><OuterText isEnglish={words === null} text={words ?? told} /></li>;
      })}
    </ul>
  );
}

/** One question with what is said of it: its unit, whether it is assumed, why it is refused. */
export function SetupField(props: FieldProps) {
  const {question: {pointer, prompt, unit, explanation, optional, guessed}, value, isSaid, refused} = props;
  const say = useSetupSay();
  const language = useLanguage();
  const id = fieldId(pointer);
  const problem = isSaid ? typedProblem(props.question, value) : null;
  const isWrong = problem !== null || refused.length > 0;
  const described = `${explanation ? `${id}-hint ` : ''}${isWrong ? `${id}-error` : ''}`.trim();
  return (
    <div class={isWrong ? 'setup-field wrong' : 'setup-field'} data-pointer={pointer}>
      <p class="setup-prompt">
        <label id={`${id}-label`} for={id}>{prompt}</label>
        {unit ? <span class="unit"> {unitWords(unit, language)}</span> : null}
        {guessed && !isSaid ? <>{' '}<span class="guessed">{say('guessed')}</span></> : null}
        {optional ? <span class="unit"> ({say('optional')})</span> : null}
      </p>
      <Entry {...props} id={id} described={described || undefined} isWrong={isWrong} />
      {problem ? <p class="setup-errors" id={`${id}-error`}>{say(problem)}</p> : <Refusals refused={refused} id={`${id}-error`} />}
      {explanation ? <p class="setup-hint" id={`${id}-hint`}>{explanation}</p> : null}
    </div>
  );
}

interface EntryProps extends FieldProps { id: string; described: string | undefined; isWrong: boolean }

function Entry(props: EntryProps) {
  const {question, value, onValue, id, described, isWrong} = props;
  const common = {id, describedBy: described, isWrong};
  switch (question.kind) {
    case 'yes_no':
      return <input type="checkbox" id={id} aria-describedby={described} checked={value === true} onChange={(event) => onValue(event.currentTarget.checked)} />;
    case 'number':
      return <TypedEntry {...common} text={textOf(value)} isSame={(text) => typedNumber(text) === value} isNumber onText={(text) => onValue(typedNumber(text))} />;
    case 'numbers':
      return <Numbers {...props} />;
    case 'count':
      return <Length {...props} />;
    case 'sides':
      return <Sides {...props} />;
    case 'arm':
      return <ArmChoice {...props} />;
    case 'text':
      if (question.choices.length > 0) {
        return (
          <select id={id} aria-describedby={described} value={textOf(value)} onChange={(event) => onValue(event.currentTarget.value)}>
            {question.choices.map((choice) => <option key={choice} value={choice}>{choice}</option>)}
          </select>
        );
      }
      return <TypedEntry {...common} text={textOf(value)} isSame={(text) => typedText(text, question.optional) === value} onText={(text) => onValue(typedText(text, question.optional))} />;
  }
}

interface TypedProps {
  id: string;
  text: string;
  label?: string;
  describedBy: string | undefined;
  isWrong: boolean;
  isNumber?: boolean;
  isSame: (text: string) => boolean;  // what stands there means what is known
  onText: (text: string) => void;
}

/** What is typed stays as it is typed: "1." is no other text than "1" while somebody goes on. */
function TypedEntry({id, text, label, describedBy, isWrong, isNumber, isSame, onText}: TypedProps) {
  const [typed, setTyped] = useState(text);
  const shown = isSame(typed) ? typed : text;  // it was changed elsewhere, as by a file that was loaded
  return (
    <input type="text" id={id} dir={isNumber ? 'ltr' : 'auto'} value={shown} maxLength={isNumber ? 30 : 1000} inputMode={isNumber ? 'decimal' : 'text'} autocomplete="off" spellcheck={false}
           aria-label={label} aria-describedby={describedBy} aria-invalid={isWrong}
           onInput={(event) => {
             setTyped(event.currentTarget.value);
             onText(event.currentTarget.value);
           }} />
  );
}

function Numbers({question, value, onValue, id, described, isWrong}: EntryProps) {
  const say = useSetupSay();
  const count = question.count ?? 3;
  const texts = textsOf(value, count);
  const nameOf = (i: number): string => (count === 3 ? 'xyz'[i]! : question.pointer === '/park_joints_deg' ? say('joint', {number: i + 1}) : String(i + 1));
  return (
    <div class="setup-numbers" role="group" aria-labelledby={`${id}-label`}>
      {texts.map((text, i) => (
        <TypedEntry key={i} id={i === 0 ? id : `${id}-${i}`} label={say('numberOf', {prompt: question.prompt, name: nameOf(i)})} text={text} describedBy={described} isWrong={isWrong} isNumber
                    isSame={(typed) => textOf(typedNumber(typed)) === text} onText={(typed) => onValue(typedNumbers(texts.map((other, j) => (j === i ? typed : other))))} />
      ))}
    </div>
  );
}

function Length({question, value, onLength, id, described}: EntryProps) {
  const say = useSetupSay();
  const length = Array.isArray(value) ? value.length : 0;
  const named = (key: SetupWordKey): string => say('numberOf', {prompt: question.prompt, name: say(key)});
  return (
    <div class="setup-length">
      <span>{say('entries', {count: length})}</span>
      <button type="button" id={id} aria-label={named('entryAdd')} aria-describedby={described} onClick={() => onLength(length + 1)}>{say('entryAdd')}</button>
      <button type="button" aria-label={named('entryRemove')} disabled={length === 0} onClick={() => onLength(length - 1)}>{say('entryRemove')}</button>
    </div>
  );
}

function Sides({question, value, onValue, id, described, isWrong}: EntryProps) {
  const say = useSetupSay();
  const sides = withSide(value, '', null);  // as it is
  return (
    <div class="setup-sides" role="group" aria-labelledby={`${id}-label`}>
      {question.choices.map((side, i) => {
        const touched = sides.find((one) => one.side === side);
        return (
          <div key={side} class="setup-side">
            <label class="check">
              <input type="checkbox" id={i === 0 ? id : `${id}-${i}`} checked={touched !== undefined} aria-describedby={described}
                     onChange={(event) => onValue(withSide(sides, side, event.currentTarget.checked ? side : null))} />
              <span dir="ltr">{side}<span class="visually-hidden"> {say('touched')}</span></span>
            </label>
            {touched ? <TypedEntry id={`${id}-name-${i}`} label={say('sideName', {side})} text={touched.name} describedBy={described} isWrong={isWrong}
                                   isSame={(text) => text.trim() === touched.name} onText={(text) => onValue(withSide(sides, side, text.trim()))} /> : null}
          </div>
        );
      })}
    </div>
  );
}

const kOther = ' ';  // no arm's name

function ArmChoice({question, value, onValue, id, described, isWrong}: EntryProps) {
  const say = useSetupSay();
  const text = armText(value);
  // Who types a name that begins with a shipped one has not chosen that.
  const [isTyped, setTyped] = useState(false);
  const isShipped = !isTyped && question.choices.includes(text);
  const choose = (choice: string): void => {
    setTyped(choice === kOther);
    onValue({file: choice === kOther ? '' : choice});
  };
  return (
    <div class="setup-arm">
      <select id={id} value={isShipped ? text : kOther} aria-describedby={described} onChange={(event) => choose(event.currentTarget.value)}>
        {question.choices.map((choice) => <option key={choice} value={choice}>{choice}</option>)}
        <option value={kOther}>{say('armOther')}</option>
      </select>
      {isShipped ? null : <TypedEntry id={`${id}-other`} label={say('armOtherName')} text={text} describedBy={described} isWrong={isWrong}
                                      isSame={(typed) => armText(typedArm(typed)) === text} onText={(typed) => {
                                        setTyped(true);
                                        onValue(typedArm(typed));
                                      }} />}
    </div>
  );
}

/** A part of the form with its heading. */
export function SetupSectionFrame({title, refused, children}: {title: string; refused: SetupRefused[]; children: ComponentChildren}) {
  return (
    <fieldset>
      <legend>{title}</legend>
      <Refusals refused={refused} />
      {children}
    </fieldset>
  );
}
