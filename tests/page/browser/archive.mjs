// The archive of a plant, for the time of a test: a database of its own.
import {spawn} from 'node:child_process';
import {join} from 'node:path';
import {createInterface} from 'node:readline';
import {fileURLToPath} from 'node:url';

const programs = process.env.TOUCHCAL_PROGRAMS ?? fileURLToPath(new URL('../../../build/bin', import.meta.url));

export class Archive {
  static async start() {
    const made = new Archive();
    made.child = spawn(join(programs, 'page_archive'), [], {stdio: ['pipe', 'pipe', 'inherit']});
    made.lines = createInterface({input: made.child.stdout})[Symbol.asyncIterator]();
    const {value} = await made.lines.next();
    made.url = value?.match(/^listening on (\S+)$/)?.[1];
    if (!made.url) throw new Error(`page_archive did not start: ${value}`);
    return made;
  }

  /** From now on nobody reaches it. */
  async takeAway() {
    this.child.stdin.write('away\n');
    await this.lines.next();
  }

  async stop() {
    const ended = new Promise((done) => (this.child.exitCode !== null || this.child.signalCode ? done() : this.child.once('exit', done)));
    this.child.stdin.end();
    await ended;
  }
}
