import type {Cell} from '../api/documents.ts';
import type {Say} from '../words/words.ts';

/** The name of a face in the block's file; null: it has none. */
export function faceName(cell: Cell | null, plane: number): string | null {
  return cell?.block.faces.find((face) => face.plane === plane)?.name || null;
}

/** A face as people call it: by its name, else by its number. */
export function faceWords(cell: Cell | null, plane: number, say: Say): string {
  return faceName(cell, plane) ?? say('plane', {plane});
}
