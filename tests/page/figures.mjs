// node figures.mjs: what the page weighs and how fast it is, measured in Debian's chromium against a simulated cell.
// Of the build in build/, unless the environment says as for run.mjs. The view is drawn by software here: a graphics card draws at least as fast.
import {openBrowser, openPage, start, waitForState} from './browser/browser.mjs';
import {Cell} from './browser/cell.mjs';

const kTries = 5;
const kTouches = 1000;

const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
const tell = (name, value, goal) => console.log(`${name.padEnd(46)} ${String(value).padStart(10)}   goal ${goal}`);

const cell = await Cell.start();
const browser = await openBrowser();

/** Bytes over the wire of all that the page has loaded from the daemon, without the API's answers. */
const weigh = (page) => page.evaluate(() => {
  const entries = [...performance.getEntriesByType('navigation'), ...performance.getEntriesByType('resource')];
  return entries.filter(({name}) => !name.includes('/api/') && !name.includes('/readyz'))
      .reduce((sum, {encodedBodySize}) => sum + encodedBodySize, 0);
});

async function firstLoad() {
  const paints = [], ready = [];
  let page;
  for (let i = 0; i < kTries; ++i) {
    page = await openPage(browser, cell.link);
    await waitForState(page, 'Ready');
    ready.push(await page.evaluate(() => performance.now()));
    const painted = await page.waitForFunction(() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime);
    paints.push(await painted.jsonValue());
    if (i + 1 < kTries) await page.context().close();
  }
  tell('first load, gzipped, kB', ((await weigh(page)) / 1000).toFixed(1), 'at most 80');
  tell('first paint, ms, median of five', Math.round(median(paints)), 'under 1000');
  tell('shown ready, ms, median of five', Math.round(median(ready)), '-');
  return page;
}

async function turnTheView(page) {
  await page.getByRole('button', {name: /^Live/}).click();
  await page.locator('.scene .over').waitFor({state: 'detached'});
  tell('with the view, gzipped, kB', ((await weigh(page)) / 1000).toFixed(1), 'at most 200');
  const rate = await page.evaluate(async () => {
    const canvas = document.querySelector('.scene canvas');
    const frame = () => new Promise((done) => requestAnimationFrame(done));
    const kFrames = 120;
    await frame();
    const began = performance.now();
    for (let i = 0; i < kFrames; ++i) {
      canvas.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowLeft', bubbles: true}));
      await frame();
      await frame();  // the one that drew it
    }
    return {shown: (1000 * 2 * kFrames) / (performance.now() - began)};
  });
  const drawn = await page.evaluate(async () => {
    // What one picture costs, waited for: the frame's own work without the screen's pace.
    const canvas = document.querySelector('.scene canvas');
    const gl = canvas.getContext('webgl');
    const frame = () => new Promise((done) => requestAnimationFrame(done));
    const costs = [];
    for (let i = 0; i < 60; ++i) {
      canvas.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowLeft', bubbles: true}));
      const began = performance.now();
      await frame();
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
      costs.push(performance.now() - began);
    }
    return costs.sort((a, b) => a - b)[30];
  });
  tell('frames a second while it turns (software GL)', rate.shown.toFixed(0), '60');
  tell('a picture drawn and waited for, ms, median', drawn.toFixed(1), 'under 16.7');
}

async function lag(page) {
  const lags = [];
  for (let i = 0; i < 2 * kTries; ++i) {
    const fault = i % 2 === 0 ? 'touch_stylus' : 'release_stylus';
    const words = i % 2 === 0 ? 'touched' : 'free';
    const shown = page.waitForFunction((text) => [...document.querySelectorAll('.figures dd')].some((dd) => dd.textContent === text), words);
    const began = performance.now();
    await cell.control({fault});
    await shown;
    lags.push(performance.now() - began);
  }
  tell('from the probe to the page, ms, median of ten', Math.round(median(lags)), 'at most 500');
  tell('the slowest of the ten, ms', Math.round(Math.max(...lags)), 'at most 500');
}

async function memory(page) {
  const session = await page.context().newCDPSession(page);
  const used = async () => {
    for (let i = 0; i < 3; ++i) await session.send('HeapProfiler.collectGarbage');
    return (await session.send('Runtime.getHeapUsage')).usedSize / 1e6;
  };
  await page.getByRole('button', {name: /^Cell/}).click();
  await page.getByText('best', {exact: true}).click();
  let touches = 0, warm = 0;
  while (touches < 2 * kTouches) {
    await start(page);
    await waitForState(page, ['Starting…', 'Running']);
    await cell.status(({state}) => state === 'COMPLETE', 120000);
    await waitForState(page, 'Complete');
    touches += (await cell.get('/api/v1/status')).touches_done;
    if (warm === 0 && touches >= kTouches) warm = await used();  // the browser has compiled what it will compile
  }
  tell(`memory behind ${kTouches} touches, MB`, warm.toFixed(1), '-');
  tell(`memory behind ${touches} touches, MB`, (await used()).toFixed(1), 'the same');
}

try {
  const page = await firstLoad();
  await turnTheView(page);
  await lag(page);
  await memory(page);
} finally {
  await browser.close();
  await cell.stop();
}
