import type {BlockPlace, Cell, PlaneDistances, Recipes, Result} from '../api/documents.ts';

/** The place where the block was located; a further one has its name in the block's file. */
export const kFirstPlace = 'first';

/** The further place at which a plane of this number is touched; null: the first one, or not known. */
export type PlaceOf = (plane: number) => string | null;

/** Which of the block's own planes a number is of, and at which of the recipe's places: 0 is the first. */
export interface OwnPlane { plane: number; place: number }

/** Planes are numbered on: of a block with k planes, plane p at the n-th further place is n k + p. */
export function ownPlane(cell: Cell | null, plane: number): OwnPlane {
  const count = cell?.block.faces.length ?? 0;
  if (count === 0 || plane < 1) return {plane, place: 0};
  const place = Math.floor((plane - 1) / count);
  return {plane: plane - place * count, place};
}

/** The further places of a recipe; none of one that the daemon does not tell of any more. */
export function placesOfRecipe(recipes: Recipes | null, name: string | null): string[] {
  return recipes?.recipes.find((recipe) => recipe.name === name)?.places ?? [];
}

export const placeByNumber = (cell: Cell | null, places: string[]): PlaceOf => (plane) => places[ownPlane(cell, plane).place - 1] ?? null;

/** As the result has it: its recipe may be another one by now. */
export function placeByResult({planes, planes_held_out}: Pick<Result, 'planes' | 'planes_held_out'>): PlaceOf {
  const named = new Map([...planes, ...planes_held_out].map(({plane, place}: PlaneDistances) => [plane, place ?? null]));
  return (plane) => named.get(plane) ?? null;
}

/** The further place of this name. */
export const furtherPlace = (cell: Cell, name: string | null | undefined): BlockPlace | null =>
    cell.block.places?.find((place) => place.name === name) ?? null;

/** The touches that are made while the block stands at a place. */
export function touchesAt<Touch extends {plane: number}>(touches: Touch[], place: string | null | undefined, cell: Cell, places: string[]): Touch[] {
  const wanted = place ? places.indexOf(place) + 1 : 0;
  return touches.filter(({plane}) => ownPlane(cell, plane).place === wanted);
}
