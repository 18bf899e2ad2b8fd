import assert from 'node:assert/strict';
import {afterEach, test} from 'node:test';
import type {Role} from 'page/api/documents.ts';
import type {Session} from 'page/api/session_documents.ts';
import {leadsToSignIn, mainButton, reasonOfRole} from 'page/model/main_button.ts';
import {kFirstState, reduce, type Action, type PageState} from 'page/model/page_state.ts';
import {Pass} from 'page/model/pass.ts';
import {isEngineer, isLoopback, mayStop, minutesLeft, mustSignIn, roleOf, signedIn} from 'page/model/session.ts';
import {conditionsOf} from 'page/model/start_body.ts';
import {mayMove} from 'page/model/states.ts';
import {Store} from 'page/model/store.ts';
import {qrCode} from 'page/qr/qr_code.ts';
import {statusWith} from './statuses.ts';

const sessionWith = (changes: Partial<Session>): Session =>
    ({schema: 'touchcal/session/1', name: null, role: 'none', kind: 'none', ends_at: null, sign_in: true, ...changes});
const kAnna = sessionWith({name: 'anna', role: 'operate', kind: 'user', ends_at: '2026-01-01T10:00:00.000Z'});
const kEnded = sessionWith({name: 'anna', kind: 'user'});
const stateWith = (session: Session | null, role: Role | null, changes: Partial<PageState> = {}): PageState =>
    ({...kFirstState, link: 'live', unmet: [], recipe: 'quick', status: statusWith({}), session, role, ...changes});

test('WhatThePageMayDoFollowsFromWhomItsTokenStandsFor', () => {
  assert.equal(roleOf(sessionWith({}), false), 'none');
  assert.equal(roleOf(sessionWith({}), true), 'wrong token');
  assert.equal(roleOf(kEnded, true), 'ended');
  assert.equal(roleOf(kAnna, true), 'operate');
  assert.equal(roleOf(sessionWith({role: 'engineer', kind: 'token'}), true), 'operate');
  assert.equal(roleOf(sessionWith({role: 'view', kind: 'user'}), true), 'view');
  assert.deepEqual([kAnna, kEnded, sessionWith({name: 'press', role: 'engineer', kind: 'token'}), null].map(signedIn), ['anna', null, null, null],
                   'an access code is nobody, whatever its name');
  assert.ok(!isEngineer(stateWith(kAnna, 'operate')) && isEngineer(stateWith(sessionWith({role: 'engineer', kind: 'user'}), 'operate')));
});

test('AnyPersonsSessionStopsAndSoDoesASessionThatHasRunOut', () => {
  const stops = (session: Session | null, role: Role | null): boolean => mayStop({session, role});
  assert.ok(stops(kAnna, 'operate') && stops(kEnded, 'ended') && stops(sessionWith({role: 'view', kind: 'user'}), 'view'));
  assert.ok(stops(null, 'operate'), 'a daemon without sessions');
  assert.ok(!stops(sessionWith({role: 'view', kind: 'token'}), 'view') && !stops(null, 'view'), 'an access code to read');
  assert.ok(!stops(sessionWith({}), 'none') && !stops(sessionWith({}), 'wrong token') && !stops(null, null));
});

test('TheMainButtonLeadsToTheSignInWhereThatIsWhatIsMissing', () => {
  const why = (state: PageState) => mainButton(state, false).why;
  assert.deepEqual(why(stateWith(sessionWith({}), 'none')), {key: 'whySignIn'});
  assert.deepEqual(why(stateWith(sessionWith({}), 'none', {link: 'refused', status: null})), {key: 'whySignIn'}, 'a daemon that tells nothing without it');
  assert.deepEqual(why(stateWith(sessionWith({}), 'none', {link: 'lost'})), {key: 'whyNoLink'});
  assert.deepEqual(why(stateWith(kEnded, 'ended')), {key: 'whySessionEnded'});
  assert.deepEqual(why(stateWith(sessionWith({}), 'wrong token')), {key: 'whySignIn'});
  assert.deepEqual(why(stateWith(sessionWith({role: 'view', kind: 'user'}), 'view')), {key: 'whyMayLook'});
  assert.deepEqual(why(stateWith(sessionWith({role: 'view', kind: 'token'}), 'view')), {key: 'whyWatching'});
  assert.deepEqual(why(stateWith(sessionWith({sign_in: false}), 'none')), {key: 'whyWatching'}, 'there is nobody who could');
  assert.deepEqual(why(stateWith(null, 'none', {link: 'refused'})), {key: 'whyNoLink'}, 'a daemon without sessions');
  assert.equal(why(stateWith(kAnna, 'operate')), null);
  assert.deepEqual([{key: 'whySignIn'} as const, {key: 'whySessionEnded'} as const, {key: 'whyMayLook'} as const, null].map(leadsToSignIn), [true, true, false, false]);
  assert.deepEqual(reasonOfRole({role: null, session: null}), {key: 'whyUnknown'});
  assert.ok(!mustSignIn(stateWith(sessionWith({role: 'view', kind: 'user'}), 'view')), 'who may look is somebody');
});

