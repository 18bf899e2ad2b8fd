import {get, headersOf} from './client.ts';
import type {Joints, Status} from './documents.ts';
import {EventText, type StreamEvent} from './event_text.ts';

/** How the page hears of the cell: by events, by asking, not at all, or not without a token. */
export type Link = 'connecting' | 'live' | 'polling' | 'lost' | 'refused';

export interface Listener {
  link(link: Link): void;
  /** In order; those of before the page was loaded as well, as far as the daemon remembers them. */
  statuses(statuses: Status[]): void;
  joints(joints: Joints): void;
}

const kReplayMax = 1000;          // the daemon remembers 1024 changes
const kPulse_ms = 200;            // while the arm may move and is looked at
const kQuietPulse_ms = 1000;
const kPulsePatience_ms = 2000;
const kRetry_ms = 1000;
const kStreamRetry_ms = 15000;    // as many streams as there may be are open, or one brought nothing
const kStall_ms = 2000;           // then a stream that is behind the pulse brings nothing any more

const pause = (ms: number): Promise<void> => new Promise((done) => setTimeout(done, ms));

/** A change that the pulse told and the stream has not brought, and since when. */
export interface Behind { sequence: number; since_ms: number }

/** What the stream is behind by, now that the pulse tells `told` and the stream has brought `brought`; null: nothing. */
export function behindOf(before: Behind | null, told: number, brought: number, now_ms: number): Behind | null {
  if (before && brought < before.sequence) return before;
  return brought < told ? {sequence: told, since_ms: now_ms} : null;
}

/**
 * Listens to the daemon for as long as the page is open. Two loops: the event stream brings every change; the pulse asks
 * where the arm is and how old that is, notices a daemon that is gone, and asks for the status where the stream does not
 * bring it.
 */
export class Live {
  private sequence = -1;
  private instance = '';
  private streaming = false;
  private fast = false;
  private etag: string | null = null;
  private lastId: string | null = null;  // of the stream's last event
  private hangUp = new AbortController();
  private behind: Behind | null = null;
  private stalled = false;  // the stream was hung up for that
  private wake: (() => void) | null = null;

  constructor(private readonly listener: Listener, private token: string | null) {}

  start(): void {
    void this.pulse();
    void this.stream();
  }

  /** A stream is open for the token that it was opened with: another one opens another stream. */
  setToken(token: string | null): void {
    if (token === this.token) return;
    this.token = token;
    this.hangUp.abort();
    this.wake?.();
  }

  /** The arm may move and is looked at. */
  setFast(fast: boolean): void {
    if (fast && !this.fast) this.wake?.();
    this.fast = fast;
  }

  private async pulse(): Promise<void> {
    for (;;) {
      const asked = performance.now();
      const reply = await get<Joints>('/api/v1/cell/joints', {token: this.token, patience_ms: kPulsePatience_ms});
      if (reply.kind === 'ok') {
        this.listener.joints(reply.value);
        this.watchStream(reply.value);
        const isNew = reply.value.sequence !== this.sequence || reply.value.instance_id !== this.instance;
        if (!this.streaming && isNew) await this.askStatus();
        this.listener.link(this.streaming ? 'live' : 'polling');
      } else if (reply.kind === 'refused') {
        this.listener.link(reply.status === 401 || reply.status === 403 ? 'refused' : 'lost');
      } else {
        this.hangUp.abort();  // a stream that is half open would wait for ever
        this.listener.link('lost');
      }
      const gap = (this.fast ? kPulse_ms : kQuietPulse_ms) - (performance.now() - asked);
      await Promise.race([pause(Math.max(50, gap)), new Promise<void>((woken) => (this.wake = woken))]);
    }
  }

  /** Something on the way may keep the events for itself: then the page asks instead. */
  private watchStream({sequence, instance_id}: Joints): void {
    if (!this.streaming) return;
    const now_ms = performance.now();
    const brought = instance_id === this.instance ? this.sequence : -1;
    this.behind = behindOf(this.behind, sequence, brought, now_ms);
    if (!this.behind || now_ms - this.behind.since_ms <= kStall_ms) return;
    this.stalled = true;
    this.streaming = false;
    this.hangUp.abort();
  }

  private async askStatus(): Promise<void> {
    const reply = await get<Status>('/api/v1/status', {token: this.token, etag: this.etag});
    if (reply.kind !== 'ok') return;
    this.etag = reply.etag;
    this.take([reply.value]);
  }

  private take(statuses: Status[]): void {
    const last = statuses[statuses.length - 1];
    if (!last) return;
    this.sequence = last.sequence;
    this.instance = last.instance_id;
    this.listener.statuses(statuses);
  }

  private async stream(): Promise<void> {
    for (;;) {
      let gap = kRetry_ms;
      try {
        gap = (await this.readStream()) === 503 ? kStreamRetry_ms : kRetry_ms;
      } catch {
        // The connection broke; the pulse tells what that means.
      }
      this.streaming = false;
      this.behind = null;
      if (this.stalled) gap = kStreamRetry_ms;
      this.stalled = false;
      await pause(gap);
    }
  }

  /** Reads events until the stream ends; gives the answer's status. */
  private async readStream(): Promise<number> {
    if (this.sequence < 0) await this.askStatus();
    const headers = headersOf({token: this.token});
    const before = this.instance ? `${this.instance}-${Math.max(0, this.sequence - kReplayMax)}` : null;
    const seen = this.lastId ?? before;
    if (seen) headers['Last-Event-ID'] = seen;
    this.hangUp = new AbortController();
    const response = await fetch('/api/v1/events', {headers, cache: 'no-store', signal: this.hangUp.signal});
    if (!response.ok || !response.body) return response.status;
    const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
    const text = new EventText();
    for (;;) {
      const {done, value} = await reader.read();
      if (done) return response.status;
      this.streaming = true;  // an answer that brings nothing is no stream: the daemon's begins at once
      this.takeEvents(text.push(value));
    }
  }

  private takeEvents(events: StreamEvent[]): void {
    const statuses: Status[] = [];
    for (const event of events) {
      if (event.event === 'status' || event.event === 'reset') statuses.push(JSON.parse(event.data) as Status);
    }
    this.lastId = events[events.length - 1]?.id || this.lastId;
    this.take(statuses);
  }
}
