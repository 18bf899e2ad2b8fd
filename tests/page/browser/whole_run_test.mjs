// A person's way through a calibration: from the link to the report.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {after, before} from 'node:test';
import {closeQuietly, expectAccessible, expectQuiet, openBrowser, openPage, openWith, speak, start, startButton, step, waitForState} from './browser.mjs';
import {Cell} from './cell.mjs';

/** As if the page's tab were in front, or behind another. */
const show = (page, isShown) => page.evaluate((hidden) => {
  Object.defineProperty(document, 'hidden', {configurable: true, get: () => hidden});
  document.dispatchEvent(new Event('visibilitychange'));
}, !isShown);

let cell, browser, page;
before(async () => {
  cell = await Cell.start({speed: 250});
  browser = await openBrowser();
  page = await openPage(browser, cell.link);
});
after(async () => {
  await browser?.close();
  await cell?.stop();
});

step('TheTokenLeavesTheAddressAndStays', async () => {
  await page.locator('.readiness li.met').first().waitFor();
  assert.equal(page.url(), `${cell.url}/`);
  await page.reload();
  await page.locator('.run-controls .run.main:not([disabled])').waitFor();
  assert.equal(await page.locator('.watching').count(), 0);
});

step('TheCellIsShownReadyWithEveryCondition', async () => {
  await waitForState(page, 'Ready');
  assert.equal(await page.locator('.readiness li').count(), 7);
  assert.equal(await page.locator('.readiness li.unmet, .readiness li.unknown').count(), 0);
  await expectAccessible(page, 'ready');
});

step('ARecipeTellsItsDurationAndAccuracy', async () => {
  await page.getByText('quick', {exact: true}).click();
  const accuracy = page.locator('.recipe dl div', {hasText: 'Predicted tip error'}).locator('dd');
  await page.waitForFunction(() => /\d min/.test(document.querySelector('.recipe dl')?.textContent ?? ''));
  assert.match(await accuracy.textContent(), /^0\.\d{3} mm$/);
});

step('AButtonThatIsLetGoTooEarlyStartsNothing', async () => {
  const shown = await startButton(page).evaluate(async (button) => {
    const frame = () => new Promise((done) => requestAnimationFrame(done));
    button.dispatchEvent(new PointerEvent('pointerdown', {bubbles: true, button: 0}));
    while (!button.textContent.includes('keep holding')) await frame();
    button.dispatchEvent(new PointerEvent('pointerup', {bubbles: true}));
    while (button.textContent.includes('keep holding')) await frame();
    return button.textContent;
  });
  assert.match(shown, /hold for 1.5 s/);
  assert.equal((await cell.get('/api/v1/runs')).runs.length, 0);
});

step('TheRunIsWatchedToItsEnd', async () => {
  await start(page);
  await waitForState(page, ['Starting…', 'Running']);
  await page.locator('.live-view canvas').waitFor();
  await page.waitForFunction(() => /Touch \d+ of 90/.test(document.querySelector('header .count')?.textContent ?? ''));
  await page.locator('.curve canvas').first().waitFor();
  await page.locator('.residuals tbody tr').first().waitFor();
  await expectAccessible(page, 'live');
  await waitForState(page, 'Complete');
});

step('TheViewDrawsTheCell', async () => {
  await page.getByRole('button', {name: /^Live/}).click();
  const canvas = page.locator('.scene canvas');
  await page.locator('.scene .over').waitFor({state: 'detached'});
  const colors = async () => new Set(await canvas.evaluate((element) => {
    const gl = element.getContext('webgl');
    // Read in the frame in which it was drawn: behind it the picture is gone.
    element.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowLeft', bubbles: true}));
    return new Promise((done) => requestAnimationFrame(() => {
      const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
      gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      const seen = [];
      for (let i = 0; i < pixels.length; i += 400) seen.push(`${pixels[i]} ${pixels[i + 1]} ${pixels[i + 2]}`);
      done(seen);
    }));
  }));
  assert.ok((await colors()).size > 5, 'a plain area is no cell');
  await page.locator('.scene figcaption', {hasText: '90 touched, 0 to come'}).waitFor();
  const overflow = await page.evaluate(() => document.querySelector('main').scrollHeight - document.querySelector('main').clientHeight);
  assert.ok(overflow <= 0, `the live view is ${overflow} px too high for a small screen`);
});

