// Several pages of one cell, and hands that hold no mouse.
import assert from 'node:assert/strict';
import {after, before} from 'node:test';
import {expectAccessible, openBrowser, openPage, pauseButton, speak, start, startButton, step, stopButton, waitForState} from './browser.mjs';
import {Cell} from './cell.mjs';

let cell, browser;
before(async () => {
  cell = await Cell.start({speed: 50});
  browser = await openBrowser();
});
after(async () => {
  await browser?.close();
  await cell?.stop();
});

step('APageWithoutATokenWatchesOnly', async () => {
  const page = await openPage(browser, cell.url);
  await page.locator('.watching', {hasText: 'touchcal page'}).waitFor();
  await waitForState(page, 'Ready');
  for (const button of [startButton(page), pauseButton(page), stopButton(page)]) assert.ok(await button.isDisabled());
  await expectAccessible(page, 'watching');
  const viewer = await openPage(browser, `${cell.url}/#token=${cell.viewToken}`);
  await viewer.locator('.watching', {hasText: 'may only read'}).waitFor();
});

step('TheButtonsAreLargeAndFarApartAndTheMainViewNeedsNoScrolling', async () => {
  const page = await openPage(browser, cell.link);
  await waitForState(page, 'Ready');
  for (const language of ['en', 'fr', 'de']) {
    await speak(page, language);
    const boxes = [];
    for (const button of [startButton(page), pauseButton(page), stopButton(page)]) boxes.push(await button.boundingBox());
    for (const {width, height} of boxes) assert.ok(width >= 72 && height >= 72, `${width} x ${height}`);
    const k12mm_px = (12 / 25.4) * 96;
    for (let i = 0; i + 1 < boxes.length; ++i) assert.ok(boxes[i + 1].y - boxes[i].y - boxes[i].height >= k12mm_px);
    assert.ok(boxes[2].y + boxes[2].height <= 600);
    const others = await page.locator('button:not(.run), select, .choice, input[type=text]').all();
    assert.ok(others.length > 5);
    for (const other of others) {
      const box = await other.boundingBox();
      if (box) assert.ok(box.height >= 44 && box.width >= 44, `${await other.textContent()}: ${box.width} x ${box.height}`);
    }
    const overflow = await page.evaluate(() => {
      const main = document.querySelector('main');
      return Math.max(main.scrollHeight - main.clientHeight, document.documentElement.scrollHeight - 600,
                      document.documentElement.scrollWidth - 1024);
    });
    assert.ok(overflow <= 0, `${language}: ${overflow} px too much`);
  }
});

step('TwoPagesShowTheSameAndBothMayAct', async () => {
  const one = await openPage(browser, cell.link);
  const other = await openPage(browser, cell.link);
  await one.getByText('quick', {exact: true}).click();
  const celsius = one.getByLabel('Block, °C');
  assert.equal(await celsius.inputValue(), '20', 'as the block\u2019s file has it');
  await celsius.fill('25.5');
  const moving = one.getByLabel('Arm moving, min');
  await moving.fill('45');
  await start(one);
  await waitForState(other, ['Starting…', 'Running']);
  await waitForState(other, 'Running');
  await pauseButton(other).click();
  await waitForState(one, 'Paused');
  const total = async (page) => (await page.locator('header .count').textContent()).split(' · ')[0];
  await waitForState(other, 'Paused');
  assert.equal(await total(one), await total(other));
  const {conditions} = await cell.get(`/api/v1/runs/${(await cell.get('/api/v1/status')).run_id}`);
  assert.deepEqual([conditions.block_temperature_c, conditions.std_temperature_k, conditions.block_temperature_source], [25.5, 1, 'run']);
  assert.equal(conditions.arm_moving_min, 45);
  await stopButton(one).click();
  await waitForState(other, 'Stopped');
  await waitForState(one, 'Stopped');
  await one.keyboard.press('Alt+Digit1');
  assert.equal(await celsius.inputValue(), '20', 'it was for that run');
  assert.equal(await moving.inputValue(), '', 'so were they');
});

step('APageThatIsLoadedInTheMiddleOfARunHasTheCurvesFromItsBeginning', async () => {
  await cell.post('/api/v1/cell/reset');
  await cell.status(({state}) => state === 'IDLE');
  await cell.post('/api/v1/runs', {recipe: 'quick'});
  await cell.status(({condition_number}) => condition_number !== null);
  const page = await openPage(browser, cell.link);
  await page.getByRole('button', {name: /^Live/}).click();
  await page.getByRole('img', {name: /Condition number over touches: \d/}).waitFor();
  await cell.post('/api/v1/cell/stop');
  await cell.status(({state}) => state === 'STOPPED');
});

step('EverythingIsDoneByKeyboardAlone', async () => {
  const page = await openPage(browser, cell.link);
  await waitForState(page, 'Stopped');
  const focused = () => page.evaluate(() => document.activeElement?.textContent?.trim() ?? '');
  const tabTo = async (words) => {
    for (let i = 0; i < 60; ++i) {
      await page.keyboard.press('Tab');
      if (!words.test(await focused())) continue;
      const outline = await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle);
      assert.notEqual(outline, 'none', 'the focus does not show');
      return;
    }
    assert.fail(`${words} cannot be reached`);
  };
  await tabTo(/^RESET/);
  await page.keyboard.press('Enter');
  await waitForState(page, 'Ready');
  await page.keyboard.press('Alt+Digit4');
  await page.locator('.history-view').waitFor();
  await page.keyboard.press('Alt+Digit1');
  await page.locator('.cell-view').waitFor();
  await page.locator('.run-controls .run.main:not([disabled])', {hasText: 'START'}).waitFor();
  await tabTo(/^START/);
  await page.keyboard.down('Space');
  await waitForState(page, ['Starting…', 'Running']);
  await page.keyboard.up('Space');
  await waitForState(page, 'Running');
  await page.keyboard.press('Alt+KeyP');
  await waitForState(page, 'Paused');
  await tabTo(/^RESUME/);
  await page.keyboard.down('Enter');
  await waitForState(page, ['Resuming…', 'Running']);
  await page.keyboard.up('Enter');
  await waitForState(page, 'Running');
  await page.keyboard.press('Alt+KeyS');
  await waitForState(page, 'Stopped');
});
