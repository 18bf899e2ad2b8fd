// The cells of the plant's archive on the page of one of them.
import assert from 'node:assert/strict';
import {after, before} from 'node:test';
import {Archive} from './archive.mjs';
import {closeQuietly, expectAccessible, expectQuiet, openBrowser, openPage, speak, step} from './browser.mjs';
import {Cell} from './cell.mjs';
import {kScreens, misfits} from './fits.mjs';

let archive, cell, other, browser;
before(async () => {
  archive = await Archive.start();
  cell = await Cell.start({daemonOptions: ['--archive', archive.url]});
  browser = await openBrowser();
});
after(async () => {
  await browser?.close();
  await cell?.stop();
  await other?.stop();
  await archive?.stop();
});

const fleet = (page) => page.locator('.fleet');
const rowOf = (page, name) => fleet(page).locator('tbody tr').filter({has: page.locator('th', {hasText: name})});

async function openFleet(options = {}) {
  const page = await openPage(browser, cell.url, options);
  await page.locator('header h1').waitFor();
  await page.keyboard.press('Alt+Digit4');
  await fleet(page).getByRole('button', {name: 'Show the cells of the archive'}).click();
  await rowOf(page, 'paint-shop-2').waitFor();
  return page;
}

step('TheHistoryEndsWithTheCellsOfTheArchive', async () => {
  const run = await cell.post('/api/v1/runs', {recipe: 'quick'});
  await cell.post(`/api/v1/runs/${run.id}/abort`);
  await cell.status(({state, archive_behind}) => state === 'ABORTED' && archive_behind === 0);
  const page = await openFleet();
  const row = rowOf(page, 'paint-shop-2');
  for (const words of ['idle', 'tx60', 'Accepted', '0123456789ab', '0.063', 'fedcba987654', 'pick.dtx on the robot', 'Rejected'])
    await row.getByText(words).first().waitFor();
  await rowOf(page, 'demo').waitFor();
  assert.equal(await fleet(page).locator('table').count(), 2);
  await fleet(page).locator('table').nth(1).getByText('12.5').waitFor();
  await expectAccessible(page, 'fleet');
  expectQuiet(page, cell);
  await closeQuietly(page);
});

step('ItFitsOnEachScreenInEachLanguage', async () => {
  const page = await openFleet();
  for (const [language, width, height] of kScreens) {
    await page.setViewportSize({width, height});
    await speak(page, language);
    assert.deepEqual(await misfits(page), [], `${language} at ${width} x ${height}`);
  }
  await closeQuietly(page);
});

step('AnArchiveThatIsAwayIsSaidToBe', async () => {
  const page = await openFleet();
  await archive.takeAway();
  // What was asked a moment ago is not asked again yet: the daemon of another start has asked nothing.
  await cell.killDaemon();
  await cell.restartDaemon();
  await fleet(page).getByRole('button', {name: 'Ask the archive again'}).click();
  await fleet(page).getByText('The cells cannot be shown').waitFor();
  await closeQuietly(page);
});

step('WithoutAnArchiveThereIsNothingToAsk', async () => {
  other = await Cell.start();
  const page = await openPage(browser, other.url);
  await page.locator('header h1').waitFor();
  await page.keyboard.press('Alt+Digit4');
  await page.getByText('No run has been made').waitFor();
  assert.equal(await fleet(page).count(), 0);
  await closeQuietly(page);
});
