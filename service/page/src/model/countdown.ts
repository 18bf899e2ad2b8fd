import type {PageState} from './page_state.ts';

/** For how long the key at the cell is still awaited, in whole seconds; null: no key is awaited, or the page did not hear the wait begin. */
export function secondsLeft({status, cell, waitingSince_ms}: Pick<PageState, 'status' | 'cell' | 'waitingSince_ms'>, now_ms: number): number | null {
  if (status?.waiting_for !== 'confirmation' || waitingSince_ms === null || !cell?.confirm_s) return null;
  const waited_ms = Math.max(0, now_ms - waitingSince_ms);  // the page's clock ticks behind what it hears
  return Math.max(0, Math.ceil(cell.confirm_s - waited_ms / 1000));
}