step('TheResultSaysTheVerdictInWordsAndShowsEveryError', async () => {
  await page.getByRole('button', {name: /^Result/}).click();
  const run = (await cell.get('/api/v1/runs')).runs[0];
  const words = {accepted: 'Accepted', rejected: 'Rejected', incomplete: 'Incomplete'}[run.verdict];
  await page.locator('.verdict', {hasText: words}).waitFor();
  const result = await cell.get(`/api/v1/runs/${run.id}/result`);
  assert.equal(await page.locator('table.errors tbody tr').count(), result.parameters.length);
  const found = result.parameters.find(({status}) => status === 'identified');
  const row = page.locator('table.errors tbody tr', {has: page.getByRole('rowheader', {name: found.name, exact: true})});
  await row.filter({hasText: found.error.toFixed(found.unit === 'rad' ? 5 : 3)}).waitFor();
  const {expanded, arm_frame} = result.tip_uncertainty;
  const shown = await page.locator('table.tip-expanded tbody tr').evaluateAll((rows) => rows.map((one) => [...one.querySelectorAll('td')].map((cell) => cell.textContent)));
  assert.deepEqual(shown, [expanded, arm_frame.expanded].map((of) => [of.box_rms_mm, of.box_p95_mm, of.box_max_mm].map((mm) => mm.toFixed(3))));
  assert.equal(await page.locator('section:has(table.tip-expanded) ~ section:has(dl.figures)').count(), 1, 'k = 2 stands first');
  assert.equal(await page.locator('.map .layers figure').count(), result.tip_uncertainty.map.counts[1]);
  await expectAccessible(page, 'result');
});

step('TheReportIsCarriedAwayAsAFile', async () => {
  for (const [name, sign] of [['Report (HTML)', /<html/], ['Report (CSV)', /,/], ['Calibrated arm (JSON)', /touchcal\/arm\/\d/]]) {
    const saved = page.waitForEvent('download');
    await page.getByRole('button', {name}).click();
    const file = await (await saved).path();
    assert.match(readFileSync(file, 'utf8'), sign, name);
  }
});

step('TwoRunsAreComparedAndDrawnAsATrend', async () => {
  await page.getByRole('button', {name: /^History/}).click();
  await page.getByRole('button', {name: 'Show 1'}).click();
  await page.locator('.which h2', {hasText: 'Run 1, recipe quick'}).waitFor();
  const asleep = await openPage(browser, cell.link);
  await waitForState(asleep, 'Complete');
  await show(asleep, false);
  await start(page);
  await waitForState(page, ['Starting…', 'Running']);
  // The state comes by the event stream, the focus moves with the answer to the start: either may be first.
  await page.waitForFunction(() => document.activeElement?.tagName === 'H1');
  await waitForState(page, 'Complete');
  await page.locator('.which h2', {hasText: 'Run 2, recipe quick'}).waitFor();
  await waitForState(asleep, 'Complete');
  assert.equal(await asleep.locator('table.errors').count(), 0, 'a page that nobody sees asks for no result');
  await show(asleep, true);
  await asleep.locator('table.errors').waitFor();
  await asleep.context().close();
  await page.getByRole('button', {name: /^History/}).click();
  await page.getByRole('button', {name: 'Show 1'}).click();
  await page.locator('.which.card', {hasText: 'Run 1, an earlier one'}).waitFor();
  await expectAccessible(page, 'an earlier run');
  await page.getByRole('button', {name: 'Show the newest'}).click();
  await page.locator('.which h2', {hasText: 'Run 2, recipe quick'}).waitFor();
  await page.getByRole('button', {name: /^History/}).click();
  await page.getByLabel('Compare 1').check();
  await page.getByLabel('Compare 2').check();
  const comparison = page.getByRole('region', {name: 'Comparison of runs 1 and 2'});
  for (const part of ['Arm: as it was', 'Stylus: as it was']) await comparison.getByText(part).waitFor();
  await comparison.getByText(/bring the tip 0\.\d{3} mm apart/).waitFor();
  assert.equal(await comparison.getByRole('table', {name: 'Where they differ most'}).getByRole('rowheader', {name: 'Arm'}).count(), 5);
  const compared = comparison.getByRole('table', {name: 'Figures of both runs'});
  for (const row of ['Verdict', 'Check touches of plane 3, rms']) await compared.getByRole('row', {name: row}).waitFor();
  await page.locator('.history-view .curve canvas').waitFor();
  await page.getByLabel('Trend of').selectOption('plane 3');
  await page.getByRole('img', {name: /Check touches of plane 3, rms, mm/}).waitFor();
  await expectAccessible(page, 'history');
});

