// A new cell from the page's form: an error beside its field, the scene, the file of answers, and the cell that is made of it.
import assert from 'node:assert/strict';
import {spawnSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {after, before} from 'node:test';
import {closeQuietly, expectAccessible, expectQuiet, openBrowser, openPage, speak, step} from './browser.mjs';
import {Cell} from './cell.mjs';
import {kScreens, misfits, overlaps, settled} from './fits.mjs';

const programs = process.env.TOUCHCAL_PROGRAMS ?? fileURLToPath(new URL('../../../build/bin', import.meta.url));

let cell, browser, page, folder;
before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'touchcal-setup-'));
  cell = await Cell.start();
  browser = await openBrowser();
});
after(async () => {
  await browser?.close();
  await cell?.stop();
  rmSync(folder, {recursive: true, force: true});
});

const field = (pointer) => page.locator(`.setup-field[data-pointer="${pointer}"]`);
const entries = (pointer) => field(pointer).locator('input[type=text]');
const passes = () => page.locator('.setup-outcome', {hasText: 'The daemon takes these files'}).waitFor();
const download = () => page.getByRole('button', {name: 'Download setup.json'});

async function openForm(of) {
  await of.locator('.account-button').click();
  await of.getByRole('button', {name: 'Set up a cell'}).click();
  await of.locator('.setup-form').waitFor();
}

step('TheFormIsReachedFromTheAccountAndAsksWhatTheCommandAsks', async () => {
  page = await openPage(browser, cell.link, {viewport: {width: 1280, height: 800}});
  await openForm(page);
  const {questions} = await cell.get('/api/v1/setup/questions');
  assert.equal(await page.locator('.setup-field').count(), questions.length);
  for (const {pointer, prompt} of questions) await field(pointer).getByText(prompt, {exact: true}).first().waitFor();
  await passes();
  await page.locator('.setup-scene img').waitFor();
  assert.ok(await page.locator('.guessed').count() > 30, 'nobody has answered anything yet');
  await expectAccessible(page, 'a new cell');
});

step('WhatIsWrongStandsBesideItsFieldUntilItIsMended', async () => {
  await entries('/name').fill('press 3 \u202e\u05ea');
  await entries('/nominal_miss_mm').fill('twelve');
  await field('/nominal_miss_mm').getByText('This is no number').waitFor();
  assert.equal(await entries('/nominal_miss_mm').getAttribute('aria-invalid'), 'true');
  await entries('/nominal_miss_mm').fill('500');
  await field('/nominal_miss_mm').getByText('give 0.1 to 100').waitFor();
  await page.locator('.setup-outcome', {hasText: 'Not yet a cell: 1 to mend'}).waitFor();
  assert.ok(await download().isDisabled());
  await expectAccessible(page, 'an answer that is refused');
  await speak(page, 'de');
  await field('/nominal_miss_mm').getByText('ist 500; geben Sie 0.1 bis 100').waitFor();
  await speak(page, 'en');
  await entries('/nominal_miss_mm').fill('10,5');
  await passes();
  assert.equal(await page.locator('.setup-field.wrong').count(), 0);
  assert.equal(await field('/nominal_miss_mm').locator('.guessed').count(), 0, 'it was given');
  assert.equal(await entries('/nominal_miss_mm').inputValue(), '10,5', 'as it was typed');
});

step('TheSceneFollowsTheAnswers', async () => {
  const drawn = () => page.locator('.setup-scene img').getAttribute('src');
  const before = await drawn();
  await field('/keep_out_boxes').getByRole('button', {name: /Add one/}).click();
  await entries('/keep_out_boxes/1/name').fill('press <b>');
  await page.waitForFunction((old) => decodeURIComponent(document.querySelector('.setup-scene img').src).includes('press &lt;b&gt;')
    && document.querySelector('.setup-scene img').src !== old, before);
  assert.ok(await page.locator('.setup-scene img').evaluate((image) => image.complete && image.naturalWidth > 100), 'it is a picture');
  await entries('/keep_out_boxes/1/max_mm').nth(0).fill('380');  // below the smallest
  await field('/keep_out_boxes/1/max_mm').getByText('is not above').waitFor();
  await entries('/keep_out_boxes/1/max_mm').nth(0).fill('700');
  await passes();
});

