// What goes wrong is shown until it is noted, and there is a way on from each of it.
import assert from 'node:assert/strict';
import {after, before} from 'node:test';
import {expectAccessible, expectQuiet, hold, openBrowser, openPage, start, startButton, step, waitForState} from './browser.mjs';
import {Cell} from './cell.mjs';

let cell, browser, page;
before(async () => {
  cell = await Cell.start({speed: 100});
  browser = await openBrowser();
  page = await openPage(browser, cell.link);
  await page.getByText('quick', {exact: true}).click();
  await start(page);
});
after(async () => {
  await browser?.close();
  await cell?.stop();
});

const fault = (words) => page.locator('.card.fault', {hasText: words});
const past = (words) => page.locator('.past-faults li', {hasText: words});
const untilTouch = (count) => cell.status((status) => status.state === 'EXECUTE' && status.touches_done >= count);

step('AWarningStaysWhileTheRunGoesOn', async () => {
  await untilTouch(1);
  await cell.control({fault: 'probe_bounces', touch: 'every', times: 2});
  const warning = page.locator('.card.warning', {hasText: 'probe bounced'});
  await warning.waitFor();
  assert.equal((await cell.get('/api/v1/status')).state, 'EXECUTE');
  await expectAccessible(page, 'warning');
  await cell.control({fault: 'probe_mended'});
  await untilTouch((await cell.get('/api/v1/status')).touches_done + 2);
  await warning.getByRole('button', {name: 'Acknowledge'}).click();
  await warning.waitFor({state: 'detached'});
});

step('ATouchThatFailsHoldsTheRunAndIsMadeAgain', async () => {
  await cell.control({fault: 'probe_stuck'});
  await waitForState(page, 'Paused');
  const card = fault('probe stuck');
  await card.waitFor();
  for (const part of ['What happened', 'What the robot did', 'What to do now']) assert.ok((await card.textContent()).includes(part), part);
  await expectAccessible(page, 'held');
  const {touches_done} = await cell.get('/api/v1/status');
  await cell.control({fault: 'probe_mended'});
  await hold(page, card.getByRole('button', {name: /Touch again/}));
  await untilTouch(touches_done + 1);
  // What held the run is over, and still there to be read.
  await fault('probe stuck').waitFor({state: 'detached'});
  await past('probe stuck').getByRole('button', {name: 'Acknowledge'}).click();
  await past('probe stuck').waitFor({state: 'detached'});
});

step('ASuspendedRunGoesOnByItselfOnceTheCauseIsGone', async () => {
  await cell.control({fault: 'monitor_speed', percent: 50});
  await waitForState(page, 'Waiting for cell');
  await fault('monitor speed changed').waitFor();
  await expectAccessible(page, 'suspended');
  await cell.control({fault: 'monitor_speed', percent: 100});
  await cell.status(({state}) => state === 'EXECUTE');
  await past('monitor speed changed').getByRole('button', {name: 'Acknowledge'}).click();
});

step('PauseAndResumeAreWhereTheyAlwaysAre', async () => {
  await page.getByRole('button', {name: 'PAUSE'}).click();
  await waitForState(page, 'Paused');
  await expectAccessible(page, 'paused');
  await hold(page, page.getByRole('button', {name: /RESUME/}));
  await cell.status(({state}) => state === 'EXECUTE');
});

step('AnAbortedRunIsLeftByAcknowledgingClearingAndResetting', async () => {
  await page.getByRole('button', {name: /^Cell/}).click();
  await page.setViewportSize({width: 1024, height: 400});
  await page.locator('main').evaluate((main) => main.scrollTo(0, main.scrollHeight));
  await cell.control({fault: 'collision', touch: 'every', phase: 'travel'});
  await waitForState(page, 'Aborted');
  await fault('collision').waitFor();
  await page.waitForFunction(() => {
    const card = document.querySelector('.card.fault').getBoundingClientRect();
    return card.top >= document.querySelector('main').getBoundingClientRect().top - 1 && card.top < 300;
  });
  await page.setViewportSize({width: 1024, height: 600});
  await expectAccessible(page, 'aborted');
  await cell.control({fault: 'jog_home'}).catch(() => {});
  await fault('collision').getByRole('button', {name: 'Acknowledge'}).click();
  await fault('collision').waitFor({state: 'detached'});
  await hold(page, startButton(page).filter({hasText: 'CLEAR'}));
  await waitForState(page, 'Stopped');
  await startButton(page).filter({hasText: 'RESET'}).click();
  await waitForState(page, ['Ready', 'Not ready']);
});

step('ACellThatIsNotReadySaysWhyAndCannotBeStarted', async () => {
  await cell.control({operator: {powers_up: false}});
  await cell.control({fault: 'emergency_stop'});
  await page.getByRole('button', {name: /^Cell/}).click();
  const estop = page.locator('.readiness li', {hasText: 'Emergency stop released'});
  await estop.filter({hasText: 'Not OK'}).waitFor();
  await waitForState(page, 'Motion disabled');
  await estop.filter({hasText: /release and acknowledge/}).waitFor();
  assert.ok(await startButton(page).isDisabled());
  await expectAccessible(page, 'not ready');
  expectQuiet(page, cell);
});
