import type {Cell, Criterion} from '../api/documents.ts';
import {faceWords} from '../model/faces.ts';
import type {Language} from '../model/format.ts';
import {isFailed, shownFigure, type LimitRow} from '../model/limit_rows.ts';
import type {WhereOf} from '../model/places.ts';
import {sayName, type Say} from './words.ts';

/** What a criterion is called, with its face or tool. */
export function criterionWords({name, plane, tool}: Criterion, cell: Cell | null, whereOf: WhereOf, say: Say, language: Language): string {
  return [sayName(language, 'criterion_', name), plane ? faceWords(cell, plane, say, whereOf) : '', tool ?? ''].filter((part) => part !== '').join(', ');
}

/** Why a result is rejected, a sentence a row: made from the figures, so that it is in the page's language. */
export function reasonsOf(rows: LimitRow[], cell: Cell | null, whereOf: WhereOf, say: Say, language: Language): string[] {
  return rows.filter(isFailed).map(({criterion, decision, isYesOrNo}) => {
    const what = criterionWords(criterion, cell, whereOf, say, language);
    const limitText = shownFigure(criterion, criterion.limit, language);
    const limit = criterion.side === 'lower' ? say('needed', {limit: limitText}) : limitText;
    if (isYesOrNo) return say('reasonNo', {what});
    if (criterion.value === null) return say('reasonUnknown', {what, limit});
    const value = shownFigure(criterion, criterion.value, language);
    if (decision === 'missed') return say('reasonMissed', {what, value, limit});
    return say('reasonNotProved', {what, value, limit, expanded: shownFigure(criterion, criterion.expanded_uncertainty, language)});
  });
}
