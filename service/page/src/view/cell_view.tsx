import {useEffect} from 'preact/hooks';
import type {Place, Recipe} from '../api/documents.ts';
import type {Desk} from '../model/desk.ts';
import {cut, duration, number, time} from '../model/format.ts';
import type {PageState, PlanState} from '../model/page_state.ts';
import {conditions, type Condition} from '../model/readiness.ts';
import {signedIn} from '../model/session.ts';
import {shownTemperature, type Conditions, type VerifyingKind, type WrittenTemperature} from '../model/start_body.ts';
import {isActive, isLocating, mayStart} from '../model/states.ts';
import {faultWords, withButtons} from '../words/fault_words.ts';
import {sayName} from '../words/words.ts';
import {NextCheck} from './checks_view.tsx';
import {Symbol, type Shape} from './symbol.tsx';
import {OuterText, useLanguage, useSay} from './texts.tsx';

interface Props {
  state: PageState;
  desk: Desk;
  conditions: Conditions;
  onConditions: (conditions: Conditions) => void;
}

/** Is the cell ready, and which recipe comes next. */
export function CellView({state, desk, conditions: given, onConditions}: Props) {
  return (
    <div class="cell-view">
      {state.cell && cut(state.cell.name, 80) !== null ? <p class="cell-name"><OuterText text={state.cell.name} /></p> : null}
      {state.countingChecks ? <NextCheck found={state.countingChecks} /> : null}
      <Readiness state={state} />
      <WorkChoice state={state} given={given} onConditions={onConditions} />
      <RecipeChoice state={state} desk={desk} given={given} onConditions={onConditions} />
      <LocateOffer state={state} desk={desk} />
    </div>
  );
}

const kShapes: Record<Condition['state'], Shape> = {met: 'ok', unmet: 'warning', unknown: 'unknown', later: 'later'};

function Readiness({state}: {state: PageState}) {
  const say = useSay();
  const reached = state.link === 'live' || state.link === 'polling';
  const list = conditions(reached ? state.status : null, reached ? state.unmet : null);
  const missing = list.filter((condition) => condition.state === 'unmet').length;
  return (
    <section class="readiness" aria-labelledby="readiness">
      <h2 id="readiness">{say('readiness')}</h2>
      <ul>
        {list.map((condition, i) => <ConditionRow key={`${condition.name}${i}`} condition={condition} state={state} />)}
      </ul>
      <p class={missing > 0 ? 'abnormal' : ''} role="status">
        {missing > 0 ? say('readyNot', {count: missing}) : list.every(({state: s}) => s !== 'unknown') ? say('readyAll') : say('unknown')}
      </p>
    </section>
  );
}

function ConditionRow({condition, state}: {condition: Condition; state: PageState}) {
  const say = useSay();
  const language = useLanguage();
  const words = condition.code ? faultWords(language, condition.code, state.faultTable) : null;
  const reason = condition.detail && language === 'en' ? condition.detail : words?.next_step ?? condition.detail;
  const kind: Record<Condition['state'], string> = {
    met: say('met'), unmet: say('unmet'), unknown: say('unknown'), later: say('later'),
  };
  return (
    <li class={condition.state}>
      <Symbol shape={kShapes[condition.state]} />
      <span class="name">{say(condition.name)}</span>
      <span class="kind">{kind[condition.state]}</span>
      {condition.state === 'unmet' && reason ? <span class="reason"><OuterText text={withButtons(reason, say)} /></span> : null}
    </li>
  );
}

interface Work { kind: 'calibration' | VerifyingKind; tool?: string }
const kWork: Work[] = [{kind: 'calibration'}, {kind: 'check'}, {kind: 'proof'}, {kind: 'qualification'}];

