import {useMemo} from 'preact/hooks';
import type {Desk} from '../model/desk.ts';
import {planeNumber} from '../model/faces.ts';
import {number, type Language} from '../model/format.ts';
import type {PageState} from '../model/page_state.ts';
import {numberingOf, whereByNumber} from '../model/places.ts';
import {sayName, type Say} from '../words/words.ts';
import {Curve, type Line} from './curve.tsx';
import {Residuals} from './residuals.tsx';
import {SceneFrame} from './scene_frame.tsx';
import {OuterText, useLanguage, useSay} from './texts.tsx';

/** The run as it goes on. */
export function LiveView({state, desk}: {state: PageState; desk: Desk}) {
  const {status, cell} = state;
  const result = status?.run_id ? state.results[status.run_id] : undefined;
  return (
    <div class="live-view">
      <div class="scene-side">
        <SceneFrame state={state} store={desk.store} />
        {result && cell ? <Residuals result={result} cell={cell} /> : null}
      </div>
      <div class="figures-side">
        <Figures state={state} />
        <Curves state={state} />
      </div>
    </div>
  );
}

function Figures({state}: {state: PageState}) {
  const say = useSay();
  const language = useLanguage();
  const {status} = state;
  if (!status) return null;
  return (
    <dl class="figures">
      <div><dt>{say('rank')}</dt><dd>{status.identifiable_count ?? '–'}</dd></div>
      <div><dt>{say('conditionNumber')}</dt><dd>{number(status.condition_number, 1, language)}</dd></div>
      <div><dt>{say('accuracy')}</dt><dd>{number(status.predicted_tip_rms_mm, 3, language)} mm</dd></div>
      <div><dt>{say('drift')}</dt><dd>{number(status.reference_drift_mm, 3, language)} mm</dd></div>
      <div class={status.probe === 'fault' ? 'abnormal' : ''}>
        <dt>{say('probe')}</dt><dd>{status.probe ? sayName(language, 'probe_', status.probe) : say('unknown')}</dd>
      </div>
      {status.retract_due ? <div class="wide abnormal"><dt>{say('arm')}</dt><dd>{say('armAtFace')}</dd></div> : null}
      {status.more_would_bring
        ? <div class="wide"><dt>{say('moreWouldBring')}</dt><dd><OuterText text={moreText(status.more_would_bring, state, say, language)} /></dd></div>
        : null}
    </dl>
  );
}

/** The daemon's sentence in the page's language; as it is when it has another form. */
function moreText(sentence: string, {status, cell, recipes}: PageState, say: Say, language: Language): string {
  const [, count, plane, from, to] = sentence.match(/^(\d+) more on plane (\d+): ([\d.]+) to ([\d.]+) mm$/) ?? [];
  const mm = (text: string): string => number(Number(text), text.split('.')[1]?.length ?? 0, language);
  if (!count || !plane || !from || !to) return sentence;
  const whereOf = whereByNumber(cell, numberingOf(recipes, status?.recipe ?? null));
  return say('moreTouches', {count, plane: planeNumber(cell, Number(plane), say, whereOf), from: mm(from), to: mm(to)});
}

function Curves({state}: {state: PageState}) {
  const say = useSay();
  const language = useLanguage();
  const {points} = state.series;
  const x = useMemo(() => points.map(({touch}) => touch), [points]);
  const condition: Line[] =
      useMemo(() => [{name: say('conditionNumber'), values: points.map((point) => point.condition_number)}], [points, language]);
  const accuracy: Line[] =
      useMemo(() => [{name: say('accuracy'), values: points.map((point) => point.predicted_tip_rms_mm)}], [points, language]);
  if (points.filter((point) => point.condition_number !== null).length < 2) return <p class="empty">{say('noCurve')}</p>;
  return (
    <>
      <h2>{say('curveCondition')}</h2>
      <Curve title={say('curveCondition')} x={x} xName={say('touchColumn')} lines={condition} height={104} isLog write={(value) => number(value, 0, language)} />
      <h2>{say('curveAccuracy')}</h2>
      <Curve title={say('curveAccuracy')} x={x} xName={say('touchColumn')} lines={accuracy} height={104} isLog write={(value) => number(value, 2, language)} />
    </>
  );
}
