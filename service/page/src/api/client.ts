import type {Problem} from './documents.ts';

/** An answer, a refusal, or nothing: status 0 says that the daemon was not reached in time. */
export type Reply<T> =
  | {kind: 'ok'; status: number; value: T; etag: string | null}
  | {kind: 'same'}
  | {kind: 'refused'; status: number; problem: Problem; retry_after_s: number | null}  // null: the daemon named no time
  | {kind: 'lost'};

export interface Asked {
  token: string | null;
  body?: unknown;
  key?: string;
  etag?: string | null;
  patience_ms?: number;
}

const kPatience_ms = 5000;

/** 128 random bits: crypto.randomUUID is not there on a page without TLS. */
export function newKey(): string {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  return [...bytes].map((byte) => byte.toString(16).padStart(2, '0')).join('');
}

export function headersOf({token, body, key, etag}: Asked): Record<string, string> {
  const headers: Record<string, string> = {};
  if (token) headers['Authorization'] = `Bearer ${token}`;
  if (body !== undefined) headers['Content-Type'] = 'application/json';
  if (key) headers['Idempotency-Key'] = key;
  if (etag) headers['If-None-Match'] = etag;
  return headers;
}

async function problemOf(response: Response): Promise<Problem> {
  try {
    const problem = await response.json();
    if (problem && typeof problem.detail === 'string') return problem;
  } catch {
    // No document: the status says what there is to say.
  }
  return {type: 'about:blank', title: response.statusText, status: response.status, detail: `HTTP ${response.status}`};
}

/** As seconds only: the daemon gives no date, and the browser's clock could not read one. */
function retryAfter_s(response: Response): number | null {
  const told = response.headers.get('Retry-After');
  return told && /^\d{1,6}$/.test(told) ? Number(told) : null;
}

async function ask<T>(method: string, path: string, asked: Asked): Promise<Reply<T>> {
  const over = new AbortController();
  const clock = setTimeout(() => over.abort(), asked.patience_ms ?? kPatience_ms);
  try {
    const init: RequestInit = {method, headers: headersOf(asked), signal: over.signal, cache: 'no-store'};
    if (asked.body !== undefined) init.body = JSON.stringify(asked.body);
    const response = await fetch(path, init);
    if (response.status === 304) return {kind: 'same'};
    if (!response.ok) {
      return {kind: 'refused', status: response.status, problem: await problemOf(response), retry_after_s: retryAfter_s(response)};
    }
    return {kind: 'ok', status: response.status, value: await response.json(), etag: response.headers.get('ETag')};
  } catch {
    return {kind: 'lost'};
  } finally {
    clearTimeout(clock);
  }
}

export function get<T>(path: string, asked: Asked): Promise<Reply<T>> {
  return ask('GET', path, asked);
}

/**
 * A request for which the daemon takes no key: one that got no answer is asked again by the person, who sees what is so now.
 */
export function postOnce<T>(path: string, asked: Asked): Promise<Reply<T>> {
  return ask('POST', path, asked);
}

const kTries = 3;

/** A command with a key of its own: asked again when no answer came, it is taken once. */
export async function post<T>(path: string, asked: Asked): Promise<Reply<T>> {
  const keyed = {...asked, key: asked.key ?? newKey()};
  let reply: Reply<T> = {kind: 'lost'};
  for (let i = 0; i < kTries && reply.kind === 'lost'; ++i) reply = await ask('POST', path, keyed);
  return reply;
}
