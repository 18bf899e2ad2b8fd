import {get, postOnce, type Reply} from '../api/client.ts';
import type {Role} from '../api/documents.ts';
import type {People, PersonRole, Session, SignedIn} from '../api/session_documents.ts';
import {dropToken, keepToken, watchToken} from '../api/token.ts';
import type {Action, PageState} from './page_state.ts';
import {isEngineer, roleOf} from './session.ts';
import type {Store} from './store.ts';

const kSession_ms = 10000;           // then whom the token stands for is asked again: a session may have been ended
const kSecretPatience_ms = 20000;    // the daemon takes its time with a secret, on purpose

/**
 * What came of a request: done, or why not. `unkept`: it is done, but the disk did not take it, and a restart of the daemon
 * would undo it; `lost`: the daemon was not reached.
 */
export type Outcome = {kind: 'done'} | {kind: 'unkept'} | {kind: 'lost'} | {kind: 'refused'; status: number; detail: string; retry_after_s: number | null};

const isUnkept = (reply: Reply<unknown>): boolean => reply.kind === 'refused' && reply.problem.type === 'urn:touchcal:problem:not-kept';

function outcomeOf(reply: Reply<unknown>): Outcome {
  if (isUnkept(reply)) return {kind: 'unkept'};
  if (reply.kind === 'refused') return {kind: 'refused', status: reply.status, detail: reply.problem.detail, retry_after_s: reply.retry_after_s};
  return {kind: reply.kind === 'lost' ? 'lost' : 'done'};
}

/** The page's token, and the person whom it stands for. A session that has run out is kept: it may still stop the arm. */
export class Pass {
  private isSignIn = true;  // the daemon has sessions; an older one is asked as before

  constructor(private readonly store: Store<PageState, Action>, private held: string | null, private readonly changed: (token: string | null) => void) {
    this.store.dispatch({type: 'patch', patch: {hasToken: held !== null}});
  }

  get token(): string | null {
    return this.held;
  }

  start(): void {
    watchToken((token) => this.take(token));
    setInterval(() => {
      if (this.isSignIn && !document.hidden) void this.ask();
    }, kSession_ms);
  }

  /** Asks what the token may do. */
  async ask(): Promise<void> {
    const asked = this.held;
    const reply = await get<Session>('/api/v1/session', {token: asked});
    if (asked !== this.held || reply.kind === 'lost') return;
    if (reply.kind === 'ok') {
      this.isSignIn = true;
      this.takeSession(reply.value);
      return;
    }
    if (reply.kind === 'refused' && reply.status !== 404) return;  // of a proxy, or of a daemon that is busy: it says nothing of the token
    this.isSignIn = false;
    this.patch({session: null});
    await this.askAccess();
  }

  private async askAccess(): Promise<void> {
    const asked = this.held;
    const reply = await get<{role: Role}>('/api/v1/access', {token: asked});
    if (asked !== this.held) return;
    if (reply.kind === 'ok') this.patch({role: reply.value.role});
    const isOfToken = reply.kind === 'refused' && (reply.status === 401 || reply.status === 403);
    if (isOfToken) this.patch({role: asked ? 'wrong token' : 'none'});
  }

  /** A command was refused for the token's sake. */
  async refused(status: number): Promise<void> {
    if (this.store.state.session !== null) await this.ask();
    else if (status === 401) this.patch({role: 'wrong token'});
  }

  async signIn(name: string, secret: string): Promise<Outcome> {
    const reply = await postOnce<SignedIn>('/api/v1/sign-in', {token: null, body: {name, secret}, patience_ms: kSecretPatience_ms});
    if (reply.kind === 'ok') {
      keepToken(reply.value.token);
      this.take(reply.value.token);
    }
    return outcomeOf(reply);
  }

  /** The session ends at the daemon first: a token that still counts is not forgotten. */
  async signOut(): Promise<Outcome> {
    const reply = await postOnce<Session>('/api/v1/sign-out', {token: this.held, body: {}});
    const isOver = reply.kind === 'ok' || isUnkept(reply) || (reply.kind === 'refused' && reply.status === 401);
    if (!isOver) return outcomeOf(reply);
    dropToken();
    this.take(null);
    return {kind: isUnkept(reply) ? 'unkept' : 'done'};
  }

  async changeSecret(secret: string, new_secret: string): Promise<Outcome> {
    const body = {secret, new_secret};
    const reply = await postOnce<Session>('/api/v1/session/secret', {token: this.held, body, patience_ms: kSecretPatience_ms});
    if (reply.kind === 'ok') this.takeSession(reply.value);
    return outcomeOf(reply);
  }

  // the list of persons, for an engineer

  async loadPeople(): Promise<Outcome> {
    return this.takePeople(await get<People>('/api/v1/users', {token: this.held}));
  }

  /** Makes a person, or changes one; without a secret the one that is there stays. */
  async putPerson(name: string, role: PersonRole, secret: string): Promise<Outcome> {
    const body = {name, role, ...(secret && {secret})};
    return this.takePeople(await postOnce<People>('/api/v1/users', {token: this.held, body, patience_ms: kSecretPatience_ms}));
  }

  async removePerson(name: string): Promise<Outcome> {
    return this.takePeople(await postOnce<People>(`/api/v1/users/${encodeURIComponent(name)}/remove`, {token: this.held, body: {}}));
  }

  private takePeople(reply: Reply<People>): Outcome {
    if (reply.kind === 'ok') this.patch({people: reply.value.users});
    if (isUnkept(reply)) void this.loadPeople();
    if (reply.kind === 'ok' || reply.kind === 'refused') void this.ask();  // one's own role may be another now
    return outcomeOf(reply);
  }

  private take(token: string | null): void {
    if (token === this.held) return;
    this.held = token;
    this.patch({hasToken: token !== null, people: null, notice: null});
    this.changed(token);
    void this.ask();
  }

  private takeSession(session: Session): void {
    const isSame = JSON.stringify(session) === JSON.stringify(this.store.state.session);
    const role = roleOf(session, this.held !== null);
    if (!isSame || role !== this.store.state.role) this.patch({session, role});
    if (!isEngineer(this.store.state) && this.store.state.people) this.patch({people: null});
  }

  private patch(patch: Partial<PageState>): void {
    this.store.dispatch({type: 'patch', patch});
  }
}
