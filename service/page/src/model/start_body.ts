import type {Cell} from '../api/documents.ts';

/** What a person wrote into the fields of the block's temperature; a field that was not touched is not there. */
export interface WrittenTemperature { celsius?: string; std?: string }

/** What is done in place of a calibration; it has no recipe, or that of the one that counts. */
export type VerifyingKind = 'check' | 'proof' | 'qualification' | 'tool';

/** What a start is made with beside the recipe. `tool`: of the kind tool. */
export interface Conditions { kind?: VerifyingKind; tool?: string; operator?: string; touching?: 'guided'; temperature?: WrittenTemperature; movingMin?: string }

/** Who is signed in answers for the run: nobody else is named. */
export function conditionsOf({operator, ...others}: Conditions, signedIn: string | null): Conditions {
  return signedIn === null && operator !== undefined ? {...others, operator} : others;
}

/** The body of a start, as POST runs takes it. */
export interface StartBody {
  recipe?: string;
  kind?: VerifyingKind;
  tool?: string;
  operator?: string;
  touching?: 'guided';
  block_temperature_c?: number | string;
  std_block_temperature_k?: number | string;
  arm_moving_min?: number | string;
}

/** What the two fields show: what was written, else the figures of the block's file. */
export function shownTemperature(written: WrittenTemperature | undefined, block: Cell['block'] | null): Required<WrittenTemperature> {
  return {celsius: written?.celsius ?? text(block?.temperature_c), std: written?.std ?? text(block?.std_temperature_k)};
}

/** A temperature is sent when it is another one than the file's; the daemon judges what is no number. */
export function startBody(recipe: string, {kind, tool, temperature, movingMin, touching, ...others}: Conditions, block: Cell['block'] | null): StartBody {
  const shown = shownTemperature(temperature, block);
  const ofFile = shownTemperature(undefined, block);
  // The daemon knows whether the arm or a person makes these touches.
  const what = kind ? {kind, ...(tool && {tool})} : {recipe, ...(touching && {touching})};
  const start = {...what, ...others, ...(movingMin?.trim() && {arm_moving_min: figure(movingMin)})};
  if (shown.celsius.trim() === ofFile.celsius && shown.std.trim() === ofFile.std) return start;
  return {
    ...start,
    ...(shown.celsius.trim() && {block_temperature_c: figure(shown.celsius)}),
    ...(shown.std.trim() && {std_block_temperature_k: figure(shown.std)}),
  };
}

function text(value: number | null | undefined): string {
  return value === null || value === undefined ? '' : String(value);
}

/** Decimals behind a point or a comma. */
function figure(written: string): number | string {
  const value = Number(written.trim().replace(',', '.'));
  return Number.isFinite(value) ? value : written.trim();
}
