// What fits its place: measured in each language, on each size of screen.
import assert from 'node:assert/strict';
import {speak} from './browser.mjs';

/** Language and size in pairs: each language on a wide and a narrow screen, each size in its longest words. */
export const kScreens = [['en', 1280, 800], ['en', 390, 844], ['fr', 1024, 600], ['fr', 820, 1180], ['fr', 390, 844], ['de', 1280, 800], ['de', 1024, 600],
                  ['de', 820, 1180]];
export const kViews = ['Alt+Digit1', 'Alt+Digit2', 'Alt+Digit3', 'Alt+Digit4'];

/** What is outside the screen or wider than its box; a table scrolls in its own place, and a name is cut on purpose. */
export const misfits = (of) => of.evaluate(() => {
  const found = [];
  const document_ = document.documentElement;
  if (document_.scrollWidth > innerWidth || document_.scrollHeight > innerHeight) found.push(`the document is ${document_.scrollWidth} x ${document_.scrollHeight}`);
  for (const element of document.querySelectorAll('body *')) {
    const scroll = element.closest('.scroll');
    if ((scroll && scroll !== element) || element.closest('.visually-hidden, .uplot, .one-line') || element.matches('.count')) continue;
    const {left, right, width} = element.getBoundingClientRect();
    if (width === 0) continue;
    const words = `${element.tagName} ${element.getAttribute('class') ?? ''} "${element.textContent.slice(0, 30)}"`;
    if (left < -1 || right > innerWidth + 1) found.push(`${words} is at ${Math.round(left)} to ${Math.round(right)}`);
    const isBox = getComputedStyle(element).display !== 'inline' && element !== scroll && element.clientWidth > 0;
    if (isBox && element.scrollWidth > element.clientWidth + 1) found.push(`${words}: ${element.scrollWidth} in ${element.clientWidth}`);
  }
  return found.slice(0, 5);
});

/** Buttons, and header and views, in each other's way. */
export const overlaps = (of) => of.evaluate(() => {
  const boxes = [...document.querySelectorAll('header > *, nav > *, .run-controls button')].map((element) => [element, element.getBoundingClientRect()])
      .filter(([, {width, height}]) => width > 0 && height > 0);
  const found = [];
  for (const [one, a] of boxes) {
    for (const [other, b] of boxes) {
      const isOver = a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1;
      if (one !== other && isOver) found.push(`${one.textContent.slice(0, 20)} over ${other.textContent.slice(0, 20)}`);
    }
  }
  return found;
});

/** Curves follow the size of their place a picture later. */
export const settled = (of) => of.evaluate(async () => {
  for (let i = 0; i < 3; ++i) await new Promise((done) => requestAnimationFrame(done));
});

export async function expectFits(of, where, views = kViews) {
  for (const [language, width, height] of kScreens) {
    await speak(of, language);
    await of.setViewportSize({width, height});
    for (const view of views) {
      await of.keyboard.press(view);
      await settled(of);
      const found = [...await misfits(of), ...await overlaps(of)];
      assert.deepEqual(found, [], `${where}, ${language}, ${width} x ${height}, ${view}`);
    }
  }
  await speak(of, 'en');
  await of.setViewportSize({width: 1280, height: 800});
}
