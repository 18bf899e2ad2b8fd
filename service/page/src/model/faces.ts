import type {Cell} from '../api/documents.ts';
import type {Say} from '../words/words.ts';
import {ownPlane, type PlaceOf} from './places.ts';

/** The name of a face in the block's file; null: it has none. */
export function faceName(cell: Cell | null, plane: number): string | null {
  return cell?.block.faces.find((face) => face.plane === plane)?.name || null;
}

const kFirst: PlaceOf = () => null;

/** What a face is called where it stands by itself: its name, else `numbered` of its number; and the further place where it is touched. */
function called(cell: Cell | null, plane: number, placeOf: PlaceOf, numbered: (own: number) => string): string {
  const place = placeOf(plane);
  const own = place === null ? plane : ownPlane(cell, plane).plane;
  const words = faceName(cell, own) ?? numbered(own);
  return place === null ? words : `${words}, ${place}`;
}

/** A face as people call it: "Plane 2", "Plane 2, stand", or by its name. */
export function faceWords(cell: Cell | null, plane: number, say: Say, placeOf: PlaceOf = kFirst): string {
  return called(cell, plane, placeOf, (own) => say('plane', {plane: own}));
}

/** The same below a heading that says what it is: "2", "2, stand". */
export function faceLabel(cell: Cell | null, plane: number, placeOf: PlaceOf): string {
  return called(cell, plane, placeOf, String);
}

/** The number for a sentence that says "plane" itself: "2", "2 (stand)". */
export function planeNumber(cell: Cell | null, plane: number, placeOf: PlaceOf): string {
  const place = placeOf(plane);
  return place === null ? String(plane) : `${ownPlane(cell, plane).plane} (${place})`;
}