/** As the daemon tells the checks of run 1; of which one is beyond its limit, and one was not accepted. */
const checksTold = (changes) => {
  const points = Array.from({length: 12}, (_, i) => ({
    run: String(i + 3), value: i === 11 ? 0.2 : 0.01 * (i % 2), weighted_mean: i < 10 ? null : 0.01, shewhart_limit: i < 10 ? null : 0.05,
    ewma_limit: i < 10 ? null : 0.02, beyond_shewhart: i === 11, beyond_ewma: false,
  }));
  const row = (run, accepted) => ({run, ended_at: '2026-11-13T00:00:00.000Z', operator: null, reference: false, accepted, cause: accepted ? null : 'block', joint: null});
  return {
    schema: 'touchcal/checks/1', of_run: '1', count: 15, reference: {count: 3, needed: 3}, base: {count: 10, needed: 10}, every_days: 7,
    due_at: '2026-11-20T00:00:00.000Z', overdue: false, warnings: ['run 14: it differs'], checks: [row('13', false), row('14', true)],
    charts: [{quantity: 'joint_3', unit: 'mrad', centre: 0.005, points}, {quantity: 'growth', unit: 'ppm', centre: null, points: []}], ...changes,
  };
};

/** Ten minutes later, by the clock of the page; it asks for the checks again. */
const tenMinutesLater = (page) => page.evaluate(() => {
  const now = performance.now.bind(performance);
  performance.now = () => now() + 600000;
});

step('WithoutAnApprovedCalibrationOrARuleNoCheckIsDue', async () => {
  await page.getByRole('button', {name: /^Cell/}).click();
  await page.locator('.readiness li').first().waitFor();
  assert.equal(await page.locator('.next-check').count(), 0);
});

step('ACheckIsShownFromTheHistoryWithTheChecksBeforeItAsACurveWithLimits', async () => {
  let told = checksTold({});
  const checked = await openWith(browser, cell, {
    '/api/v1/runs?limit=50': (document) => ({...document, runs: document.runs.map((run) => (run.id === '1' ? {...run, kind: 'check', of_run: '1'} : run))}),
    '/api/v1/runs/1/result': () => ({
      schema: 'touchcal/check/1', of_run: '1', touch_count: 12, complete: true, verdict: {accepted: true, reasons: []}, rms_mm: 0.004, p: 0.5, p_min: 0.005,
      noise_um: 3.2, reference: {count: 3, needed: 3}, joints: [{joint: 3, offset_mrad: 0.2, std_offset_mrad: 0.01}], growth_ppm: 2, warmer_k: 0.1,
    }),
  });
  await checked.route((url) => url.pathname === '/api/v1/checks', (route) => (told ? route.fulfill({json: told})
      : route.fulfill({status: 503, json: {type: 'about:blank', title: 'x', status: 503, detail: 'the store does not answer'}})));
  await checked.getByRole('button', {name: /^History/}).click();
  await checked.getByRole('row', {name: 'check of run 1'}).getByRole('button', {name: 'Show 1'}).click();
  const checks = checked.getByRole('region', {name: 'Checks of run 1'});
  await checks.getByText('The next check is due on 2026-11-20 00:00:00 (UTC).').waitFor();
  await checks.getByText('run 14: it differs').waitFor();
  await checks.getByText('first check again').waitFor();
  await checks.getByText('The newest 2 of 15 checks are shown').waitFor();
  await checks.getByRole('img', {name: 'Joint 3, if it alone had changed, mrad: 0.200'}).waitFor();
  for (const line of ['Run', 'Value', 'Weighted mean', 'Upper limit', 'Lower limit', 'Upper limit of the mean', 'Lower limit of the mean'])
    await checks.locator('.u-legend .u-label', {hasText: new RegExp(`^${line}$`)}).waitFor();
  const marked = checks.getByRole('table', {name: 'Marked checks'}).locator('tbody tr');
  assert.deepEqual(await marked.getByRole('rowheader').allTextContents(), ['14', '13']);
  await marked.nth(0).filter({hasText: 'Joint 3, if it alone had changed: 0.200 mrad is beyond the limit 0.055 mrad'}).waitFor();
  await marked.nth(1).filter({hasText: 'Changed: the block'}).waitFor();
  await expectAccessible(checked, 'the checks of a calibration');
  await checks.getByLabel('Chart of').selectOption('growth');
  await checks.getByText('once two checks have been compared').waitFor();
  told = checksTold({overdue: true});
  await tenMinutesLater(checked);
  await checks.getByText('A check was due on 2026-11-20 00:00:00 (UTC). Check the cell now.').waitFor();
  await checked.getByRole('button', {name: /^Cell/}).click();
  await checked.locator('.cell-view .next-check', {hasText: 'A check was due on 2026-11-20'}).waitFor();
  await expectAccessible(checked, 'a check is overdue');
  told = checksTold({due_at: null, overdue: null});
  await tenMinutesLater(checked);
  await checked.locator('.cell-view .next-check', {hasText: 'not known: the clock'}).waitFor();
  told = null;
  await tenMinutesLater(checked);
  await checked.locator('.cell-view .next-check', {hasText: 'the store does not answer'}).waitFor();
  await checked.getByRole('button', {name: /^Result/}).click();
  await checked.locator('.result-view .next-check', {hasText: 'The checks cannot be shown: the store does not answer'}).waitFor();
  await closeQuietly(checked);
});

