import type {StateName} from '../api/documents.ts';
import type {WordKey} from '../words/words.ts';
import type {Cause} from './fault_cause.ts';
import type {PageState} from './page_state.ts';
import {isReadyFor, standsInTheWay} from './readiness.ts';
import {mustSignIn} from './session.ts';
import {isLocating, isMotionDisabled, mainAction, type MainAction} from './states.ts';
import {causeToRelease} from './sticky_faults.ts';

/** Why a button does nothing now; what it names is a cause, a condition by the code of the fault table, or a state. */
export interface Reason { key: WordKey; cause?: Cause; code?: string; state?: StateName }

/** What leads on from here: one action at a time. */
export interface MainButton { action: NonNullable<MainAction>; why: Reason | null }

/** `bringsTemperature`: the start would bring the block's temperature. A check and a proof have the recipe of their calibration. */
export function mainButton(state: PageState, bringsTemperature: boolean, needsRecipe = true): MainButton {
  const {status} = state;
  const action = status ? mainAction(status.state, status.retract_due === true) : null;
  return {action: action ?? 'start', why: reason(state, action, bringsTemperature, needsRecipe)};
}

/** A sign-in is all that stands in the way: the button leads there. */
export const leadsToSignIn = (why: Reason | null): boolean => why?.key === 'whySignIn' || why?.key === 'whySessionEnded';

/** Why the page may give no command; null: it may. */
export function reasonOfRole(state: Pick<PageState, 'role' | 'session'>): Reason | null {
  const {role, session} = state;
  if (role === null) return {key: 'whyUnknown'};
  if (role === 'operate') return null;
  if (mustSignIn(state)) return {key: role === 'ended' ? 'whySessionEnded' : 'whySignIn'};
  return {key: role === 'view' && session?.kind === 'user' ? 'whyMayLook' : 'whyWatching'};
}

function reason(state: PageState, action: MainAction, bringsTemperature: boolean, needsRecipe: boolean): Reason | null {
  const {status, link, busy} = state;
  // Without a sign-in the daemon may tell nothing at all.
  if (link === 'refused' && mustSignIn(state)) return reasonOfRole(state);
  if (link === 'connecting') return {key: 'whyUnknown'};
  if (link !== 'live' && link !== 'polling') return {key: 'whyNoLink'};
  const ofRole = reasonOfRole(state);
  if (ofRole || !status) return ofRole ?? {key: 'whyUnknown'};
  if (isLocating(status) && (action === null || action === 'start')) return {key: 'locatingFirst'};
  if (busy !== null && busy === action) return {key: 'whySent'};
  if (action === null) return status.state === 'EXECUTE' ? {key: 'whyRunning'} : {key: 'whyChanging', state: status.state};
  if (action === 'resume') return status.controller_connected ? null : {key: 'noController'};
  const cause = causeToRelease(state.faults);
  if (action === 'clear') return cause === null ? null : {key: 'whyNotReady', cause};
  if (action !== 'start') return null;
  if (isMotionDisabled(status)) return {key: 'whyNotReady', cause: 'estop'};  // sooner than the list of conditions is asked for
  return reasonOfStart(state, bringsTemperature, needsRecipe);
}

function reasonOfStart({recipe, unmet}: PageState, bringsTemperature: boolean, needsRecipe: boolean): Reason | null {
  if (unmet === null) return {key: 'whyUnknown'};
  if (!isReadyFor(unmet, bringsTemperature)) return {key: 'whyNotReady', ...standsInTheWay(unmet, bringsTemperature)};
  return recipe || !needsRecipe ? null : {key: 'whyNoRecipe'};
}
