// node packages.mjs DIRECTORY: the packages that the page is built and tested with, as package-lock.json names them.
import {copyFileSync, mkdirSync} from 'node:fs';
import {spawnSync} from 'node:child_process';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const directory = process.argv[2];
mkdirSync(directory, {recursive: true});
for (const file of ['package.json', 'package-lock.json']) copyFileSync(join(here, file), join(directory, file));
const options = ['--ignore-scripts', '--prefer-offline', '--no-audit', '--no-fund', '--loglevel=error'];
const ended = spawnSync('npm', ['ci', ...options], {cwd: directory, stdio: 'inherit'});
if (ended.status !== 0) {
  console.error(`The page's npm packages could not be installed in ${directory}: npm's registry has to be within
reach once (later builds take them from npm's cache). Look at \`npm config get registry\` and the proxy.`);
  process.exit(1);
}