test('FewMinutesThatAreLeftAreToldAndManyAreNot', () => {
  const at = (clock: string) => minutesLeft(kAnna, Date.parse(clock));
  assert.equal(at('2026-01-01T09:44:00Z'), null);
  assert.equal(at('2026-01-01T09:45:30Z'), 15);
  assert.equal(at('2026-01-01T09:59:30Z'), 1);
  assert.equal(at('2026-01-01T10:00:00Z'), null, 'that it is over the daemon tells');
  assert.equal(minutesLeft(kEnded, 0), null);
  assert.equal(minutesLeft({...kAnna, ends_at: null}, 0), null);
});

test('WhoIsSignedInAnswersForTheRunAndNobodyElseIsNamed', () => {
  assert.deepEqual(conditionsOf({operator: 'Ada', kind: 'check'}, null), {operator: 'Ada', kind: 'check'});
  assert.deepEqual(conditionsOf({operator: 'Ada', kind: 'check'}, 'anna'), {kind: 'check'});
  assert.deepEqual(conditionsOf({}, null), {});
});

test('ATabletCannotReachALoopbackAddress', () => {
  for (const host of ['localhost', 'cell.localhost', '127.0.0.1', '127.1.2.3', '[::1]']) assert.ok(isLoopback(host), host);
  for (const host of ['robot.example', '10.0.0.7', '127.0.0.1.example', '[fe80::1]']) assert.ok(!isLoopback(host), host);
});

test('AQrCodeHasItsThreeFindersAndAWhiteBorderOfFourSquares', () => {
  const {size, path} = qrCode('https://robot.example:8443/');
  const dark = new Set([...path.matchAll(/M(\d+) (\d+)h1v1h-1z/g)].map(([, x, y]) => `${x} ${y}`));
  assert.equal(size, 29 + 8, 'version 3: up to 42 bytes at level M');
  const finder = (left: number, top: number): void => {
    for (let y = 0; y < 7; ++y) {
      for (let x = 0; x < 7; ++x) {
        const ring = Math.max(Math.abs(x - 3), Math.abs(y - 3));
        assert.equal(dark.has(`${left + x} ${top + y}`), ring !== 2, `${left + x} ${top + y}`);
      }
    }
  };
  finder(4, 4);
  finder(size - 11, 4);
  finder(4, size - 11);
  for (const square of dark) assert.ok(square.split(' ').every((at) => Number(at) >= 4 && Number(at) < size - 4), square);
  assert.notEqual(qrCode('https://robot.example:8444/').path, path);
});

// The pass, with a daemon that answers as it is told.

interface Told { status: number; json: unknown; retryAfter?: string }
interface Asked { method: string; path: string; token: string | null; body: unknown; key: string | null }
const kFetch = globalThis.fetch;
afterEach(() => {
  globalThis.fetch = kFetch;
});

/** `answers` by "METHOD path"; what is not there is a daemon that is gone. */
function passWith(token: string | null, answers: Record<string, Told>) {
  const asked: Asked[] = [];
  globalThis.fetch = async (address, init) => {
    const headers = new Headers(init?.headers);
    const method = init?.method ?? 'GET', path = String(address);
    asked.push({method, path, token: headers.get('Authorization')?.replace('Bearer ', '') ?? null,
                body: init?.body ? JSON.parse(String(init.body)) : undefined, key: headers.get('Idempotency-Key')});
    const told = answers[`${method} ${path}`];
    if (!told) throw new TypeError('gone');
    return new Response(JSON.stringify(told.json), {status: told.status, headers: told.retryAfter ? {'Retry-After': told.retryAfter} : {}});
  };
  const store = new Store<PageState, Action>(reduce, kFirstState);
  const tokens: (string | null)[] = [];
  const pass = new Pass(store, token, (other) => tokens.push(other));
  return {pass, store, asked, tokens, answers};
}
const settled = (): Promise<void> => new Promise((done) => setTimeout(done));
const kWrong: Told = {status: 401, json: {type: 'urn:touchcal:problem:sign-in', title: 't', status: 401, detail: 'the name or the secret is wrong'}};

