import type {Cell} from '../api/documents.ts';
import type {Say} from '../words/words.ts';
import {ownNumber, type Where, type WhereOf} from './places.ts';

/** The name of a face in the block's file; null: it has none. */
export function faceName(cell: Cell | null, plane: number): string | null {
  return cell?.block.faces.find((face) => face.plane === plane)?.name || null;
}

const kFirst: WhereOf = () => ({place: null, tip: null});

/** "stand", "tip left", "stand, tip left"; nothing at the first place with the first tip. */
function whereWords({place, tip}: Where, say: Say): string {
  return [place, tip === null ? null : say('withTip', {tip})].filter((part) => part !== null).join(', ');
}

/** What a face is called where it stands by itself: its name, else `numbered` of its number; and where and with what else it is touched. */
function called(cell: Cell | null, plane: number, where: string, numbered: (own: number) => string): string {
  const own = where === '' ? plane : ownNumber(cell, plane);
  const words = faceName(cell, own) ?? numbered(own);
  return where === '' ? words : `${words}, ${where}`;
}

/** A face as people call it: "Plane 2", "Plane 2, stand, tip left", or by its name. */
export function faceWords(cell: Cell | null, plane: number, say: Say, whereOf: WhereOf = kFirst): string {
  return called(cell, plane, whereWords(whereOf(plane), say), (own) => say('plane', {plane: own}));
}

/** The same below a heading that says what it is: "2", "2, stand". */
export function faceLabel(cell: Cell | null, plane: number, say: Say, whereOf: WhereOf): string {
  return called(cell, plane, whereWords(whereOf(plane), say), String);
}

/** The number for a sentence that says "plane" itself: "2", "2 (stand)". */
export function planeNumber(cell: Cell | null, plane: number, say: Say, whereOf: WhereOf): string {
  const where = whereWords(whereOf(plane), say);
  return where === '' ? String(plane) : `${ownNumber(cell, plane)} (${where})`;
}