step('TheDraftSurvivesAReloadAndFitsEveryScreen', async () => {
  await page.reload();
  await openForm(page);
  assert.equal(await entries('/name').inputValue(), 'press 3 \u202e\u05ea');
  assert.equal(await entries('/keep_out_boxes/1/name').inputValue(), 'press <b>');
  await entries('/block/name').fill('b'.repeat(200));
  for (const [language, width, height] of kScreens) {
    await speak(page, language);
    await page.setViewportSize({width, height});
    await settled(page);
    const found = [...await misfits(page), ...await overlaps(page)].filter((words) => !words.startsWith('INPUT'));  // what is typed scrolls in its field
    assert.deepEqual(found, [], `${language}, ${width} x ${height}`);
  }
  await speak(page, 'fr');
  await field('/name').getByText('Nom de la cellule', {exact: true}).waitFor();
  await speak(page, 'de');
  await field('/name').getByText('Name der Zelle', {exact: true}).waitFor();
  await speak(page, 'en');
  await page.setViewportSize({width: 1280, height: 800});
  await entries('/block/name').fill('block 7');
  await passes();
});

step('TheFileIsTakenByTheCommandWhoseCellPassesTheCheck', async () => {
  await page.locator('.setup-outcome button:not([disabled])', {hasText: 'Download setup.json'}).waitFor();
  const [saved] = await Promise.all([page.waitForEvent('download'), download().click()]);
  assert.equal(saved.suggestedFilename(), 'setup.json');
  const file = join(folder, 'setup.json');
  await saved.saveAs(file);
  const answers = JSON.parse(readFileSync(file, 'utf8'));
  assert.equal(answers.schema, 'touchcal/setup/1');
  assert.equal(answers.nominal_miss_mm, 10.5);
  assert.equal(answers.keep_out_boxes[1].max_mm[0], 700);
  await page.getByText('touchcal setup press-3 --answers setup.json').waitFor();
  const made = spawnSync(join(programs, 'touchcal'), ['setup', 'press-3', '--answers', 'setup.json'], {cwd: folder, encoding: 'utf8'});
  assert.equal(made.status, 0, made.stderr);
  const checked = spawnSync(join(programs, 'touchcald'), ['--cell', join(folder, 'press-3/cell.json'), '--state', join(folder, 'state'), '--check'], {encoding: 'utf8'});
  assert.equal(checked.status, 0, checked.stderr);
  assert.equal(JSON.parse(readFileSync(join(folder, 'press-3/cell.json'), 'utf8')).name, 'press 3 \u202e\u05ea');
});

step('AFileOfAnswersIsLoadedAndAnotherFileIsRefused', async () => {
  await page.getByRole('button', {name: /^Begin anew/}).click();
  await page.getByRole('button', {name: 'Yes, begin anew'}).click();
  await page.waitForFunction(() => document.querySelector('[data-pointer="/name"] input').value === 'cell');
  writeFileSync(join(folder, 'none.json'), '{"schema":"touchcal/cell/3"}');
  await page.locator('input[type=file]').setInputFiles(join(folder, 'none.json'));
  await page.getByText('This file holds no answers of touchcal setup').waitFor();
  await page.locator('input[type=file]').setInputFiles(join(folder, 'press-3/setup.json'));
  await page.getByText('are in the form').waitFor();
  await page.waitForFunction((name) => document.querySelector('[data-pointer="/name"] input').value === name, 'press 3 \u202e\u05ea');
  assert.equal(await entries('/nominal_miss_mm').inputValue(), '10.5');
  await passes();
});

step('AnArmThatIsAtTheCellIsNotLookedForHere', async () => {
  await field('/arm').locator('select').selectOption({label: 'another: a file, a URDF, a table'});
  await field('/arm').getByText('Nothing is given').waitFor();
  await entries('/arm').fill('urdf /etc/passwd base_link tool0');
  await page.getByText('No scene: the arm’s file is at the cell').waitFor();
  await page.locator('.setup-outcome', {hasText: 'Whether the files pass is seen at the cell'}).waitFor();
  await field('/arm/body_radii_mm').waitFor();
  await field('/arm').locator('select').selectOption('tx90');
  await page.locator('.setup-scene img').waitFor();
  expectQuiet(page, cell);
});

step('WhoMayOnlyLookSeesNoFormAndADaemonThatIsLostLosesNoAnswer', async () => {
  const watching = await openPage(browser, `${cell.url}/#token=${cell.viewToken}`);
  await watching.locator('.account-button').click();
  await watching.locator('.account').waitFor();
  assert.equal(await watching.getByRole('button', {name: 'Set up a cell'}).count(), 0);
  await closeQuietly(watching);
  await page.route(`${cell.url}/api/v1/setup/check*`, (route) => route.abort());
  await entries('/name').fill('press 4');
  await page.getByText('The daemon does not answer: it is asked again').waitFor();
  assert.ok(await download().isDisabled(), 'what is drawn is not what is typed');
  await page.unroute(`${cell.url}/api/v1/setup/check*`);
  await page.waitForFunction(() => !document.querySelector('.setup-outcome').textContent.includes('does not answer'));
  await page.locator('.setup-outcome button:not([disabled])', {hasText: 'Download setup.json'}).waitFor();
  await closeQuietly(page);
});
