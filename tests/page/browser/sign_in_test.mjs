// Persons: who signs in, who may do what, and STOP for all of them.
import assert from 'node:assert/strict';
import {readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {after, before} from 'node:test';
import {closeQuietly, expectAccessible, expectQuiet, openBrowser, openPage, pauseButton, speak, start, startButton, state, step, stopButton,
        waitForState} from './browser.mjs';
import {Cell} from './cell.mjs';
import {expectFits} from './fits.mjs';

const kSecret = 'blue chair 7';
const kHebrew = 'מרים כהן-לוי';
const kWide = 'W'.repeat(64);

let cell, browser;
before(async () => {
  cell = await Cell.start({speed: 50});
  browser = await openBrowser();
});
after(async () => {
  await browser?.close();
  await cell?.stop();
});

const account = (page) => page.locator('.account');
const who = (page) => page.locator('header .who');
const nameField = (page) => account(page).getByLabel('Name', {exact: true});
const secretField = (page) => account(page).getByLabel('PIN or passphrase', {exact: true});

async function fillIn(page, name, secret) {
  await nameField(page).fill(name);
  await secretField(page).fill(secret);
  await page.keyboard.press('Enter');
}

/** A page of its own on which this person has signed in, from the main button. */
async function openAs(name, secret = kSecret, options = {}) {
  const page = await openPage(browser, cell.url, options);
  await page.locator('.run-controls .run.main:not([disabled])', {hasText: 'SIGN IN'}).click();
  await fillIn(page, name, secret);
  await account(page).waitFor({state: 'detached'});
  await who(page).waitFor();
  return page;
}

const kept = (page) => page.evaluate(() => JSON.stringify({...localStorage, ...sessionStorage}));
const session = (page) => page.evaluate(async () => {
  const headers = {Authorization: `Bearer ${localStorage.getItem('touchcal.token')}`};
  return (await fetch('/api/v1/session', {headers})).json();
});

/** STOP is whole on the screen, nothing lies over it, and it can be pressed. */
async function expectStopInReach(page, where) {
  assert.ok(await stopButton(page).isEnabled(), where);
  const isOnTop = await stopButton(page).evaluate((button) => {
    const {left, right, top, bottom} = button.getBoundingClientRect();
    const corners = [[left + 3, top + 3], [right - 3, top + 3], [left + 3, bottom - 3], [right - 3, bottom - 3]];
    return corners.every(([x, y]) => button.contains(document.elementFromPoint(x, y)));
  });
  assert.ok(isOnTop, where);
}

/** Makes a run, and STOP of this page end it. */
async function expectStops(page, where) {
  await cell.post('/api/v1/cell/reset');
  await cell.status(({state: name}) => name === 'IDLE' || name === 'COMPLETE');
  await cell.post('/api/v1/runs', {recipe: 'quick'});
  await cell.status(({state: name}) => name === 'EXECUTE');
  await expectStopInReach(page, where);
  await stopButton(page).click();
  await cell.status(({state: name}) => name === 'STOPPED');
  assert.equal(await page.locator('.stop-lost').count(), 0, where);
}

/** Ends all sessions as ten hours would: a daemon that comes back finds their ends behind it. */
async function letSessionsRunOut(of = cell) {
  await of.killDaemon();
  const file = join(of.state, 'users.json');
  const book = JSON.parse(readFileSync(file, 'utf8'));
  const ended = new Date(Date.now() - 3.6e6).toISOString();
  writeFileSync(file, JSON.stringify({...book, sessions: book.sessions.map((one) => ({...one, ends_at: ended}))}), {mode: 0o600});
  await of.restartDaemon();
}

step('TheLinkOfTheFirstStartMakesTheFirstPerson', async () => {
  const page = await openPage(browser, cell.link);
  await who(page).filter({hasText: 'access code'}).filter({hasText: 'engineer'}).waitFor();
  await page.getByRole('button', {name: 'Account'}).click();
  await account(page).getByText('Nobody yet').waitFor();
  await expectAccessible(page, 'nobody yet');
  await account(page).getByRole('button', {name: 'Add a person'}).click();
  const save = account(page).getByRole('button', {name: 'Save'});
  await nameField(page).fill('eva');
  await account(page).getByLabel('Role').selectOption('engineer');
  await secretField(page).fill('short');
  assert.ok(await save.isDisabled(), 'five characters');
  assert.equal(await secretField(page).getAttribute('autocomplete'), 'new-password');
  await secretField(page).fill('aaaaaa');
  await save.click();
  await account(page).locator('.abnormal', {hasText: 'one character over and over'}).waitFor();
  await secretField(page).fill(kSecret);
  await save.click();
  await account(page).locator('.people tbody th', {hasText: 'eva'}).waitFor();
  for (const [name, role] of [['anna', 'operate'], ['viktor', 'view'], ['ola', 'operate'], [kHebrew, 'operate'], [kWide, 'engineer']]) {
    const {users} = await cell.post('/api/v1/users', {name, role, secret: kSecret});
    assert.ok(users.some((user) => user.name === name && user.role === role));
  }
  expectQuiet(page, cell);
  await page.context().close();
});

step('WithoutATokenTheMainButtonLeadsToTheSignInAndAWrongSecretIsSaidInWords', async () => {
  const page = await openPage(browser, cell.url);
  await page.locator('.watching', {hasText: 'to operate, sign in'}).waitFor();
  assert.ok(await pauseButton(page).isDisabled());
  assert.ok(await stopButton(page).isDisabled(), 'a page without a token stops nothing');
  await startButton(page).filter({hasText: 'commands need a sign-in'}).click();
  await nameField(page).waitFor();
  await page.waitForFunction(() => document.activeElement?.getAttribute('autocomplete') === 'username');
  const attributes = (field) => field.evaluate(({type, autocomplete, enterKeyHint, inputMode}) => ({type, autocomplete, enterKeyHint, inputMode}));
  assert.deepEqual(await attributes(nameField(page)), {type: 'text', autocomplete: 'username', enterKeyHint: 'next', inputMode: ''});
  assert.deepEqual(await attributes(secretField(page)), {type: 'password', autocomplete: 'current-password', enterKeyHint: 'go', inputMode: 'text'});
  await account(page).getByLabel('Digits only').check();
  assert.equal((await attributes(secretField(page))).inputMode, 'numeric');
  await expectAccessible(page, 'to sign in');
  await fillIn(page, 'anna', 'wrong one');
  await account(page).getByText('The name or the PIN or passphrase is wrong.').waitFor();
  assert.equal(await secretField(page).inputValue(), '');
  await fillIn(page, 'nobody of this name', kSecret);
  await account(page).getByText('The name or the PIN or passphrase is wrong.').waitFor();
  await expectAccessible(page, 'a wrong secret');
  await expectFits(page, 'to sign in', ['Alt+Digit1']);
  await fillIn(page, 'anna', kSecret);
  await who(page).filter({hasText: 'anna'}).filter({hasText: 'operate'}).waitFor();
  await page.locator('.run-controls .run.main:not([disabled])', {hasText: 'START'}).waitFor();
  await expectStopInReach(page, 'signed in');
  const stored = await kept(page);
  assert.ok(stored.includes('"touchcal.name":"anna"') && !stored.includes(kSecret), stored);
  await page.reload();
  await who(page).filter({hasText: 'anna'}).waitFor();
  expectQuiet(page, cell);
  await page.context().close();
});

step('ADaemonThatIsNotReachedIsSaidToBe', async () => {
  const page = await openPage(browser, cell.url);
  await startButton(page).filter({hasText: 'SIGN IN'}).click();
  await page.route(`${cell.url}/api/v1/sign-in`, (route) => route.abort());
  await fillIn(page, 'anna', kSecret);
  await account(page).getByText('The daemon was not reached').waitFor();
  await closeQuietly(page);
});

step('WhoIsSignedInAnswersForTheRunAndIsNotAskedForAName', async () => {
  const page = await openPage(browser, 'about:blank');
  await page.addInitScript(() => localStorage.setItem('touchcal.operator', 'somebody else'));
  await page.goto(cell.url);
  await startButton(page).filter({hasText: 'SIGN IN'}).click();
  await fillIn(page, 'anna', kSecret);
  await page.locator('.signed-operator bdi', {hasText: 'anna'}).waitFor();
  assert.equal(await page.getByLabel('Operator').count(), 0);
  await page.getByText('quick', {exact: true}).click();
  await start(page);
  await waitForState(page, 'Running');
  const {run_id} = await cell.get('/api/v1/status');
  assert.equal((await cell.get(`/api/v1/runs/${run_id}`)).conditions.operator, 'anna');
  await pauseButton(page).click();
  await page.locator('.card.hold', {hasText: 'Paused by anna (127.0.0.1)'}).waitFor();
  await expectFits(page, 'signed in, paused', ['Alt+Digit2']);
  await stopButton(page).click();
  await waitForState(page, 'Stopped');
  expectQuiet(page, cell);
  await page.context().close();
});

step('WhoMayOnlyLookIsToldSoAndStops', async () => {
  const page = await openAs('viktor');
  await page.locator('.watching', {hasText: 'You may look, and press STOP'}).waitFor();
  await startButton(page).filter({hasText: 'may look only; ask for “operate”'}).waitFor();
  assert.ok(await startButton(page).isDisabled());
  await expectStops(page, 'somebody who may look');
  await cell.post('/api/v1/cell/reset');
  await cell.status(({state: name}) => name === 'IDLE');
  await cell.post('/api/v1/runs', {recipe: 'quick'});
  await waitForState(page, 'Running');
  await pauseButton(page).filter({hasText: 'may look only'}).waitFor();
  assert.ok(await pauseButton(page).isDisabled());
  await expectAccessible(page, 'may look only');
  await expectFits(page, 'may look only', ['Alt+Digit2']);
  await page.keyboard.press('Alt+KeyS');
  await waitForState(page, 'Stopped');
  await page.getByRole('button', {name: 'Account'}).click();
  await account(page).getByText('May look, and press STOP.').waitFor();
  assert.equal(await account(page).locator('.people').count(), 0);
  expectQuiet(page, cell);
  await page.context().close();
});

step('NamesOfAnyWritingAndLengthHaveTheirPlace', async () => {
  const page = await openAs(kWide, kSecret, {viewport: {width: 1280, height: 800}});
  for (const name of [kWide, kHebrew]) await account(page).or(who(page)).first().waitFor();
  await expectFits(page, 'a wide name');
  const loud = await page.locator('header h1').evaluate((title) => parseFloat(getComputedStyle(title).fontSize));
  const quiet = await who(page).evaluate((row) => parseFloat(getComputedStyle(row).fontSize));
  assert.ok(quiet <= loud / 3, `${quiet} beside ${loud}`);
  await page.getByRole('button', {name: 'Account'}).click();
  const rows = account(page).locator('.people tbody tr');
  await rows.filter({hasText: kHebrew}).waitFor();
  assert.deepEqual(await account(page).locator('.people tbody bdi:not(.visually-hidden bdi)').allTextContents(), [kWide, 'anna', 'eva', 'ola', 'viktor', kHebrew]);
  await rows.filter({hasText: kWide}).getByRole('button').click();
  await account(page).getByRole('button', {name: 'Remove…'}).click();
  await expectFits(page, 'who may sign in', ['Alt+Digit1']);
  await expectAccessible(page, 'who may sign in');
  await expectStopInReach(page, 'the list of persons');
  // Longer than a daemon takes them: the page draws what it is told.
  const long = 'name without end '.repeat(12).trim();
  await page.route(`${cell.url}/api/v1/session`, async (route) => {
    const answer = await route.fetch({headers: {...route.request().headers(), connection: 'close'}});
    await route.fulfill({response: answer, json: {...await answer.json(), name: long}});
  });
  await page.reload();
  await who(page).filter({hasText: 'name without end'}).waitFor();
  await page.getByRole('button', {name: 'Account'}).click();
  await account(page).locator('.somebody', {hasText: long}).waitFor();
  await expectFits(page, 'a name of 200 characters', ['Alt+Digit1']);
  assert.deepEqual(page.complaints, []);
  await closeQuietly(page);
});

step('AnEngineerChangesARoleAndRemovesAPersonAtOnce', async () => {
  const ola = await openAs('ola');
  await ola.locator('.run-controls .run.main', {hasText: 'RESET'}).waitFor();
  const page = await openAs('eva');
  await page.getByRole('button', {name: 'Account'}).click();
  const row = account(page).locator('.people tbody tr', {hasText: 'ola'});
  await row.filter({hasText: /\d{4}-\d\d-\d\d/}).waitFor();
  assert.equal(await row.locator('.figure').textContent(), '1');
  await row.getByRole('button', {name: 'Change'}).click();
  assert.ok(await account(page).getByRole('button', {name: 'Save'}).isDisabled(), 'nothing is changed');
  await account(page).getByLabel('Role').selectOption('view');
  await account(page).getByRole('button', {name: 'Save'}).click();
  await row.filter({hasText: 'view'}).waitFor();
  assert.equal(await row.locator('.figure').textContent(), '0', 'whose sessions end');
  await startButton(ola).filter({hasText: 'SIGN IN'}).waitFor();
  await ola.locator('.card.warning', {hasText: 'no longer taken'}).getByRole('button', {name: 'Sign in'}).click();
  await fillIn(ola, 'ola', kSecret);
  await startButton(ola).filter({hasText: 'may look only'}).waitFor();
  await row.getByRole('button', {name: 'Change'}).click();
  await account(page).getByRole('button', {name: 'Remove…'}).click();
  await account(page).getByRole('alertdialog').getByRole('button', {name: 'Remove'}).click();
  await row.waitFor({state: 'detached'});
  await startButton(ola).filter({hasText: 'SIGN IN'}).waitFor();
  for (const one of [ola, page]) {
    expectQuiet(one, cell);
    await one.context().close();
  }
});

step('APersonChangesTheOwnSecretAndSignsOut', async () => {
  const page = await openAs('anna');
  await page.getByRole('button', {name: 'Account'}).click();
  await account(page).getByRole('button', {name: 'Change my PIN or passphrase'}).click();
  const now = account(page).getByLabel('The present PIN or passphrase'), next = account(page).getByLabel('The new one');
  assert.deepEqual([await now.getAttribute('autocomplete'), await next.getAttribute('autocomplete')], ['current-password', 'new-password']);
  await now.fill('not this');
  await next.fill('green door 8');
  await page.keyboard.press('Enter');
  await account(page).getByText('The present PIN or passphrase is wrong').waitFor();
  await expectAccessible(page, 'the own secret');
  await expectFits(page, 'the own secret', ['Alt+Digit1']);
  await now.fill(kSecret);
  await page.keyboard.press('Enter');
  await account(page).getByText('Changed. Your other sign-ins have ended.').waitFor();
  await account(page).getByRole('button', {name: 'Sign out'}).click();
  await startButton(page).filter({hasText: 'SIGN IN'}).waitFor();
  assert.ok(!(await kept(page)).includes('touchcal.token'));
  await fillIn(page, 'anna', 'green door 8');
  await who(page).filter({hasText: 'anna'}).waitFor();
  expectQuiet(page, cell);
  await page.context().close();
});

step('WhoSignsOutWhileTheArmMayMoveIsAskedTwice', async () => {
  const page = await openAs('viktor');
  await cell.post('/api/v1/cell/reset');
  await cell.status(({state: name}) => name === 'IDLE' || name === 'COMPLETE');
  await cell.post('/api/v1/runs', {recipe: 'quick'});
  await cell.status(({state: name}) => name === 'EXECUTE');
  await page.getByRole('button', {name: 'Account'}).click();
  const asked = account(page).getByRole('alertdialog', {name: 'this page cannot stop it'});
  await account(page).getByRole('button', {name: 'Sign out…'}).click();
  await asked.waitFor();
  await expectAccessible(page, 'signing out of a run');
  await expectFits(page, 'signing out of a run', ['Alt+Digit1']);
  await asked.getByRole('button', {name: 'Cancel'}).click();
  assert.equal((await session(page)).name, 'viktor');
  await expectStopInReach(page, 'still signed in');
  await account(page).getByRole('button', {name: 'Sign out…'}).click();
  await asked.getByRole('button', {name: 'Sign out'}).click();
  await startButton(page).filter({hasText: 'SIGN IN'}).waitFor();
  await cell.post('/api/v1/cell/stop');
  await cell.status(({state: name}) => name === 'STOPPED');
  expectQuiet(page, cell);
  await page.context().close();
});

step('ASessionThatHasRunOutStopsAlsoBehindTenWrongSecretsAndNothingElse', async () => {
  const page = await openAs('anna', 'green door 8');
  await letSessionsRunOut();
  const notice = page.locator('.card.warning', {hasText: 'Your sign-in has ended'});
  await notice.filter({hasText: 'anna'}).waitFor();
  await expectAccessible(page, 'a session that has ended');
  await expectFits(page, 'a session that has ended', ['Alt+Digit1']);
  await startButton(page).filter({hasText: 'the sign-in has ended'}).waitFor();
  assert.deepEqual([(await session(page)).role, (await session(page)).kind], ['none', 'user']);
  await expectStops(page, 'a session that has ended');
  await notice.getByRole('button', {name: 'Sign in'}).click();
  for (let i = 0; i < 5; ++i) {
    const answered = page.waitForResponse(`${cell.url}/api/v1/sign-in`);
    await fillIn(page, 'anna', `wrong ${i}`);
    assert.equal((await answered).status(), 401);
    await page.waitForFunction(() => document.querySelector('.sign-in input[autocomplete="current-password"]').value === '');
  }
  await fillIn(page, 'anna', 'wrong 6');
  await account(page).getByText('Too many wrong tries for this name').waitFor();
  const left = account(page).locator('.countdown .left');
  const seconds = async () => Number((await left.textContent()).match(/\d+/)[0]);
  const first = await seconds();
  await page.waitForFunction((than) => Number(document.querySelector('.account .countdown .left').textContent.match(/\d+/)[0]) < than, first);
  assert.ok(await account(page).getByRole('button', {name: 'Sign in', exact: true}).isDisabled());
  for (let i = 0; i < 5; ++i) await page.evaluate(() => fetch('/api/v1/sign-in', {method: 'POST', headers: {'Content-Type': 'application/json'}, body: '{"name":"anna","secret":"wrong"}'}));
  await expectAccessible(page, 'too many wrong secrets');
  await expectFits(page, 'too many wrong secrets', ['Alt+Digit1']);
  await expectStops(page, 'behind ten wrong secrets');
  await nameField(page).fill('viktor');
  assert.equal(await left.count(), 0, 'others are not held up');
  await fillIn(page, 'viktor', kSecret);
  await who(page).filter({hasText: 'viktor'}).waitFor();
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

step('TheLastMinutesOfASessionAreTold', async () => {
  const page = await openAs('viktor');
  await page.route(`${cell.url}/api/v1/session`, async (route) => {
    const answer = await route.fetch({headers: {...route.request().headers(), connection: 'close'}});
    await route.fulfill({response: answer, json: {...await answer.json(), ends_at: new Date(Date.now() + 12.5 * 60000).toISOString()}});
  });
  await page.reload();
  await who(page).filter({hasText: /1[23] min left/}).waitFor();
  await expectFits(page, 'the last minutes', ['Alt+Digit1']);
  await expectAccessible(page, 'the last minutes');
  await closeQuietly(page);
});

step('ATabletGetsTheAddressAsAQrCodeWithoutTheToken', async () => {
  const page = await openPage(browser, cell.link);
  await page.getByRole('button', {name: 'Account'}).click();
  await account(page).getByRole('button', {name: 'Open on a tablet'}).click();
  await account(page).getByText('This address is known on this machine only').waitFor();
  assert.equal(await account(page).locator('.qr').count(), 0, 'a code that leads nowhere');
  assert.ok(!page.requested.some((address) => address.includes('qr_code')));
  expectQuiet(page, cell);
  await page.context().close();

  // The same page by a name that a network knows.
  const far = 'http://cell.test:8080';
  const other = await openPage(browser, 'about:blank');
  await other.route(`${far}/**`, async (route) => {
    const {pathname, search} = new URL(route.request().url());
    if (pathname === '/api/v1/events') return route.fulfill({status: 503, json: {}});
    const headers = {...route.request().headers(), host: new URL(cell.url).host, origin: cell.url, connection: 'close'};
    return route.fulfill({response: await route.fetch({url: cell.url + pathname + search, headers})});
  });
  await other.goto(`${far}/#token=${cell.token}`);
  await waitForState(other, ['Ready', 'Stopped']);
  await other.getByRole('button', {name: 'Account'}).click();
  await account(other).getByRole('button', {name: 'Open on a tablet'}).click();
  await account(other).getByRole('img', {name: 'QR code of this page’s address'}).waitFor();
  assert.equal(await account(other).locator('code').textContent(), `${far}/`);
  const {width, height} = await account(other).locator('.qr').boundingBox();
  assert.ok(width >= 200 && Math.abs(width - height) < 1, `${width} x ${height}`);
  const size = Number((await account(other).locator('.qr').getAttribute('viewBox')).split(' ')[2]);
  assert.equal(size, 25 + 8, 'the 22 bytes of the address and no token');
  await expectAccessible(other, 'a QR code');
  await expectFits(other, 'a QR code', ['Alt+Digit1']);
  assert.deepEqual(other.complaints, []);
  await closeQuietly(other);
});

step('ADaemonThatTellsNothingWithoutATokenAsksWhoIsThere', async () => {
  const far = await Cell.start({daemonOptions: ['--loopback-needs-token']});  // as over a network
  try {
    await far.post('/api/v1/users', {name: 'anna', role: 'operate', secret: kSecret});
    const page = await openPage(browser, far.url);
    const card = page.locator('.card.warning', {hasText: 'The daemon wants to know who you are'});
    await card.waitFor();
    await startButton(page).filter({hasText: 'commands need a sign-in'}).waitFor();
    await expectAccessible(page, 'nothing is told');
    await expectFits(page, 'nothing is told', ['Alt+Digit1']);
    await card.getByRole('button', {name: 'Sign in'}).click();
    await fillIn(page, 'anna', kSecret);
    await waitForState(page, 'Ready');
    await page.locator('header .link dd', {hasText: 'Live'}).waitFor();
    await page.locator('.run-controls .run.main:not([disabled])', {hasText: 'START'}).waitFor();
    await letSessionsRunOut(far);
    await page.locator('.card.warning', {hasText: 'Your sign-in has ended'}).waitFor();
    await expectStopInReach(page, 'nothing is told to a session that has ended');
    const answered = page.waitForResponse(`${far.url}/api/v1/cell/stop`);
    await stopButton(page).click();
    assert.ok((await answered).status() < 400);
    assert.equal(await page.locator('.stop-lost').count(), 0);
    await startButton(page).filter({hasText: 'the sign-in has ended'}).click();
    await fillIn(page, 'anna', kSecret);
    await waitForState(page, 'Stopped');
    expectQuiet(page, far);
    await page.context().close();
  } finally {
    await far.stop();
  }
});

step('NothingOfTheSignInIsLeftInEnglish', async () => {
  const page = await openAs('eva');
  await page.getByRole('button', {name: 'Account'}).click();
  await account(page).getByRole('button', {name: 'Add a person'}).click();
  await account(page).getByRole('button', {name: 'Change my PIN or passphrase'}).click();
  const texts = () => account(page).evaluate((panel) => {
    const found = [];
    const walk = document.createTreeWalker(panel, NodeFilter.SHOW_TEXT);
    for (let node = walk.nextNode(); node; node = walk.nextNode()) {
      if (!node.parentElement.closest('bdi') && /[A-Za-z]{3}/.test(node.textContent)) found.push(node.textContent.trim());
    }
    return found;
  });
  const english = new Set(await texts());
  assert.ok(english.size > 20);
  for (const language of ['fr', 'de']) {
    await speak(page, language);
    assert.deepEqual((await texts()).filter((text) => english.has(text) && text !== 'Name'), [], language);
    await expectAccessible(page, `the account, ${language}`);
  }
  assert.match(await state(page), /\S/);
  expectQuiet(page, cell);
  await page.context().close();
});
