// The daemon goes away in the middle of a run and comes back.
import assert from 'node:assert/strict';
import {after, before} from 'node:test';
import {expectAccessible, expectQuiet, hold, openBrowser, openPage, pauseButton, start, startButton, step, stopButton, waitForState} from './browser.mjs';
import {Cell} from './cell.mjs';

let cell, browser, page;
before(async () => {
  cell = await Cell.start({speed: 200});
  browser = await openBrowser();
  page = await openPage(browser, cell.link);
});
after(async () => {
  await browser?.close();
  await cell?.stop();
});

step('ALostDaemonIsSaidInWordsAndOnlyStopCanBeTried', async () => {
  await page.getByText('quick', {exact: true}).click();
  await start(page);
  await cell.status(({state, touches_done}) => state === 'EXECUTE' && touches_done >= 3);
  await cell.killDaemon();
  await waitForState(page, 'Connection lost');
  await page.getByText('No answer from the daemon').waitFor();
  assert.match(await page.locator('header .count').textContent(), /Touch \d+ of 90/, 'the last data stay, greyed');
  await page.locator('header .link .abnormal', {hasText: 'old data'}).waitFor();
  assert.ok(await startButton(page).isDisabled());
  assert.ok(await pauseButton(page).isDisabled());
  assert.ok(await stopButton(page).isEnabled());
  await expectAccessible(page, 'lost');
  await stopButton(page).click();
  await page.locator('.card.stop-lost', {hasText: 'STOP WAS NOT DELIVERED'}).waitFor();
  await expectAccessible(page, 'a stop that was lost');
});

step('TheAgeOfTheDataGrowsWhileNobodyAnswers', async () => {
  const age = () => page.locator('header .link [data-age]').getAttribute('data-age').then(Number);
  const before = await age();
  await page.waitForFunction((than) => Number(document.querySelector('header .link [data-age]').dataset.age) > than + 900, before);
});

step('ThePageComesBackByItselfAndOffersToGoOn', async () => {
  await cell.restartDaemon();
  await waitForState(page, 'Paused');
  await page.locator('.card.fault', {hasText: 'daemon restarted'}).waitFor();
  await page.locator('.card.stop-lost').getByRole('button', {name: 'Acknowledge'}).click();
  await expectAccessible(page, 'restarted');
  assert.equal(await page.getByRole('button', {name: /Touch again|Skip this touch/}).count(), 0, 'no touch holds the run');
  await page.locator('.run-controls .run.main:not([disabled])', {hasText: 'RESUME'}).waitFor();
  await hold(page, page.getByRole('button', {name: /RESUME/}));
  await waitForState(page, ['Resuming…', 'Running']);
  await waitForState(page, 'Complete');
  const run = (await cell.get('/api/v1/runs')).runs[0];
  assert.equal(run.touches_done, 90);
  expectQuiet(page, cell);
});