/** What START does. Before the first calibration the page has no room for it on a small screen: `touchcal qualify` needs none. */
function WorkChoice({state, given, onConditions}: {state: PageState; given: Conditions; onConditions: (conditions: Conditions) => void}) {
  const say = useSay();
  const mayProve = Boolean(state.status?.last_accepted_run_id);  // without a number a proof is of a calibration of this daemon
  if (!mayProve && state.countingChecks?.kind !== 'known') return null;
  const choose = ({kind, tool}: Work): void => {
    const {kind: _, tool: __, ...others} = given;
    onConditions(kind === 'calibration' ? others : {...others, kind, ...(tool !== undefined && {tool})});
  };
  const chosen = given.kind ?? 'calibration';
  const tools = (state.cell?.tool_tips ?? []).map((tool): Work => ({kind: 'tool', tool}));
  const works = [...kWork, ...tools].filter(({kind}) => kind !== 'proof' || mayProve);
  const isChosen = ({kind, tool}: Work): boolean => kind === chosen && tool === given.tool;
  return (
    <section class="recipe" aria-labelledby="work">
      <h2 id="work">{say('work')}</h2>
      <div class="choices" role="radiogroup" aria-labelledby="work">
        {works.map((work) => (
          <label key={`${work.kind} ${work.tool ?? ''}`} class={isChosen(work) ? 'choice chosen' : 'choice'}>
            <input type="radio" name="work" value={work.kind} checked={isChosen(work)} onChange={() => choose(work)} />
            <span class="name">{say(`work_${work.kind}`, {tool: work.tool ?? ''})}</span>
          </label>
        ))}
      </div>
      {chosen === 'calibration' ? null : <p>{say(`workWords_${chosen}`)}</p>}
    </section>
  );
}

function RecipeChoice({state, desk, given, onConditions}: {
  state: PageState; desk: Desk; given: Conditions; onConditions: (conditions: Conditions) => void;
}) {
  const say = useSay();
  const {recipes, recipe} = state;
  const chosen = recipes?.recipes.find(({name}) => name === recipe) ?? null;
  if (given.kind) return <section class="recipe"><StartFields state={state} given={given} onConditions={onConditions} /></section>;
  return (
    <section class="recipe" aria-labelledby="recipe">
      <h2 id="recipe">{say('recipe')}</h2>
      <div class="choices" role="radiogroup" aria-labelledby="recipe">
        {recipes?.recipes.map(({name}) => (
          <label key={name} class={name === recipe ? 'choice chosen' : 'choice'}>
            <input type="radio" name="recipe" value={name} checked={name === recipe} onChange={() => desk.chooseRecipe(name)} />
            <span class="name"><OuterText text={name} /></span>
          </label>
        ))}
      </div>
      {chosen && <RecipeFigures recipe={chosen} plan={state.plans[chosen.name]} state={state} desk={desk} />}
      <StartFields state={state} given={given} onConditions={onConditions} />
    </section>
  );
}

function RecipeFigures({recipe, plan, state, desk}: {recipe: Recipe; plan: PlanState | undefined; state: PageState; desk: Desk}) {
  const say = useSay();
  const language = useLanguage();
  const made = plan?.kind === 'made' ? plan.plan : null;
  const isPlanning = plan?.kind === 'planning';
  const canPlan = state.role === 'operate' && !made && !isPlanning && state.status !== null && !isActive(state.status.state);
  useEffect(() => {
    if (canPlan && !plan) void desk.plan(recipe.name);
  }, [canPlan, plan, recipe.name]);
  const refused = plan?.kind === 'refused' ? plan.problem.detail : plan?.kind === 'lost' ? say('noAnswer') : null;
  return (
    <div class="figures">
      <RecipeDescription recipe={recipe} />
      <p>{say('recipeTouches', {fit: recipe.fit_max, held: recipe.held_out})}</p>
      {recipe.places?.length ? <p>{say('recipePlaces', {places: recipe.places.join(', ')})}</p> : null}
      {recipe.tips?.length ? <p>{say('recipeTips', {tips: recipe.tips.join(', ')})}</p> : null}
      <dl>
        <div><dt>{say('duration')}</dt><dd>{isPlanning ? say('planning') : duration(made?.duration_s)}</dd></div>
        <div>
          <dt>{say('accuracy')}</dt>
          <dd>{number(made?.tip_uncertainty.workspace_box_rms_mm, 3, language)} mm</dd>
        </div>
        <div><dt>{say('conditionNumber')}</dt><dd>{number(made?.condition_number, 1, language)}</dd></div>
      </dl>
      {canPlan && <button type="button" onClick={() => void desk.plan(recipe.name)}>{say('plan')}</button>}
      {refused && <p class="abnormal"><OuterText text={say('planRefused', {why: refused})} /></p>}
    </div>
  );
}

