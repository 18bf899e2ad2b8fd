// What a person at the cell or at the pendant is told to do.
import assert from 'node:assert/strict';
import {after, before} from 'node:test';
import {closeQuietly, expectAccessible, expectQuiet, hold, openBrowser, openPage, openWith, speak, start, step, waitForState} from './browser.mjs';
import {Cell} from './cell.mjs';

let cell, browser;
before(async () => {
  cell = await Cell.start({speed: 100});
  browser = await openBrowser();
});
after(async () => {
  await browser?.close();
  await cell?.stop();
});

step('TheRunWaitsForTheConfirmationAndSaysWhere', async () => {
  await cell.control({operator: {confirms: false}});
  const page = await openPage(browser, cell.link);
  await page.getByText('quick', {exact: true}).click();
  await start(page);
  await page.locator('.card.wait', {hasText: 'Press the confirmation key at the cell'}).waitFor();
  await expectAccessible(page, 'awaiting the confirmation');
  await cell.control({fault: 'press_confirm'});
  await page.locator('.card.wait').waitFor({state: 'detached'});
  await waitForState(page, 'Running');
  await cell.control({fault: 'release_confirm'});
  await page.getByRole('button', {name: /^STOP/}).click();
  await waitForState(page, 'Stopped');
  expectQuiet(page, cell);
});

const kGuide = {state: 'EXECUTE', by_hand: 'locate', by_hand_plane: 3, by_hand_index: 2, by_hand_total: 6, by_hand_words: 'touch the top once more'};

/** The page of a cell that asks for touches by hand; `asked`: the commands that it was given. */
async function openGuided(guide) {
  const page = await openWith(browser, cell, {'/api/v1/status': (status) => ({...status, sequence: status.sequence + 7, ...kGuide, ...guide})});
  page.asked = [];
  await page.route(`${cell.url}/api/v1/cell/*`, async (route) => {
    if (route.request().method() !== 'POST') return route.fallback();
    page.asked.push(new URL(route.request().url()).pathname.split('/').pop());
    return route.fulfill({status: 202, json: {}});
  });
  return page;
}

step('APersonWithThePendantIsToldEachTouchAndTakesOrUndoesIt', async () => {
  const page = await openGuided({by_hand_step: 'touch', by_hand_problem: 'the stylus is free', by_hand_joints_deg: [1, 2, 3, 4, 5, 6]});
  const card = page.locator('.card.wait');
  await card.waitFor();
  for (const words of ['touch the top once more', 'Touch 2 of 6', 'the stylus is free', '1 / 2 / 3 / 4 / 5 / 6']) {
    assert.ok((await card.textContent()).includes(words), words);
  }
  await waitForState(page, 'Locating');
  await page.locator('.run-controls .run.main[disabled]', {hasText: 'Locating is under way: finish or cancel it first'}).waitFor();
  await expectAccessible(page, 'by hand');
  for (const [name, command] of [['Take this touch', 'take'], ['Undo the last', 'undo'], ['CANCEL LOCATING', 'stop']]) {
    const given = page.waitForRequest(`${cell.url}/api/v1/cell/${command}`);
    await card.getByRole('button', {name}).click();
    assert.equal((await given).method(), 'POST');
  }
  await speak(page, 'fr');
  await card.getByText('Palpez le plan 3 :').waitFor();
  await closeQuietly(page);
});

step('TheArmGoesAroundTheBlockOnlyWhenAButtonIsHeld', async () => {
  const page = await openGuided({by_hand_step: 'pass'});
  const around = page.getByRole('button', {name: /GO AROUND/});
  await around.click();
  assert.deepEqual(page.asked, []);
  const given = page.waitForRequest(`${cell.url}/api/v1/cell/locate`);
  await hold(page, around);
  await given;
  await expectAccessible(page, 'once around');
  await closeQuietly(page);
});