step('FrenchAndDarkAreOneTouchEachAndStay', async () => {
  await speak(page, 'fr');
  await page.getByRole('button', {name: 'Sombre'}).click();
  await page.reload();
  await waitForState(page, 'Terminé');
  assert.equal(await page.locator('html').getAttribute('lang'), 'fr');
  await page.getByRole('button', {name: /^Résultat/}).click();
  await page.locator('table.errors tbody tr').first().waitFor();
  for (const view of [/^Cellule/, /^En direct/, /^Résultat/, /^Historique/]) {
    await page.getByRole('button', {name: view}).click();
    await expectAccessible(page, `dark, French, ${view}`);
  }
  expectQuiet(page, cell);
});

step('ACheckIsStartedLikeARun', async () => {
  const checking = await openPage(browser, cell.link);
  await speak(checking, 'en');
  await checking.getByRole('button', {name: /^Cell/}).click();
  await checking.getByRole('radio', {name: 'Check'}).check();
  await checking.getByText('The first three checks of a calibration are its reference.').waitFor();
  assert.equal(await checking.getByRole('radiogroup', {name: 'Recipe'}).count(), 0, 'it has that of its calibration');
  await expectAccessible(checking, 'a check before its start');
  await start(checking, 'CHECK');
  await waitForState(checking, 'Complete');
  await checking.getByText('reference check 1 of 3').waitFor();
  await checking.getByRole('button', {name: /^Cell/}).click();
  assert.equal(await checking.getByRole('radio', {name: 'Calibration'}).isChecked(), true, 'the next start is a calibration again');
  await closeQuietly(checking);
});

step('AQualificationIsStartedLikeARunAndShowsEachFigureByItsLimit', async () => {
  const qualifying = await openPage(browser, cell.link);
  await speak(qualifying, 'en');
  await qualifying.getByRole('button', {name: /^Cell/}).click();
  await qualifying.getByRole('radio', {name: 'Qualification'}).check();
  await qualifying.getByText('ten of one place, eight turns of the stylus').waitFor();
  await start(qualifying, 'QUALIFY');
  // The state was Complete before, by the check: what tells of this run is its result.
  await qualifying.getByText('25 touches, held against the calibration of run').waitFor();
  await waitForState(qualifying, 'Complete');
  const {id, kind, verdict} = (await cell.get('/api/v1/runs')).runs[0];
  assert.equal(kind, 'qualification');
  await qualifying.locator('.verdict .word', {hasText: verdict === 'accepted' ? 'Qualified' : 'Not qualified'}).waitFor();
  const {criteria} = await cell.get(`/api/v1/runs/${id}/result`);
  const rows = qualifying.locator('.result-view table tbody tr');
  assert.equal(await rows.count(), criteria.length);
  await rows.filter({hasText: 'Run-out of the ball'}).filter({hasText: '≤ 1.0000 mm: Pass'}).waitFor();
  await rows.filter({hasText: 'Known length between planes 3 and 5: off by'}).waitFor();
  await expectAccessible(qualifying, 'a qualification');
  await closeQuietly(qualifying);
});
