import type {Criterion, DecisionRule} from '../api/documents.ts';
import type {WordKey} from '../words/words.ts';
import {figure, number, type Language} from './format.ts';

/** What became of a figure: a guarded rule rejects what is within its limit and not proven. */
export type Decision = 'proved' | 'held' | 'not proved' | 'missed';

/** A figure against its limit, as a row is drawn of it. */
export interface LimitRow {
  criterion: Criterion;
  decision: Decision;
  isYesOrNo: boolean;
  /** Of the limit: 1 is at it; null: nothing to draw. */
  share: number | null;
  /** The share with the expanded uncertainty towards the limit. */
  shareExpanded: number | null;
}

const kYesOrNo: ReadonlySet<string> = new Set(['complete', 'converged']);

export function limitRow(criterion: Criterion, rule: DecisionRule['rule']): LimitRow {
  const {name, value, limit, side, expanded_uncertainty: expanded} = criterion;
  const isYesOrNo = kYesOrNo.has(name);
  const isDrawn = value !== null && limit > 0 && !isYesOrNo;
  const towards = side === 'lower' ? -1 : 1;
  return {
    criterion,
    decision: decisionOf(criterion, rule),
    isYesOrNo,
    share: isDrawn ? value / limit : null,
    shareExpanded: isDrawn && expanded !== null ? Math.max(0, value + towards * expanded) / limit : null,
  };
}

function decisionOf({within_limit, proved}: Criterion, rule: DecisionRule['rule']): Decision {
  if (!within_limit) return 'missed';
  if (proved) return 'proved';
  return rule === 'guarded' && proved === false ? 'not proved' : 'held';
}

export const isFailed = ({decision}: LimitRow): boolean => decision === 'missed' || decision === 'not proved';

/** The rows of a rule; what rejects comes first. */
export function limitRows({criteria, rule}: DecisionRule): LimitRow[] {
  const rows = criteria.map((criterion) => limitRow(criterion, rule));
  return [...rows.filter(isFailed), ...rows.filter((row) => !isFailed(row))];
}

/** Digits behind the point at which two of the limit count: 0.03 has three, 0.0002 five. */
const countingDigits = (limit: number): number => 1 - Math.floor(Math.log10(limit));

/**
 * Digits behind the point of a figure of the row: millimetres have three, a count none. A share or a probability has two, and where it is
 * as small as its limit may be, those at which two of the limit count; the limit itself has no zero at its end.
 */
function digitsOf({unit, limit, value}: Criterion, shown: number): number {
  if (unit === 'mm') return 3;
  if (!(limit > 0 && limit < 1)) return Number.isInteger(limit) && (value === null || Number.isInteger(value)) ? 0 : 1;
  if (Math.abs(shown) >= 0.1) return 2;
  const digits = countingDigits(limit);
  const isRound = shown === limit && Math.abs(limit - Number(limit.toFixed(digits - 1))) < 1e-12;
  return Math.max(2, isRound ? digits - 1 : digits);
}

/** A figure of the row, with its unit. */
export function shownFigure(criterion: Criterion, value: number | null, language: Language): string {
  const {unit} = criterion;
  if (value === null) return number(null, 0, language);
  const digits = digitsOf(criterion, value);
  return unit === '1' ? figure(value, digits, language) : `${number(value, digits, language)} ${unit}`;
}

const kNextSteps: Readonly<Record<string, WordKey>> = {
  complete: 'nextIncomplete', converged: 'next_fit', held_out_touches: 'next_more', held_out_mean: 'next_touches', held_out_rms: 'next_touches',
  condition_number: 'next_more', tip_box_rms: 'next_more', tip_box_max: 'next_more', tool_box_rms: 'next_more', unknown_errors: 'next_files',
  nominal_miss: 'next_more', scale: 'next_scale', artefact: 'next_scale', lack_of_fit: 'next_fit', rejected_touches: 'next_touches',
  held_parameters: 'next_more', shown_parameters: 'next_more',
};

/** What to do about the rows that reject, each thing once. */
export function nextSteps(rows: LimitRow[]): WordKey[] {
  const keys = rows.filter(isFailed).map(({criterion: {name, plane}}) => (name === 'lack_of_fit' && plane !== null ? 'next_touches' : kNextSteps[name]));
  return [...new Set(keys.filter((key) => key !== undefined))];
}
