// Debian's chromium, and what every test asks of the page in it.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {test} from 'node:test';
import {createRequire} from 'node:module';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';

const pageFolder = process.env.TOUCHCAL_PAGE_DIR ?? fileURLToPath(new URL('../../../build/service/page', import.meta.url));
const packages = createRequire(join(pageFolder, 'package.json'));
const {chromium} = packages('playwright-core');
const axe = readFileSync(packages.resolve('axe-core/axe.min.js'), 'utf8');

/** The view in three dimensions is drawn by software: a test machine has no graphics card. */
const kOptions = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', '--disable-dev-shm-usage'];
if (process.getuid?.() === 0) kOptions.push('--no-sandbox');
const kPatience_ms = 120000; // a bound for what hangs, also where two cores do much else

export async function openBrowser() {
  return chromium.launch({executablePath: process.env.TOUCHCAL_CHROMIUM ?? '/usr/bin/chromium', args: kOptions});
}

/** A page of its own, as a person with a small screen has it; it notes all that a browser complains about. */
export async function openPage(browser, address, options = {}) {
  const context = await browser.newContext({viewport: {width: 1024, height: 600}, locale: 'en-GB', colorScheme: 'light', ...options});
  const page = await context.newPage();
  page.setDefaultTimeout(kPatience_ms);
  page.complaints = [];
  page.on('pageerror', (error) => page.complaints.push(`error: ${error.message}`));
  page.on('console', (message) => {
    if (/Content Security Policy|Refused to/.test(message.text())) page.complaints.push(message.text());
  });
  page.requested = [];
  page.on('request', (request) => page.requested.push(request.url()));
  await page.goto(address);
  return page;
}

/** A page whose daemon says what `changes` makes of its answers, by path; it hears of the cell by asking. */
export async function openWith(browser, cell, changes) {
  const page = await openPage(browser, 'about:blank');
  for (const [path, change] of Object.entries(changes)) {
    await page.route(`${cell.url}${path}`, async (route) => {
      // A connection of its own: one that was kept may be closed by the daemon in the moment it is used again.
      const answer = await route.fetch({headers: {...route.request().headers(), connection: 'close'}});
      await route.fulfill(answer.status() === 200 ? {response: answer, json: change(await answer.json())} : {response: answer});
    });
  }
  await page.route(`${cell.url}/api/v1/events`, (route) => route.fulfill({status: 503, json: {}}));
  await page.goto(cell.link);
  return page;
}

/** Answers that are still under way are nobody's fault. */
export async function closeQuietly(page) {
  await page.unrouteAll({behavior: 'ignoreErrors'});
  await page.context().close();
}

/** The words of the state line. */
export const state = (page) => page.locator('header h1').textContent();

export async function waitForState(page, words, patience_ms = kPatience_ms) {
  const wanted = [words].flat();
  await page.waitForFunction((list) => list.includes(document.querySelector('header h1')?.textContent), wanted, {timeout: patience_ms});
}

/** Holds a button by mouse until it has acted. The page itself is watched: a busy machine may look too late. */
export async function hold(page, locator) {
  await locator.evaluate((button) => {
    let isHeld = false;
    window.heldToTheEnd = false;
    const watch = new MutationObserver(() => {
      const holding = button.isConnected && /keep holding|maintenez|weiter halten/.test(button.textContent);
      window.heldToTheEnd = isHeld && !holding;
      isHeld = holding;
      if (window.heldToTheEnd) watch.disconnect();
    });
    watch.observe(document.body, {subtree: true, childList: true, characterData: true});
  });
  await locator.hover();
  await page.mouse.down();
  await page.waitForFunction(() => window.heldToTheEnd);
  await page.mouse.up();
}

/** Chooses a language by its name in itself; its words are there when the page says which it is. */
export async function speak(page, language) {
  await page.locator('nav select').selectOption(language);
  await page.locator(`html[lang=${language}]`).waitFor({state: 'attached'});
}

export const startButton = (page) => page.locator('.run-controls .run.main');
export const pauseButton = (page) => page.locator('.run-controls .run.pause');
export const stopButton = (page) => page.locator('.run-controls .run.stop');

export async function start(page, label = /START|DÉMARRER/) {
  await page.locator('.run-controls .run.main:not([disabled])', {hasText: label}).waitFor();
  await hold(page, startButton(page));
}

/** What axe-core finds wrong, as text; empty when there is nothing. */
export async function violations(page) {
  if (!(await page.evaluate('Boolean(window.axe)'))) await page.evaluate(`${axe};0`);
  const found = await page.evaluate(async () => (await window.axe.run(document, {resultTypes: ['violations']})).violations);
  return found.map(({id, nodes}) => `${id}: ${nodes.map((node) => `${node.target} ${node.failureSummary}`).join(' | ')}`).join('\n');
}

export async function expectAccessible(page, where) {
  assert.equal(await violations(page), '', `axe-core, ${where}`);
}

/** Nothing broke, the policy was kept, and nobody but the daemon was asked. */
export function expectQuiet(page, cell) {
  assert.deepEqual(page.complaints, []);
  const elsewhere = page.requested.filter((address) => !address.startsWith(cell.url) && !address.startsWith('data:'));
  assert.deepEqual(elsewhere, []);
}

let broken = false;

/** A test that goes on from where the one before left the cell: it is left out when that one failed. */
export function step(name, act) {
  test(name, async (context) => {
    if (broken) {
      context.skip('an earlier step failed');
      return;
    }
    broken = true;
    await act();
    broken = false;
  });
}