/** What a recipe's file says of it: of a shipped one in the page's language, of another as it was written. */
function RecipeDescription({recipe: {name, description}}: {recipe: Recipe}) {
  const language = useLanguage();
  const isShipped = sayName('en', 'recipe_', name) === description;
  return <p>{isShipped ? sayName(language, 'recipe_', name) : <OuterText text={description} isEnglish />}</p>;
}

/** Who answers for the run, and whose hand makes its touches: kept with the result, needed by no start. */
function StartFields({state, given, onConditions}: {state: PageState; given: Conditions; onConditions: (conditions: Conditions) => void}) {
  const say = useSay();
  const takeOperator = (text: string): void => {
    const {operator: _, ...others} = given;
    onConditions(text.trim() ? {...others, operator: text.trim()} : others);
  };
  const takeGuided = (isGuided: boolean): void => {
    const {touching: _, ...others} = given;
    onConditions(isGuided ? {...others, touching: 'guided'} : others);
  };
  const takeTemperature = (written: WrittenTemperature): void => {
    onConditions({...given, temperature: {...given.temperature, ...written}});
  };
  const person = signedIn(state.session);
  const {celsius, std} = shownTemperature(given.temperature, state.cell?.block ?? null);
  return (
    <div class="fields">
      {person === null ? (
        <label>
          <span>{say('operator')}</span>
          <input type="text" maxLength={50} autocomplete="off" placeholder={say('optional')} value={given.operator ?? ''}
                 onInput={(event) => takeOperator(event.currentTarget.value)} />
        </label>
      ) : <p class="signed-operator"><span>{say('operator')}</span><bdi class="one-line" title={person}>{person}</bdi></p>}
      <label>
        <span class={state.cell && !celsius.trim() ? 'abnormal' : ''}>{say('temperature')}</span>
        <input type="text" inputMode="decimal" maxLength={12} autocomplete="off" placeholder={say('unknown')} value={celsius}
               onInput={(event) => takeTemperature({celsius: event.currentTarget.value})} />
      </label>
      <label>
        <span>{say('temperatureStd')}</span>
        <input type="text" inputMode="decimal" maxLength={12} autocomplete="off" placeholder={say('unknown')} value={std}
               onInput={(event) => takeTemperature({std: event.currentTarget.value})} />
      </label>
      <label>
        <span>{say('armMoving')}</span>
        <input type="text" inputMode="decimal" maxLength={6} autocomplete="off" placeholder={say('unknown')} value={given.movingMin ?? ''}
               onInput={(event) => onConditions({...given, movingMin: event.currentTarget.value})} />
      </label>
      {state.cell?.place !== undefined && !given.kind && (
        <label class="check">
          <input type="checkbox" checked={given.touching === 'guided'} onChange={(event) => takeGuided(event.currentTarget.checked)} />
          <span>{say('guided')}</span>
        </label>
      )}
    </div>
  );
}

function LocateOffer({state, desk}: {state: PageState; desk: Desk}) {
  const say = useSay();
  const {status, role, unmet} = state;
  if (!status || isLocating(status) || !mayStart(status.state) || role !== 'operate' || unmet === null) return null;
  return (
    <section class="locate" aria-labelledby="locate">
      <h2 id="locate">{say('locate')}</h2>
      <p>{state.cell?.place ? <PlaceFound place={state.cell.place} /> : say('locateWords')}</p>
      <button type="button" onClick={() => void desk.command('locate')}>{say('locateStart')}</button>
    </section>
  );
}

/** Where the block was found, against the cell's file. */
function PlaceFound({place}: {place: Place}) {
  const say = useSay();
  const language = useLanguage();
  const numbers = (values: number[], digits: number): string => values.map((value) => number(value, digits, language)).join(' / ');
  return <>{say('located', {at: time(place.located_at), shift: numbers(place.shift_mm, 2), turn: numbers(place.turn_deg, 3)})}</>;
}
