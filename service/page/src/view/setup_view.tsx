import {useEffect, useMemo, useRef, useState} from 'preact/hooks';
import {saveBlob} from '../api/download.ts';
import type {SetupAnswers, SetupCheck, SetupSection} from '../api/setup_documents.ts';
import type {Desk} from '../model/desk.ts';
import type {PageState} from '../model/page_state.ts';
import {isEngineer} from '../model/session.ts';
import {SetupDesk, type SetupState} from '../model/setup_desk.ts';
import {keepDraft, keptDraft, kNothingSaid, placedRefusals, setupCommand, setupIn, setupText, shownValue, textOf, typedProblem, valueAt, withAnswer, withLength} from '../model/setup_form.ts';
import {sectionKey} from '../words/setup_words.ts';
import {Refusals, SetupField, SetupSectionFrame, useSetupSay} from './setup_fields.tsx';
import {Symbol} from './symbol.tsx';
import {OuterText, useLanguage} from './texts.tsx';

export interface SetupProps { state: PageState; desk: Desk }

/** A new cell from answers: the daemon says what is asked, what is wrong and how the cell looks; the page writes nothing but a file of answers. */
export function SetupView({state, desk}: SetupProps) {
  const say = useSetupSay();
  const title = useRef<HTMLHeadingElement>(null);
  useEffect(() => title.current?.focus(), []);
  return (
    <section class="setup-view" aria-labelledby="setup">
      <div class="account-head">
        <h2 id="setup" ref={title} tabIndex={-1}>{say('title')}</h2>
        <button type="button" onClick={() => desk.show('cell')}>{say('close')}</button>
      </div>
      {isEngineer(state) ? <SetupForm desk={desk} /> : <p role="status"><Symbol shape="warning" /> {say('forEngineer')}</p>}
    </section>
  );
}

function SetupForm({desk}: {desk: Desk}) {
  const say = useSetupSay();
  const language = useLanguage();
  const [given, setGiven] = useState<SetupAnswers>(() => keptDraft() ?? kNothingSaid);
  const [check, setCheck] = useState<SetupCheck | null>(null);
  const [heard, setHeard] = useState<SetupState>({kind: 'asking'});
  const asking = useMemo(() => new SetupDesk(() => desk.pass.token, (state, told) => {
    setHeard(state);
    if (told) setCheck(told);
    if (state.kind === 'refused' && (state.status === 401 || state.status === 403)) void desk.pass.refused(state.status);
  }), [desk]);
  useEffect(() => () => asking.close(), [asking]);
  useEffect(() => asking.check(given, language, 0), [asking, language]);
  const take = (now: SetupAnswers): void => {
    setGiven(now);
    keepDraft(now);
    asking.check(now, language);
  };
  return (
    <>
      <p>{say('intro')}</p>
      <DraftControls onDraft={take} />
      <div class="setup">
        {check ? <Questions given={given} check={check} onGiven={take} /> : <span />}
        <Outcome given={given} check={check} heard={heard} />
      </div>
    </>
  );
}

const kSections: SetupSection[] = ['arm', 'block', 'probe', 'space', 'limits', 'tools'];

function Questions({given, check, onGiven}: {given: SetupAnswers; check: SetupCheck; onGiven: (given: SetupAnswers) => void}) {
  const say = useSetupSay();
  const {questions, answers, refused} = check;
  const placed = placedRefusals(questions, refused);
  return (
    <form class="setup-form" onSubmit={(event) => event.preventDefault()}>
      {kSections.map((section) => (
        <SetupSectionFrame key={section} title={say(sectionKey(section))} refused={placed.sections[section] ?? []}>
          {questions.filter((question) => question.section === section).map((question) => (
            <SetupField key={question.pointer} question={question} value={shownValue(given, answers, question.pointer)}
                        isSaid={valueAt(given, question.pointer) !== undefined} refused={placed.questions[question.pointer] ?? []}
                        onValue={(value) => onGiven(withAnswer(given, answers, question.pointer, value))}
                        onLength={(length) => onGiven(withLength(given, answers, question, length))} />
          ))}
        </SetupSectionFrame>
      ))}
    </form>
  );
}