test('ASignInBringsATokenThatAllElseUses', async () => {
  const {pass, store, asked, tokens} = passWith('old', {
    'POST /api/v1/sign-in': {status: 201, json: {token: 'new', name: 'anna', role: 'operate', ends_at: kAnna.ends_at}},
    'GET /api/v1/session': {status: 200, json: kAnna},
  });
  assert.deepEqual(await pass.signIn('anna', '123456'), {kind: 'done'});
  await settled();
  assert.deepEqual(asked.map(({method, path, token}) => `${method} ${path} ${token}`), ['POST /api/v1/sign-in null', 'GET /api/v1/session new']);
  assert.deepEqual(asked[0]!.body, {name: 'anna', secret: '123456'});
  assert.deepEqual([pass.token, tokens, store.state.role, store.state.session], ['new', ['new'], 'operate', kAnna]);
});

test('WrongSecretsLeaveTheTokenThatMayStillStop', async () => {
  const {pass, store, tokens, answers, asked} = passWith('ended', {'POST /api/v1/sign-in': kWrong, 'GET /api/v1/session': {status: 200, json: kEnded}});
  await pass.ask();
  for (let i = 0; i < 10; ++i) {
    assert.deepEqual(await pass.signIn('anna', `wrong ${i}`), {kind: 'refused', status: 401, detail: 'the name or the secret is wrong', retry_after_s: null});
  }
  answers['POST /api/v1/sign-in'] = {...kWrong, status: 429, retryAfter: '30'};
  assert.deepEqual(await pass.signIn('anna', '123456'), {kind: 'refused', status: 429, detail: 'the name or the secret is wrong', retry_after_s: 30});
  delete answers['POST /api/v1/sign-in'];
  assert.deepEqual(await pass.signIn('anna', '123456'), {kind: 'lost'});
  assert.deepEqual([pass.token, tokens, store.state.role], ['ended', [], 'ended']);
  assert.ok(mayStop(store.state));
  assert.equal(asked.filter(({path}) => path === '/api/v1/sign-in').length, 12, 'a sign-in is sent once');
});

test('ASignOutForgetsTheTokenOnceTheDaemonHasEndedTheSession', async () => {
  const {pass, store, tokens, answers} = passWith('anna', {'GET /api/v1/session': {status: 200, json: kAnna}});
  await pass.ask();
  assert.deepEqual(await pass.signOut(), {kind: 'lost'});
  assert.deepEqual([pass.token, tokens], ['anna', []], 'it still counts');
  answers['POST /api/v1/sign-out'] = {status: 200, json: sessionWith({})};
  answers['GET /api/v1/session'] = {status: 200, json: sessionWith({})};
  assert.deepEqual(await pass.signOut(), {kind: 'done'});
  await settled();
  assert.deepEqual([pass.token, tokens, store.state.role, store.state.hasToken], [null, [null], 'none', false]);
});

const kUnkept: Told = {status: 503, json: {type: 'urn:touchcal:problem:not-kept', title: 't', status: 503, detail: 'it counts from now on'}};

test('ASignOutThatTheDiskDidNotTakeIsOneAndIsSaidToBeNotKept', async () => {
  const {pass, tokens, answers} = passWith('anna', {'GET /api/v1/session': {status: 200, json: kAnna}, 'POST /api/v1/sign-out': kUnkept});
  await pass.ask();
  answers['GET /api/v1/session'] = {status: 200, json: sessionWith({})};
  assert.deepEqual(await pass.signOut(), {kind: 'unkept'});
  assert.deepEqual([pass.token, tokens], [null, [null]]);
});

test('APersonIsPutAndRemovedOnceWhateverComesOfIt', async () => {
  const {pass, store, asked, answers} = passWith('e', {
    'GET /api/v1/session': {status: 200, json: sessionWith({role: 'engineer', kind: 'token'})},
    'GET /api/v1/users': {status: 200, json: {users: []}},
  });
  await pass.ask();
  assert.deepEqual(await pass.putPerson('anna', 'view', '654321'), {kind: 'lost'});
  assert.deepEqual(await pass.removePerson('anna'), {kind: 'lost'});
  assert.equal(asked.filter(({method}) => method === 'POST').length, 2, 'sent again it would be done again: no key tells it from another');
  answers['POST /api/v1/users/anna/remove'] = kUnkept;
  assert.deepEqual(await pass.removePerson('anna'), {kind: 'unkept'});
  await settled();
  assert.deepEqual(store.state.people, [], 'the list is asked for: it counts');
});

