import assert from 'node:assert/strict';
import {readdirSync, readFileSync} from 'node:fs';
import {join} from 'node:path';
import {test} from 'node:test';
import {gzipSync} from 'node:zlib';

const kFirstLoadMax = 80000;  // bytes, compressed

const bundle = join(process.env.TOUCHCAL_PAGE_DIR ?? '.', 'bundle');
const names = readdirSync(bundle);
const named = (pattern: RegExp): string => names.find((name) => pattern.test(name))!;

/** A script and all that it is not without. */
function whole(name: string, so_far = new Set<string>()): Set<string> {
  if (so_far.has(name)) return so_far;
  so_far.add(name);
  const text = readFileSync(join(bundle, name), 'utf8');
  for (const [, part] of text.matchAll(/(?:from|import)"\.\/([\w.-]+\.js)"/g)) whole(part!, so_far);
  return so_far;
}

test('TheFirstLoadIsLightAndHasNeitherTheViewNorTheSignInNorTheQrCodeNorTheSetup', () => {
  const first = whole(named(/^main-.*\.js$/));
  for (const later of [/^scene_view-/, /^account_panel-/, /^qr_code-/, /^setup_view-/, /^de-/, /^fr-/]) assert.ok(!first.has(named(later)), String(later));
  const bytes = [...first, named(/^main-.*\.css$/)].reduce((sum, name) => sum + gzipSync(readFileSync(join(bundle, name)), {level: 9}).length, 0);
  assert.ok(bytes > 30000 && bytes <= kFirstLoadMax, `${bytes} bytes`);
});

test('EveryFileOfThePageIsNamedWhereItIsBuilt', () => {
  // What is not named there is built once and not again when it changes.
  const page = join(process.env.TOUCHCAL_SOURCE_DIR ?? '.', 'service/page');
  const named = readFileSync(join(page, 'CMakeLists.txt'), 'utf8').split(/\s+|\)/);
  const files = readdirSync(join(page, 'src'), {recursive: true, withFileTypes: true}).filter((entry) => entry.isFile())
      .map((entry) => `src/${join(entry.parentPath ?? entry.path, entry.name).slice(join(page, 'src').length + 1)}`);
  assert.ok(files.length > 80);
  assert.deepEqual(files.filter((file) => !named.includes(file)), []);
});
