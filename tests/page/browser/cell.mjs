// A simulated cell with its daemon, for the time of a test.
import {fileURLToPath} from 'node:url';
import {spawn, spawnSync} from 'node:child_process';
import {cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createConnection} from 'node:net';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {createInterface} from 'node:readline';

const programs = process.env.TOUCHCAL_PROGRAMS ?? fileURLToPath(new URL('../../../build/bin', import.meta.url));
const source = process.env.TOUCHCAL_SOURCE_DIR ?? fileURLToPath(new URL('../../..', import.meta.url));
const kStart_ms = 20000;
const kHeartbeat_ms = 10000;

/** Starts a program; resolves with the address of its line "listening on HOST:PORT", and of "control on HOST:PORT" where there is one. */
function launch(program, options) {
  const child = spawn(join(programs, program), options, {stdio: ['ignore', 'pipe', 'pipe']});
  const hasControl = options.includes('--control');
  let told = '', address;
  return new Promise((resolve, reject) => {
    const clock = setTimeout(() => reject(new Error(`${program} did not start: ${told}`)), kStart_ms);
    child.on('exit', (code) => reject(new Error(`${program} ended with ${code}: ${told}`)));
    const look = () => {
      const control = told.match(/^control on (\S+)$/m)?.[1];
      if (!address || (hasControl && !control)) return;
      clearTimeout(clock);
      resolve({child, address, control, told: () => told});
    };
    child.stderr.on('data', (text) => {
      told += text;
      if (hasControl) look();
    });
    createInterface({input: child.stdout}).on('line', (line) => {
      address ??= line.match(/^listening on (\S+)/)?.[1];
      look();
    });
  });
}

const portOf = (address) => Number(address.split(':').pop());

const ended = (child) => new Promise((done) => (child.exitCode !== null || child.signalCode ? done() : child.once('exit', done)));

/** A copy of the configuration whose link outlasts a machine that is busy with a browser. */
function patientCell(cell, directory) {
  cpSync(join(source, 'config'), join(directory, 'config'), {recursive: true});
  const file = join(directory, `config/cells/${cell}/cell.json`);
  const document = JSON.parse(readFileSync(file, 'utf8'));
  document.deadlines.heartbeat_timeout_ms = kHeartbeat_ms;
  writeFileSync(file, JSON.stringify(document));
  return file;
}

export class Cell {
  /** `speed`: of the simulated arm; `options`: more of cs8sim's, `daemonOptions`: of touchcald's. */
  static async start({speed = 'max', options = [], daemonOptions = [], cell = 'demo'} = {}) {
    const made = new Cell();
    made.daemonOptions = daemonOptions;
    made.state = mkdtempSync(join(tmpdir(), 'touchcal-page-'));
    made.file = patientCell(cell, made.state);
    made.simulator = await launch('cs8sim', [
      '--cell', made.file, '--listen', '127.0.0.1:0', '--control', '127.0.0.1:0', '--speed', String(speed), '--link-patience', String(kHeartbeat_ms), ...options,
    ]);
    await made.startDaemon(0);
    return made;
  }

  async startDaemon(port) {
    this.daemon = await launch('touchcald', [
      '--cell', this.file, '--listen', `127.0.0.1:${port}`, '--controller', this.simulator.address, '--state', this.state, ...this.daemonOptions,
    ]);
    this.url = `http://${this.daemon.address}`;
    this.token = readFileSync(join(this.state, 'operate.token'), 'utf8').trim();
    this.viewToken = readFileSync(join(this.state, 'view.token'), 'utf8').trim();
  }

  /** As if the power went. */
  async killDaemon() {
    this.port = portOf(this.daemon.address);
    this.daemon.child.kill('SIGKILL');
    await ended(this.daemon.child);
  }

  restartDaemon() {
    return this.startDaemon(this.port);
  }

  /** As `touchcal page` prints it. */
  get link() {
    const told = spawnSync(join(programs, 'touchcal'), ['page', '--daemon', this.url, '--state', this.state], {encoding: 'utf8'});
    if (told.status !== 0) throw new Error(told.stderr);
    return told.stdout.trim();
  }

  async get(path) {
    return (await fetch(this.url + path)).json();
  }

  async post(path, body) {
    const headers = {Authorization: `Bearer ${this.token}`, 'Content-Type': 'application/json'};
    return (await fetch(this.url + path, {method: 'POST', headers, body: body === undefined ? undefined : JSON.stringify(body)})).json();
  }

  /** The status once `holds` is true of it; asked again at each change. */
  async status(holds, patience_ms = 60000) {
    const last = performance.now() + patience_ms;
    let status = await this.get('/api/v1/status');
    while (!holds(status)) {
      if (performance.now() > last) throw new Error(`${this.daemon.told().slice(-2000)}\nthe cell stays ${JSON.stringify(status)}`);
      status = await this.get(`/api/v1/status?wait_s=2&after=${status.sequence}`);
    }
    return status;
  }

  /** A line to cs8sim's control port: a fault, or what the operator does. */
  control(line) {
    return new Promise((done, fail) => {
      const socket = createConnection(portOf(this.simulator.control), '127.0.0.1', () => socket.write(`${JSON.stringify(line)}\n`));
      createInterface({input: socket}).once('line', (text) => {
        socket.end();
        const answer = JSON.parse(text);
        if (answer.ok) done(answer);
        else fail(new Error(answer.error));
      });
      socket.on('error', fail);
    });
  }

  async stop() {
    for (const program of [this.daemon, this.simulator]) {
      program.child.kill('SIGTERM');
      await ended(program.child);
    }
    rmSync(this.state, {recursive: true, force: true});
  }
}
