import assert from 'node:assert/strict';
import {afterEach, test} from 'node:test';
import {dropToken, keepToken, takeToken} from 'page/api/token.ts';

/** What a page keeps things in, with room for so many characters. */
class Place {
  readonly kept = new Map<string, string>();
  constructor(private readonly room: number) {}
  getItem(key: string): string | null {
    return this.kept.get(key) ?? null;
  }
  setItem(key: string, value: string): void {
    const others = [...this.kept].filter(([other]) => other !== key).reduce((sum, [other, text]) => sum + other.length + text.length, 0);
    if (others + key.length + value.length > this.room) throw new DOMException('full', 'QuotaExceededError');
    this.kept.set(key, value);
  }
  removeItem(key: string): void {
    this.kept.delete(key);
  }
}

const kNames = ['localStorage', 'sessionStorage', 'location'] as const;
const kBefore = kNames.map((name) => Object.getOwnPropertyDescriptor(globalThis, name));
afterEach(() => kNames.forEach((name, i) => {
  const before = kBefore[i];
  if (before) Object.defineProperty(globalThis, name, before);
  else Reflect.deleteProperty(globalThis, name);
}));

function browserWith(local: Place | null, session: Place | null): void {
  const define = (name: string, value: unknown): void => {
    Object.defineProperty(globalThis, name, {configurable: true, get: () => {
      if (value === null) throw new DOMException('denied', 'SecurityError');
      return value;
    }});
  };
  define('localStorage', local);
  define('sessionStorage', session);
  define('location', {hash: '', pathname: '/', search: ''});
}

test('ATokenIsKeptForAllPagesOfTheBrowserAndDropped', () => {
  const local = new Place(1000), session = new Place(1000);
  browserWith(local, session);
  keepToken('a');
  assert.deepEqual([takeToken(), session.kept.size], ['a', 0]);
  dropToken();
  assert.equal(takeToken(), null);
});

test('BehindAFullPlaceTheNewTokenCountsAndTheOldOneIsGone', () => {
  const local = new Place(30), session = new Place(1000);
  browserWith(local, session);
  keepToken('old');
  assert.equal(takeToken(), 'old');
  local.kept.set('other', 'x'.repeat(20));
  keepToken('another token');
  assert.equal(takeToken(), 'another token', 'a reload goes on with who signed in last');
  assert.ok(!local.kept.has('touchcal.token'));
  local.kept.clear();
  keepToken('third');
  assert.deepEqual([takeToken(), session.kept.size], ['third', 0], 'there is one token');
});

test('ABrowserThatKeepsNothingIsLivedWith', () => {
  const full = new Place(0);
  for (const [local, session] of [[full, full], [null, null], [null, full]] as const) {
    browserWith(local, session);
    keepToken('a');
    assert.equal(takeToken(), null);
    dropToken();
  }
});
