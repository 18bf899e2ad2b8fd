// node build.mjs DIRECTORY: checks and bundles the page in DIRECTORY, where packages.mjs has put the packages, and writes
// DIRECTORY/page_assets.cpp, which holds it.
import {createHash} from 'node:crypto';
import {cpSync, existsSync, mkdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {spawnSync} from 'node:child_process';
import {basename, dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {gzipSync} from 'node:zlib';

const here = dirname(fileURLToPath(import.meta.url));
const directory = process.argv[2];
const bundle = join(directory, 'bundle');

// The sources stand beside node_modules: there the compilers find the packages.
rmSync(join(directory, 'src'), {recursive: true, force: true});
cpSync(join(here, 'src'), join(directory, 'src'), {recursive: true});
cpSync(join(here, 'tsconfig.json'), join(directory, 'tsconfig.json'));
const checked = spawnSync(process.execPath, [join(directory, 'node_modules/typescript/bin/tsc'), '--noEmit', '-p', directory],
                          {stdio: 'inherit', cwd: directory});
if (checked.status !== 0) process.exit(1);

rmSync(bundle, {recursive: true, force: true});
mkdirSync(bundle, {recursive: true});
const esbuild = createRequire(join(directory, 'package.json'))('esbuild');
const built = await esbuild.build({
  absWorkingDir: directory,
  entryPoints: ['src/main.tsx'],
  outdir: bundle,
  bundle: true,
  splitting: true,
  format: 'esm',
  target: 'es2020',
  minify: true,
  metafile: true,
  jsx: 'automatic',
  jsxImportSource: 'preact',
  entryNames: '[name]-[hash]',
  chunkNames: '[name]-[hash]',
  legalComments: 'none',
  logLevel: 'warning',
});

const outputs = Object.keys(built.metafile.outputs).map((path) => basename(path)).sort();
const main = outputs.find((name) => /^main-.*\.js$/.test(name));
const style = outputs.find((name) => /^main-.*\.css$/.test(name));
// What the first script is made of is asked for with it, not behind it.
const ofMain = built.metafile.outputs[Object.keys(built.metafile.outputs).find((path) => basename(path) === main)].imports;
const parts = ofMain.filter(({kind}) => kind === 'import-statement').map(({path}) => `<link rel="modulepreload" href="/assets/${basename(path)}">\n`);
const page = readFileSync(join(directory, 'src/index.html'), 'utf8').replace('PARTS\n', parts.join('')).replace('MAIN.js', main).replace('MAIN.css', style);

const types = {js: 'text/javascript; charset=utf-8', css: 'text/css; charset=utf-8'};
const etag = (bytes) => `"${createHash('sha256').update(bytes).digest('hex').slice(0, 16)}"`;
const assets = [{name: '', type: 'text/html; charset=utf-8', bytes: Buffer.from(page), gzip: false}];
for (const name of outputs) {
  const bytes = gzipSync(readFileSync(join(bundle, name)), {level: 9});
  assets.push({name, type: types[name.split('.').pop()], bytes, gzip: true});
}

/** The bytes as C++ string literals of one line each. */
function literal(bytes) {
  const lines = [];
  for (let from = 0; from < bytes.length; from += 32) {
    const line = [...bytes.subarray(from, from + 32)].map((byte) => `\\${byte.toString(8).padStart(3, '0')}`).join('');
    lines.push(`     "${line}"`);
  }
  return lines.join('\n');
}

const rows = assets.map(({name, type, bytes, gzip}) => `    {"${name}", "${type}", ${JSON.stringify(etag(bytes))},
     std::string_view(
${literal(bytes)},
     ${bytes.length}), ${gzip}},`);
const source = `// Made by service/page/build.mjs.
#include "service/page/assets.hpp"

namespace cell {
namespace {

constexpr PageAsset kAssets[] = {
${rows.join('\n')}
};

}  // namespace

std::span<const PageAsset> page_assets() { return kAssets; }

}  // namespace cell
`;
const file = join(directory, 'page_assets.cpp');
if (!existsSync(file) || readFileSync(file, 'utf8') !== source) writeFileSync(file, source);
