import type {BlockPlace, Cell, PlaneDistances, ProbeTip, Recipes, Result} from '../api/documents.ts';

/** The place where the block was located; a further one has its name in the block's file. */
export const kFirstPlace = 'first';

/** At which further place and with which further tip a plane is touched; null: the first one, or not known. */
export interface Where { place: string | null; tip: string | null }
export type WhereOf = (plane: number) => Where;

/** What a recipe's planes are numbered on for: its further places and, at each of them, its further tips. */
export interface Numbering { places: string[]; tips: string[] }

/** Which of the block's own planes a number is of, at which of the recipe's places and with which of its tips: 0 is the first. */
export interface OwnPlane { plane: number; place: number; tip: number }

/** Of a block with k planes touched by t tips, plane p at place q by tip n (both from 0) is (q t + n) k + p. */
export function ownPlane(cell: Cell | null, plane: number, tips: string[]): OwnPlane {
  const count = cell?.block.faces.length ?? 0;
  if (count === 0 || plane < 1) return {plane, place: 0, tip: 0};
  const [each, all] = [Math.floor((plane - 1) / count), tips.length + 1];
  return {plane: plane - each * count, place: Math.floor(each / all), tip: each % all};
}

/** The block's own plane of a number: the same whatever touches it. */
export const ownNumber = (cell: Cell | null, plane: number): number => ownPlane(cell, plane, []).plane;

/** Nothing further of a recipe that the daemon does not tell of any more. */
export function numberingOf(recipes: Recipes | null, name: string | null): Numbering {
  const recipe = recipes?.recipes.find((one) => one.name === name);
  return {places: recipe?.places ?? [], tips: recipe?.tips ?? []};
}

export const whereByNumber = (cell: Cell | null, {places, tips}: Numbering): WhereOf => (plane) => {
  const {place, tip} = ownPlane(cell, plane, tips);
  return {place: places[place - 1] ?? null, tip: tips[tip - 1] ?? null};
};

export const whereOfPlane = ({place, tip}: PlaneDistances): Where => ({place: place ?? null, tip: tip ?? null});

const kFirst: Where = {place: null, tip: null};

/** As the result has it: its recipe may be another one by now. */
export function whereByResult({planes, planes_held_out}: Pick<Result, 'planes' | 'planes_held_out'>): WhereOf {
  const named = new Map([...planes, ...planes_held_out].map((distances) => [distances.plane, whereOfPlane(distances)]));
  return (plane) => named.get(plane) ?? kFirst;
}

/** The further place of this name. */
export const furtherPlace = (cell: Cell, name: string | null | undefined): BlockPlace | null =>
    cell.block.places?.find((place) => place.name === name) ?? null;

/** The further tip of the stylus that touches a plane of this number. */
export function furtherTip(cell: Cell, plane: number, numbering: Numbering): ProbeTip | null {
  const {tip} = whereByNumber(cell, numbering)(plane);
  return cell.probe.tips?.find(({name}) => name === tip) ?? null;
}

/** The touches that are made while the block stands at a place. */
export function touchesAt<Touch extends {plane: number}>(touches: Touch[], place: string | null | undefined, cell: Cell, {places, tips}: Numbering): Touch[] {
  const wanted = place ? places.indexOf(place) + 1 : 0;
  return touches.filter(({plane}) => ownPlane(cell, plane, tips).place === wanted);
}
