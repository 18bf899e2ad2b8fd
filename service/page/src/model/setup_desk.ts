import {postOnce} from '../api/client.ts';
import type {SetupAnswers, SetupCheck} from '../api/setup_documents.ts';
import type {Language} from './format.ts';

const kTyping_ms = 400;        // somebody who types is not interrupted
const kBusy_s = 2;             // where the daemon names no time
const kLost_s = 3;
const kPatience_ms = 20000;

/** What came of the newest answers; `asking`: the daemon has not answered yet, or is to be asked again. */
export type SetupState =
  | {kind: 'asking'}
  | {kind: 'told'}
  | {kind: 'busy'}
  | {kind: 'lost'}
  | {kind: 'refused'; status: number; detail: string};

/** Asks the daemon what the answers make, a while after each change; an answer to older ones is dropped. */
export class SetupDesk {
  private asked = 0;
  private isOpen = false;  // one request at a time: the daemon has other work there
  private next: (() => void) | null = null;
  private clock: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly token: () => string | null, private readonly tell: (state: SetupState, check: SetupCheck | null) => void) {}

  check(given: SetupAnswers, language: Language, after_ms = kTyping_ms): void {
    const number = ++this.asked;
    clearTimeout(this.clock);
    this.tell({kind: 'asking'}, null);
    this.clock = setTimeout(() => void this.ask(number, given, language), after_ms);
  }

  close(): void {
    ++this.asked;
    this.next = null;
    clearTimeout(this.clock);
  }

  private async ask(number: number, given: SetupAnswers, language: Language): Promise<void> {
    if (this.isOpen) {
      this.next = () => void this.ask(number, given, language);
      return;
    }
    this.isOpen = true;
    const reply = await postOnce<SetupCheck>(`/api/v1/setup/check?language=${language}`, {token: this.token(), body: given, patience_ms: kPatience_ms});
    this.isOpen = false;
    const {next} = this;
    this.next = null;
    next?.();
    if (number !== this.asked) return;
    const again = (after_s: number): void => {
      this.clock = setTimeout(() => void this.ask(number, given, language), after_s * 1000);
    };
    if (reply.kind === 'ok') {
      this.tell({kind: 'told'}, reply.value);
    } else if (reply.kind === 'lost') {
      this.tell({kind: 'lost'}, null);
      again(kLost_s);
    } else if (reply.kind === 'refused' && reply.status === 503) {
      this.tell({kind: 'busy'}, null);
      again(reply.retry_after_s ?? kBusy_s);
    } else if (reply.kind === 'refused') {
      this.tell({kind: 'refused', status: reply.status, detail: reply.problem.detail}, null);
    }
  }
}
