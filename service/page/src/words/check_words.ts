import type {CheckRow, Checks} from '../api/documents.ts';
import {number, time, type Language} from '../model/format.ts';
import type {Beyond} from '../model/check_lines.ts';
import type {Say, WordKey} from './words.ts';

/** When the next check is due; null where there is no rule, or the calibration was replaced. */
export function nextCheckWords({every_days, due_at, overdue}: Checks, say: Say): string | null {
  if (every_days === null) return null;
  if (due_at === null) return say('checksDueUnknown');
  return say(overdue ? 'checksOverdue' : 'checksDue', {date: time(due_at)});
}

/** What a chart is of. */
export function quantityWords(quantity: string, say: Say): string {
  const joint = quantity.match(/^joint_(\d)$/)?.[1];
  if (joint) return say('verifiedJoint', {joint});
  if (quantity === 'growth') return say('verifiedGrowth');
  return quantity === 'residual' ? say('checksResidual') : quantity;
}

const digitsOf = (unit: string): number => (unit === 'ppm' ? 1 : 3);

/** A figure of a chart, without its unit. */
export const chartFigure = (value: number, unit: string, language: Language): string => number(value, digitsOf(unit), language);

/** Why a check is marked. */
export function beyondWords({chart: {quantity, unit}, of, value, limit}: Beyond, say: Say, language: Language): string {
  const figure = (one: number): string => `${chartFigure(one, unit, language)} ${unit}`;
  return say(of === 'value' ? 'checkBeyond' : 'checkMeanBeyond', {what: quantityWords(quantity, say), value: figure(value), limit: figure(limit)});
}

const kCauses: Record<string, WordKey> = {joint: 'checkCauseJoint', block: 'checkCauseBlock', stylus: 'checkCauseStylus', unknown: 'checkCauseUnknown'};

/** What a check that was not accepted says has changed. */
export function changedWords(row: CheckRow | null, say: Say): string {
  const cause = kCauses[row?.cause ?? 'unknown'];
  return say('checkChanged', {cause: cause ? say(cause, {joint: row?.joint ?? ''}) : row?.cause ?? ''});
}
