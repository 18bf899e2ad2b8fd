import type {Result, VerdictName} from '../api/documents.ts';
import type {PageState} from './page_state.ts';
import {isActive} from './states.ts';

/** What a run is worth; "none" while it goes on. The run says it: a result may be of the touch before the last. */
export function verdictOf(run_id: string, result: Result, {status, runs}: Pick<PageState, 'status' | 'runs'>): VerdictName {
  if (status?.run_id === run_id) {
    if (isActive(status.state)) return 'none';
    if (status.verdict !== 'none') return status.verdict;
  }
  const told = runs.find(({id}) => id === run_id);
  if (told && told.verdict !== 'none') return told.verdict;
  if (!result.complete) return 'incomplete';
  return result.verdict.accepted ? 'accepted' : 'rejected';
}
