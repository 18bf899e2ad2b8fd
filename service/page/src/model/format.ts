/** A language is a file in words/, and its row in words/words.ts. */
export type Language = 'en' | 'fr' | 'de';

/** Written for what is not known. */
export const kUnknown = '–';

export function number(value: number | null | undefined, digits: number, language: Language): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return kUnknown;
  const text = value.toLocaleString(language, {minimumFractionDigits: digits, maximumFractionDigits: digits, useGrouping: false});
  return /[1-9]/.test(text) ? text : text.replace(/^-/, '');  // what is rounded to zero has no sign
}

/** As number(), but what is not nothing is not written as nothing: "< 0.001". */
export function figure(value: number | null | undefined, digits: number, language: Language): string {
  const smallest = 10 ** -digits;
  if (typeof value === 'number' && value > 0 && value < smallest / 2) return `< ${number(smallest, digits, language)}`;
  return number(value, digits, language);
}

/** A bound that holds: two digits that count, the last one rounded up. 0.0571 is "0.058". */
export function roundedUp(value: number, language: Language): string {
  if (!(value > 0) || !Number.isFinite(value)) return number(value, 2, language);
  const digits = Math.max(0, 1 - Math.floor(Math.log10(value)));
  const scale = 10 ** digits;
  return number(Math.ceil(value * scale - 1e-9) / scale, digits, language);
}

/** 4000 s is "1 h 07 min", 75 s "1 min 15 s", 9 s "9 s". */
export function duration(seconds: number | null | undefined): string {
  if (seconds === null || seconds === undefined || !Number.isFinite(seconds)) return kUnknown;
  const whole = Math.max(0, Math.round(seconds));
  const two = (part: number): string => String(part).padStart(2, '0');
  if (whole >= 3600) return `${Math.floor(whole / 3600)} h ${two(Math.floor((whole % 3600) / 60))} min`;
  return whole >= 60 ? `${Math.floor(whole / 60)} min ${two(whole % 60)} s` : `${whole} s`;
}

/** How long ago the data were told. */
export function age(age_ms: number | null): string {
  if (age_ms === null) return kUnknown;
  return age_ms < 1000 ? '< 1 s' : duration(age_ms / 1000);
}

/** A time of the daemon's clock; the browser's clock is not asked. */
export function time(text: string | null): string {
  const match = text?.match(/^(\d{4}-\d{2}-\d{2})T(\d{2}:\d{2}:\d{2})/);
  return match ? `${match[1]} ${match[2]}` : kUnknown;
}

/** The words of a template with its {names} filled in. */
export function fill(template: string, values: Record<string, string | number>): string {
  return template.replace(/\{(\w+)\}/g, (whole, name: string) => String(values[name] ?? whole));
}

/** The first characters of a long text; null when it is not long. */
export function cut(text: string, max = 300): string | null {
  return text.length > max ? text.slice(0, max) : null;
}