/** Loads a file of answers, and begins anew: asked twice, since nothing brings them back. */
function DraftControls({onDraft}: {onDraft: (given: SetupAnswers) => void}) {
  const say = useSetupSay();
  const [told, setTold] = useState<{isLoaded: boolean; name: string} | null>(null);
  const [isAsked, setAsked] = useState(false);
  const load = async (file: File | undefined): Promise<void> => {
    if (!file) return;
    const answers = setupIn(await file.text());
    setTold({isLoaded: answers !== null, name: answers ? textOf(answers['name']) || 'cell' : ''});
    if (answers) onDraft(answers);
  };
  return (
    <div class="setup-draft">
      <label>
        <span>{say('load')}</span>{' '}
        <input type="file" accept=".json,application/json" onChange={(event) => {
          const {currentTarget} = event;
          void load(currentTarget.files?.[0]).finally(() => {
            currentTarget.value = '';  // the same file once more is a change, too
          });
        }} />
      </label>
      {isAsked ? (
        <div class="card warning" role="alertdialog" aria-labelledby="anew">
          <p id="anew">{say('anewAsk')}</p>
          <div class="actions">
            <button type="button" onClick={() => {
              setAsked(false);
              setTold(null);
              onDraft(kNothingSaid);
            }}>{say('anewYes')}</button>
            <button type="button" onClick={() => setAsked(false)}>{say('cancel')}</button>
          </div>
        </div>
      ) : <button type="button" onClick={() => setAsked(true)}>{say('anew')}…</button>}
      <p role="status" class={told && !told.isLoaded ? 'abnormal' : ''}>{told ? <OuterText text={say(told.isLoaded ? 'loaded' : 'loadNot', {name: told.name})} /> : null}</p>
    </div>
  );
}

/** The scene, what stands in the way, and the file. */
function Outcome({given, check, heard}: {given: SetupAnswers; check: SetupCheck | null; heard: SetupState}) {
  const say = useSetupSay();
  const isOld = heard.kind !== 'told';
  const typedWrong = check ? check.questions.filter((question) => {
    const said = valueAt(given, question.pointer);
    return said !== undefined && typedProblem(question, said) !== null;
  }).length : 0;
  const wrong = Math.max(check?.refused.length ?? 0, typedWrong);
  const mayDownload = check !== null && !isOld && wrong === 0;
  return (
    <aside class="setup-outcome">
      {check?.scene_svg ? <Scene svg={check.scene_svg} isOld={isOld} /> : null}
      {check && check.scene_svg === null ? <p>{say('sceneNone')}</p> : null}
      <div role="status">
        <Heard check={check} heard={heard} wrong={wrong} />
      </div>
      {check ? <Doubts check={check} /> : null}
      <button type="button" disabled={!mayDownload} onClick={() => {
        if (check) saveBlob(new Blob([setupText(check.answers)], {type: 'application/json'}), 'setup.json');
      }}>{say('download')}</button>
      {mayDownload && check ? <p>{say('command')} <code>{setupCommand(check.answers)}</code></p> : null}
      {wrong > 0 ? <p>{say('downloadNot')}</p> : null}
      {check && check.files.length > 0 ? <Files check={check} /> : null}
    </aside>
  );
}

function Scene({svg, isOld}: {svg: string; isOld: boolean}) {
  const say = useSetupSay();
  return (
    <figure class={isOld ? 'setup-scene old' : 'setup-scene'}>
      {/* As a picture: nothing in it can act in the page. */}
      <img src={`data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`} alt={say('scene')} />
      <figcaption>{isOld ? say('sceneOld') : say('sceneWords')}</figcaption>
    </figure>
  );
}

function Heard({check, heard, wrong}: {check: SetupCheck | null; heard: SetupState; wrong: number}) {
  const say = useSetupSay();
  switch (heard.kind) {
    case 'asking':
    case 'busy':
      return <p>{say(heard.kind)}</p>;
    case 'lost':
      return <p class="abnormal"><Symbol shape="warning" /> {say('lost')}</p>;
    case 'refused':
      return <p class="abnormal"><Symbol shape="warning" /> <OuterText isEnglish text={heard.detail} /></p>;
    case 'told':
      if (wrong > 0) return <p class="abnormal"><Symbol shape="warning" /> {say('passesNot', {count: wrong})}</p>;
      return <p><Symbol shape={check?.passes ? 'ok' : 'unknown'} /> {say(check?.passes ? 'passes' : 'passesUnknown')}</p>;
  }
}

function Doubts({check: {questions, refused, remarks}}: {check: SetupCheck}) {
  const say = useSetupSay();
  const {whole} = placedRefusals(questions, refused);
  const guessed = questions.filter((question) => question.guessed).length;
  return (
    <>
      {whole.length > 0 ? <><h3>{say('whole')}</h3><Refusals refused={whole} /></> : null}
      {remarks.length > 0 ? <><h3>{say('remarks')}</h3><ul>{remarks.map((remark) => <li key={remark}><OuterText isEnglish text={remark} /></li>)}</ul></> : null}
      {guessed > 0 ? <p>{say('guessedCount', {count: guessed})}</p> : null}
    </>
  );
}

function Files({check}: {check: SetupCheck}) {
  const say = useSetupSay();
  return (
    <details class="setup-files">
      <summary>{say('files')}</summary>
      {check.files.map(({name, text}) => (
        <details key={name}>
          <summary>{name}</summary>
          <pre class="scroll" tabIndex={0} role="region" aria-label={name} dir="ltr">{text}</pre>
        </details>
      ))}
    </details>
  );
}