test('WhoLeavesAPageWhileTheArmMayMoveIsAskedTwice', () => {
  for (const state of ['EXECUTE', 'HELD', 'HOLDING', 'STOPPING', 'STARTING'] as const) assert.ok(mayMove(statusWith({state})), state);
  for (const state of ['IDLE', 'COMPLETE', 'STOPPED', 'ABORTED'] as const) assert.ok(!mayMove(statusWith({state})), state);
  assert.ok(mayMove(statusWith({state: 'RESETTING', controller_permit: 'granted'})), 'it is taken back');
  assert.ok(mayMove(statusWith({state: 'IDLE', by_hand: 'locate'})));
  assert.ok(!mayMove(null));
});

test('ADaemonWithoutSessionsIsAskedAsBefore', async () => {
  const problem = {type: 'about:blank', title: 't', status: 404, detail: 'd'};
  const {pass, store} = passWith('a', {'GET /api/v1/session': {status: 404, json: problem}, 'GET /api/v1/access': {status: 200, json: {role: 'operate'}}});
  await pass.ask();
  assert.deepEqual([store.state.session, store.state.role], [null, 'operate']);
  await pass.refused(403);
  assert.equal(store.state.role, 'operate', 'a command was refused, not the token');
  await pass.refused(401);
  assert.equal(store.state.role, 'wrong token');
});

test('ABusyDaemonOrAProxyInFrontOfItLeavesWhoMayStop', async () => {
  const kLooks = sessionWith({name: 'vera', role: 'view', kind: 'user'});
  for (const [session, role] of [[kAnna, 'operate'], [kEnded, 'ended'], [kLooks, 'view']] as const) {
    const {pass, store, answers} = passWith('a', {'GET /api/v1/session': {status: 200, json: session}});
    await pass.ask();
    for (const status of [429, 500, 502, 503]) {
      answers['GET /api/v1/session'] = {status, json: {type: 'about:blank', title: 't', status, detail: 'd'}};
      answers['GET /api/v1/access'] = answers['GET /api/v1/session'];
      await pass.ask();
      assert.deepEqual([store.state.session, store.state.role], [session, role], `${status}`);
      assert.ok(mayStop(store.state));
    }
  }
});

test('AnAnswerThatWasAskedForWithAnotherTokenSaysNothing', async () => {
  const {pass, store} = passWith('ended', {
    'GET /api/v1/session': {status: 200, json: kAnna},
    'POST /api/v1/sign-in': {status: 201, json: {token: 'new', name: 'anna', role: 'operate', ends_at: kAnna.ends_at}},
  });
  const own = globalThis.fetch;
  let answerOld: () => void = () => {};
  globalThis.fetch = (address, init) => {
    if (new Headers(init?.headers).get('Authorization') !== 'Bearer ended') return own(address, init);
    return new Promise((done) => {
      answerOld = () => done(new Response(JSON.stringify(kEnded)));
    });
  };
  const old = pass.ask();
  await pass.signIn('anna', '123456');
  await settled();
  answerOld();
  await old;
  assert.equal(store.state.role, 'operate');
});

test('ThePersonsAreListedChangedAndRemovedByTheirWholeName', async () => {
  const users = [{name: 'anna/ü ?', role: 'view', created_at: 'c', created_by: null, last_sign_in_at: null, session_count: 0}];
  const {pass, store, asked} = passWith('e', {
    'GET /api/v1/session': {status: 200, json: sessionWith({role: 'engineer', kind: 'token'})},
    'GET /api/v1/users': {status: 200, json: {users}},
    'POST /api/v1/users': {status: 201, json: {users}},
    'POST /api/v1/users/anna%2F%C3%BC%20%3F/remove': {status: 200, json: {users: []}},
  });
  await pass.ask();
  await pass.loadPeople();
  assert.deepEqual(store.state.people, users);
  await pass.putPerson('anna/ü ?', 'view', '');
  await pass.putPerson('anna/ü ?', 'view', '654321');
  assert.deepEqual(await pass.removePerson('anna/ü ?'), {kind: 'done'});
  const posts = asked.filter(({method}) => method === 'POST');
  assert.deepEqual(posts.map(({body}) => body), [{name: 'anna/ü ?', role: 'view'}, {name: 'anna/ü ?', role: 'view', secret: '654321'}, {}]);
  assert.ok(posts.every(({key}) => key === null), 'the daemon takes no key for them');
  assert.deepEqual(store.state.people, []);
});
