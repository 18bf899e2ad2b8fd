// node run.mjs FILE: one file of browser tests, or with `unit` the tests of what needs no browser. Environment:
// TOUCHCAL_SOURCE_DIR, TOUCHCAL_PROGRAMS (build/bin), TOUCHCAL_PAGE_DIR (where the page was built).
import {mkdirSync, readdirSync, rmSync} from 'node:fs';
import {createRequire} from 'node:module';
import {spawnSync} from 'node:child_process';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const wanted = process.argv[2];
let files = [join(here, 'browser', wanted)];
if (wanted === 'unit') {
  const page = process.env.TOUCHCAL_PAGE_DIR;
  const out = join(page, 'unit');
  rmSync(out, {recursive: true, force: true});
  mkdirSync(out);
  const esbuild = createRequire(join(page, 'package.json'))('esbuild');
  const names = readdirSync(join(here, 'unit')).filter((name) => name.endsWith('_test.ts'));
  await esbuild.build({
    entryPoints: names.map((name) => join(here, 'unit', name)), outdir: out, outExtension: {'.js': '.mjs'},
    bundle: true, format: 'esm', platform: 'node', target: 'node18', nodePaths: [join(page, 'node_modules')],
    alias: {page: join(process.env.TOUCHCAL_SOURCE_DIR, 'service/page/src')}, logLevel: 'warning',
  });
  files = names.map((name) => join(out, name.replace('.ts', '.mjs')));
}
const ended = spawnSync(process.execPath, ['--test', ...files], {stdio: 'inherit'});
process.exit(ended.status ?? 1);
