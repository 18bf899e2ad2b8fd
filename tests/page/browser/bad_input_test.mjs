// Texts that are not meant well, tokens and clocks that are wrong: shown as text, said in words, never a blank page.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {closeQuietly, expectAccessible, openBrowser, openPage, openWith, pauseButton, startButton, stopButton, waitForState} from './browser.mjs';
import {Cell} from './cell.mjs';

const kHostile = '<img src=x onerror="window.taken=1"><script>window.taken=1</script>&amp;\u202e';
const kLong = 'long '.repeat(2000);
const kUnbroken = 'N'.repeat(10000);

let cell, browser;
before(async () => {
  cell = await Cell.start();
  browser = await openBrowser();
});
after(async () => {
  await browser?.close();
  await cell?.stop();
});

test('MarkupOfTheRobotIsTextAndALongTextIsCutWithAWayToSeeAll', async () => {
  const page = await openWith(browser, cell, {
    '/api/v1/status': (status) => ({...status, sequence: status.sequence + 5, state: 'HELD', run_id: '1', recipe: kHostile + kUnbroken, fault_code: kHostile,
                                    fault_message: kHostile + kLong, fault_robot_action: kHostile, fault_next_step: kHostile,
                                    warning_code: 'x', warning_message: kUnbroken, more_would_bring: kHostile, waiting_for: kHostile,
                                    touches_total: 90, eta_s: 0, controller_connected: false}),
    '/api/v1/cell': (document) => ({...document, name: kHostile + kUnbroken}),
    '/api/v1/recipes': (document) => ({default: kHostile, recipes: [{...document.recipes[0], name: kHostile, description: kLong},
                                                                       {...document.recipes[0], name: kUnbroken}]}),
  });
  const card = page.locator('.card.fault');
  await card.waitFor();
  assert.ok((await card.textContent()).includes('<img src=x onerror='));
  assert.equal(await page.locator('img, main script').count(), 0);
  assert.equal(await page.evaluate('window.taken'), undefined);
  const more = card.getByRole('button', {name: /show all \d+ characters/});
  assert.ok((await card.textContent()).length < 3000);
  await more.click();
  assert.ok((await card.textContent()).length > kLong.length);
  await expectAccessible(page, 'hostile texts');
  const {width} = await page.locator('main').boundingBox();
  assert.ok(width < 1024, 'a long text does not push the buttons away');
  await page.locator('header .count', {hasText: 'time left unknown'}).waitFor();
  await page.locator('.run-controls .run.main[disabled]', {hasText: 'no link to the controller'}).waitFor();
  assert.equal(await page.getByRole('button', {name: /Touch again|Skip this touch/}).count(), 0, 'no touch holds the run');
  const header = await page.locator('header').boundingBox();
  assert.ok(header.y + header.height < 100, `the header is ${header.height} px high`);
  const area = await page.locator('.run-controls').boundingBox();
  for (const button of [startButton(page), pauseButton(page), stopButton(page)]) {
    const {x, y, width: wide, height} = await button.boundingBox();
    assert.ok(x >= area.x && x + wide <= 1024 && y >= header.y + header.height && y + height <= 600, 'the run buttons stay in their place');
  }
  await page.getByRole('button', {name: /^Cell/}).click();
  await page.locator('.recipe .choice', {hasText: 'NNN'}).waitFor();
  const wider = await page.evaluate(() => document.querySelector('main').scrollWidth - document.querySelector('main').clientWidth);
  assert.ok(wider <= 0, `the cell view is ${wider} px too wide`);
  await expectAccessible(page, 'hostile names');
  assert.deepEqual(page.complaints, []);
  await closeQuietly(page);
});

test('AStaleTokenIsSaidInWordsAndThePageWatches', async () => {
  const page = await openPage(browser, `${cell.url}/#token=${'0'.repeat(64)}`);
  await page.getByText('This access code is no longer taken').waitFor();
  await waitForState(page, 'Ready');
  assert.ok(await startButton(page).isDisabled());
  assert.ok(await stopButton(page).isDisabled());
  await expectAccessible(page, 'stale token');
  assert.deepEqual(page.complaints, []);
  await page.goto(cell.link);
  await page.reload();
  await page.locator('.run-controls .run.main:not([disabled])').waitFor();
});

for (const [words, offset_ms] of [['AnHourAhead', 3.6e6], ['TenYearsBehind', -3.2e11]]) {
  test(`AClockThatIs${words}ChangesNoAge`, async () => {
    const page = await openPage(browser, 'about:blank');
    await page.addInitScript((offset) => {
      const now = Date.now.bind(Date);
      Date.now = () => now() + offset;
    }, offset_ms);
    await page.goto(cell.link);
    await waitForState(page, 'Ready');
    // Age and words are looked at in one picture: a busy machine's next one may be older.
    await page.waitForFunction(() => {
      const link = document.querySelector('header .link');
      const age = link?.querySelector('[data-age]')?.dataset.age;
      return age !== undefined && age !== '' && Number(age) < 2000 && /Data age\s*(< 1 s|1 s)/.test(link.textContent);
    });
  });
}

test('ABrowserThatKeepsNothingAndDrawsNothingStillOperates', async () => {
  const page = await openPage(browser, 'about:blank');
  await page.addInitScript(() => {
    const refuse = () => { throw new DOMException('refused', 'SecurityError'); };
    Object.defineProperty(window, 'localStorage', {get: refuse});
    HTMLCanvasElement.prototype.getContext = ((own) => function (kind, ...rest) {
      return kind.startsWith('webgl') ? null : own.call(this, kind, ...rest);
    })(HTMLCanvasElement.prototype.getContext);
  });
  await page.goto(cell.link);
  await page.locator('.run-controls .run.main:not([disabled])').waitFor();
  await page.getByRole('button', {name: /^Live/}).click();
  await page.getByText('WebGL is missing').waitFor();
  await page.reload();
  await page.locator('.run-controls .run.main:not([disabled])').waitFor();
  assert.deepEqual(page.complaints, []);
});

test('WithoutEventsThePageAsksAndIsStillRight', async () => {
  const page = await openWith(browser, cell, {});
  await page.locator('header .link', {hasText: 'Polling'}).waitFor();
  await cell.post('/api/v1/cell/stop');
  await waitForState(page, 'Stopped');
  await cell.post('/api/v1/cell/reset');
  await waitForState(page, 'Ready');
  await closeQuietly(page);
});

test('AStreamThatBringsNothingMoreIsLeftForAsking', async () => {
  const page = await openPage(browser, 'about:blank');
  await page.addInitScript(() => {
    const own = window.fetch.bind(window);
    const beginning = new TextEncoder().encode('retry: 2000\n\n');
    window.fetch = (address, options) => {
      if (address !== '/api/v1/events') return own(address, options);
      return Promise.resolve(new Response(new ReadableStream({
        start(stream) {
          stream.enqueue(beginning);
          options.signal.addEventListener('abort', () => stream.error(new Error('hung up')));
        },
      })));
    };
  });
  await page.goto(cell.link);
  await waitForState(page, 'Ready');
  await page.locator('header .link dd', {hasText: 'Live'}).waitFor();
  await cell.post('/api/v1/cell/stop');
  await page.locator('header .link dd', {hasText: 'Polling'}).waitFor();
  await waitForState(page, 'Stopped');
  await cell.post('/api/v1/cell/reset');
  await waitForState(page, 'Ready');
  assert.deepEqual(page.complaints, []);
});
