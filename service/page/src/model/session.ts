import type {Role} from '../api/documents.ts';
import type {Session} from '../api/session_documents.ts';
import type {PageState} from './page_state.ts';

/** What the page may do by what the daemon tells of its token. */
export function roleOf(session: Session, hasToken: boolean): Role {
  switch (session.role) {
    case 'engineer':
    case 'operate':
      return 'operate';
    case 'view':
      return 'view';
    case 'none':
      return session.kind === 'user' ? 'ended' : hasToken ? 'wrong token' : 'none';
  }
}

/** The person who is signed in; null: nobody, or an access code, which is nobody's. */
export function signedIn(session: Session | null): string | null {
  return session && session.kind === 'user' && session.role !== 'none' ? session.name : null;
}

/** STOP needs no role: any person's session stops the arm, also one that has run out; an access code that may only read does not. */
export function mayStop({role, session}: Pick<PageState, 'role' | 'session'>): boolean {
  return role === 'operate' || role === 'ended' || (role === 'view' && session?.kind === 'user');
}

/** Approves models and keeps the list of persons. */
export const isEngineer = ({session}: Pick<PageState, 'session'>): boolean => session?.role === 'engineer';

/** Somebody could sign in, and that would let the page do more. */
export function mustSignIn({role, session}: Pick<PageState, 'role' | 'session'>): boolean {
  return session?.sign_in === true && (role === 'none' || role === 'wrong token' || role === 'ended');
}

const kNotice_ms = 15 * 60000;

/**
 * Whole minutes that a session still has, when they are few; null: many, or it has no end. By the browser's clock, as the
 * daemon tells no time beside the end: what counts is that the daemon tells when it is over.
 */
export function minutesLeft(session: Session | null, clock_ms: number): number | null {
  if (signedIn(session) === null || !session?.ends_at) return null;
  const left_ms = Date.parse(session.ends_at) - clock_ms;
  return left_ms > 0 && left_ms < kNotice_ms ? Math.ceil(left_ms / 60000) : null;
}

/** A tablet cannot reach the machine that the page is on by this name. */
export function isLoopback(host: string): boolean {
  return host === 'localhost' || host.endsWith('.localhost') || host === '[::1]' || /^127(\.\d{1,3}){3}$/.test(host);
}
