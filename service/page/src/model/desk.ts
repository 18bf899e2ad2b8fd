import {get, post, type Reply} from '../api/client.ts';
import type {Audit, Cell, Checks, Comparison, FaultEntry, Joints, Plan, Recipes, Result, Run, Runs, Status, Touches, Unmet, Verification} from '../api/documents.ts';
import {saveAs} from '../api/download.ts';
import type {Fleet, FleetTrends} from '../api/fleet_documents.ts';
import {Live, type Link} from '../api/live.ts';
import {checkedRun, comparedPair, comparisonKey, hasResult, kFirstState, newestRun, reduce, type Action, type PageState, type View} from './page_state.ts';
import {Pass} from './pass.ts';
import {commandPath, isActive, isPaused, isTakenBack, type Command} from './states.ts';
import {signedIn} from './session.ts';
import {slimResult} from './slim_result.ts';
import {conditionsOf, startBody, type Conditions} from './start_body.ts';
import {toldFault} from './sticky_faults.ts';
import {Store} from './store.ts';

const kResultGap_ms = 1000;     // a live result is asked for at most so often
const kReadiness_ms = 2000;
const kChecks_ms = 600000;      // then the checks are asked for again: one may have become due
const kTrendRuns = 20;
const kPlanPatience_ms = 120000;
const kFleetPatience_ms = 30000;
const kStopPatience_ms = 1500;  // then it is asked again

/** The page's hands: asks the daemon, sends commands, keeps the store. Views call nothing else. */
export class Desk {
  readonly store = new Store<PageState, Action>(reduce, kFirstState);
  readonly pass: Pass;
  private readonly live: Live;
  private asked: {run_id: string; touches: number; isOver: boolean} | null = null;  // the live result that was asked for last
  private askingResult = false;
  private checksAsked_ms = 0;
  private endGap: (() => void) | null = null;  // the end of a run is not waited for
  private isPageHidden = false;

  constructor(token: string | null) {
    this.pass = new Pass(this.store, token, (other) => this.takeToken(other));
    this.live = new Live({
      link: (link) => this.takeLink(link),
      statuses: (statuses) => this.takeStatuses(statuses),
      joints: (joints) => this.takeJoints(joints),
    }, token);
  }

  start(): void {
    this.live.start();
    this.pass.start();
    void this.loadAll();
    setInterval(() => {
      void this.askReadiness();
      if (!this.isPageHidden && performance.now() - this.checksAsked_ms >= kChecks_ms) void this.renewChecks();
    }, kReadiness_ms);
    document.addEventListener('visibilitychange', () => {
      this.isPageHidden = document.hidden;
      this.setPace();
      if (!this.isPageHidden) this.catchUp();
    });
  }

  private get token(): string | null {
    return this.pass.token;
  }

  /** What could not be read without it is asked for once more. */
  private takeToken(token: string | null): void {
    this.live.setToken(token);
    void this.loadAll();
    this.catchUp();
  }

  // what is heard

  private takeLink(link: Link): void {
    const before = this.store.state.link;
    this.store.dispatch({type: 'link', link});
    if (link === 'refused' && before !== 'refused') void this.askRole();
    const isBack = (link === 'live' || link === 'polling') && (before === 'lost' || before === 'refused');
    if (isBack) {
      void this.loadAll();
      this.catchUp();
    }
  }

  /** Behind a time in which answers were lost or not asked for. */
  private catchUp(): void {
    this.asked = null;
    void this.askReadiness();
    void this.followRun();
    const {view, shownRun} = this.store.state;
    if (view === 'result' && shownRun && !hasResult(this.store.state, shownRun)) void this.loadResult(shownRun);
  }

  private takeStatuses(statuses: Status[]): void {
    const before = this.store.state.status;
    this.store.dispatch({type: 'statuses', statuses, heard_ms: performance.now()});
    const status = this.store.state.status;
    if (!status) return;
    this.setPace();
    const runChanged = !before || before.run_id !== status.run_id || isActive(before.state) !== isActive(status.state);
    if (runChanged) {
      this.endGap?.();
      void this.loadRuns();
      void this.askReadiness();
      if (before && !isActive(status.state)) void this.renewChecks();
      if (status.run_id && status.touches_total !== null) void this.loadRunPlan(status.run_id);
    }
    if (before && before.instance_id !== status.instance_id) void this.loadAll();
    if (before?.by_hand && !status.by_hand) void this.loadCell();  // the block may have been found
    if (isPaused(status) && (!before || before.state !== status.state)) void this.askWhoPaused();
    void this.followRun();
  }

  private takeJoints(joints: Joints): void {
    this.store.dispatch({type: 'joints', joints, heard_ms: performance.now()});
  }

  private setPace(): void {
    const {status, view} = this.store.state;
    this.live.setFast(!this.isPageHidden && view === 'live' && status !== null &&
                      (isActive(status.state) || isTakenBack(status)));
  }

  // what is asked for

  private ask<T>(path: string, patience_ms?: number): Promise<Reply<T>> {
    return get<T>(path, patience_ms === undefined ? {token: this.token} : {token: this.token, patience_ms});
  }

  private async load<T>(path: string, take: (value: T) => void): Promise<void> {
    const reply = await this.ask<T>(path);
    if (reply.kind === 'ok') take(reply.value);
  }

  private patch(patch: Partial<PageState>): void {
    this.store.dispatch({type: 'patch', patch});
  }

  private async loadAll(): Promise<void> {
    await Promise.all([
      this.askRole(),
      this.loadCell(),
      this.load<Recipes>('/api/v1/recipes', (recipes) => {
        this.patch({recipes, recipe: this.store.state.recipe ?? recipes.default});
      }),
      this.load<{faults: FaultEntry[]}>('/api/v1/faults', ({faults}) => {
        this.patch({faultTable: Object.fromEntries(faults.map((fault) => [fault.code, fault]))});
      }),
      this.askReadiness(),
      this.loadRuns(),
      this.renewChecks(),
    ]);
  }

  /** The same cell stays the same object: what is drawn of it stays as a person has turned it. */
  private async loadCell(): Promise<void> {
    await this.load<Cell>('/api/v1/cell', (cell) => {
      if (JSON.stringify(cell) !== JSON.stringify(this.store.state.cell)) this.patch({cell});
    });
  }

  private async askRole(): Promise<void> {
    await this.pass.ask();
    const {status, pausedBy} = this.store.state;
    if (status && isPaused(status) && !pausedBy) void this.askWhoPaused();
  }

  private async askReadiness(): Promise<void> {
    if (this.isPageHidden) return;
    const reply = await this.ask<unknown>('/readyz');
    if (reply.kind === 'ok') this.patch({unmet: []});
    if (reply.kind === 'refused') this.patch({unmet: (reply.problem.errors as Unmet[] | undefined) ?? null});
    if (reply.kind === 'lost') this.patch({unmet: null});
  }

  /** The audit log tells it, to whom may operate. It is written behind the pause: asked again once the arm stands. */
  private async askWhoPaused(): Promise<void> {
    const run_id = this.store.state.status?.run_id;
    if (!run_id || this.store.state.role !== 'operate') return;
    await this.load<Audit>('/api/v1/audit?limit=50', ({rows}) => {
      const row = rows.find(({action, outcome}) => action === `POST /api/v1/runs/${run_id}/pause` && outcome.startsWith('2'));
      if (row) this.patch({pausedBy: {run_id, name: row.token, from: row.remote, at: row.at}});
    });
  }

  async loadRuns(before: string | null = null): Promise<void> {
    const path = before ? `/api/v1/runs?limit=50&before=${encodeURIComponent(before)}` : '/api/v1/runs?limit=50';
    await this.load<Runs>(path, ({runs, damaged, next_before}) => {
      this.store.dispatch({type: 'runs', runs, damaged: damaged ?? [], nextBefore: next_before, isMore: before !== null});
    });
  }

  private async loadRunPlan(run_id: string): Promise<void> {
    await this.load<Plan>(`/api/v1/runs/${run_id}/plan`, ({touches}) => this.patch({runPlan: {run_id, touches}}));
  }

  /** The result and the touches of the run under way: when there are new ones, and not more often than can be read. */
  private async followRun(): Promise<void> {
    if (this.askingResult) return;
    this.askingResult = true;
    try {
      for (;;) {
        const {status, runPlan} = this.store.state;
        if (!status?.run_id || status.touches_done < 1 || this.isPageHidden) return;
        const {run_id, touches_done} = status;
        const isOver = !isActive(status.state);
        const {asked} = this;
        if (asked?.run_id === run_id && asked.touches === touches_done && asked.isOver === isOver) return;
        this.asked = {run_id, touches: touches_done, isOver};
        if (runPlan?.run_id !== run_id) await this.loadRunPlan(run_id);
        // Without a condition number there is no result yet.
        await Promise.all([
          status.condition_number !== null || isOver ? this.loadResult(run_id) : null,
          this.load<Touches>(`/api/v1/runs/${run_id}/touches`, ({touches}) => this.patch({touches: {run_id, touches}})),
        ]);
        await new Promise<void>((done) => {
          this.endGap = done;
          setTimeout(done, kResultGap_ms);
        });
      }
    } finally {
      this.askingResult = false;
    }
  }

  async loadResult(run_id: string): Promise<void> {
    const reply = await this.ask<Result | Verification>(`/api/v1/runs/${run_id}/result`);
    if (reply.kind === 'ok') {
      const told = reply.value;
      this.store.dispatch(told.schema === 'touchcal/proof/1' || told.schema === 'touchcal/check/1' || told.schema === 'touchcal/qualification/1'
        || told.schema === 'touchcal/tool/1'
        ? {type: 'verification', run_id, verification: told}
        : {type: 'result', run_id, result: slimResult(told)});
      const {status} = this.store.state;
      const isUnderWay = status?.run_id === run_id && isActive(status.state);
      if (told.schema === 'touchcal/check/1' && !isUnderWay) await this.loadChecks(told.of_run);
    }
    if (reply.kind === 'refused') this.store.dispatch({type: 'missing', run_id, why: reply.problem.detail});
  }

  /** What the checks of a calibration found so far; null: of the one that the next check would be of. */
  private async loadChecks(asked: string | null): Promise<void> {
    const reply = await this.ask<Checks>(asked === null ? '/api/v1/checks' : `/api/v1/checks?of_run=${asked}`);
    if (reply.kind === 'ok') this.store.dispatch({type: 'checks', asked, found: {kind: 'known', checks: reply.value}});
    if (reply.kind !== 'refused') return;
    const isNoCalibration = asked === null && reply.status === 409;
    this.store.dispatch({type: 'checks', asked, found: isNoCalibration ? null : {kind: 'refused', why: reply.problem.detail}});
  }

  /** That a check is overdue is told by the daemon's clock: the browser's is not asked. */
  private async renewChecks(): Promise<void> {
    this.checksAsked_ms = performance.now();
    const shown = checkedRun(this.store.state);
    await Promise.all([this.loadChecks(null), shown === null ? null : this.loadChecks(shown)]);
  }

  /** The plant's other cells, which change slowly: asked for by a person, and shown as they were then. The archive may take its time. */
  askFleet(): Promise<[Reply<Fleet>, Reply<FleetTrends>]> {
    return Promise.all([this.ask<Fleet>('/api/v1/fleet', kFleetPatience_ms), this.ask<FleetTrends>('/api/v1/fleet/trends', kFleetPatience_ms)]);
  }

  private async loadComparison(): Promise<void> {
    const pair = comparedPair(this.store.state.compared);
    if (!pair) return;
    const key = comparisonKey(pair);
    if (this.store.state.comparisons[key]?.kind === 'known') return;
    const reply = await this.ask<Comparison>(`/api/v1/runs/${pair[1]}/comparison?with=${pair[0]}`);
    if (reply.kind === 'ok') this.store.dispatch({type: 'comparison', key, found: {kind: 'known', comparison: reply.value}});
    if (reply.kind === 'refused') this.store.dispatch({type: 'comparison', key, found: {kind: 'refused', why: reply.problem.detail}});
  }

  /** The results that the history's trends are drawn of. */
  async loadTrends(): Promise<void> {
    const wanted = this.store.state.runs.filter((run: Run) => run.outcome === 'complete' && run.kind === 'calibration').slice(0, kTrendRuns);
    for (const run of wanted) {
      if (!this.store.state.results[run.id]) await this.loadResult(run.id);
    }
  }

  // what a person asks for

  show(view: View): void {
    this.patch({view});
    this.setPace();
    void this.followRun();
    if (view === 'history') void this.loadRuns().then(() => this.loadTrends());
  }

  /** null: the newest. */
  showRun(run_id: string | null): void {
    this.patch({shownRun: run_id, view: 'result'});
    const shown = run_id ?? newestRun(this.store.state);
    if (shown && !hasResult(this.store.state, shown)) void this.loadResult(shown);
    else if (checkedRun(this.store.state) !== null) void this.renewChecks();
  }

  compare(run_id: string): void {
    this.store.dispatch({type: 'compare', run_id});
    if (!hasResult(this.store.state, run_id)) void this.loadResult(run_id);
    void this.loadComparison();
  }

  showAccount(isAccountOpen: boolean): void {
    this.patch({isAccountOpen});
  }

  chooseRecipe(recipe: string): void {
    this.patch({recipe});
  }

  async plan(recipe: string): Promise<void> {
    this.store.dispatch({type: 'plan', recipe, plan: {kind: 'planning'}});
    const reply = await post<Plan>('/api/v1/plan', {token: this.token, body: {recipe}, patience_ms: kPlanPatience_ms});
    if (reply.kind === 'ok') this.store.dispatch({type: 'plan', recipe, plan: {kind: 'made', plan: reply.value}});
    if (reply.kind === 'refused') this.store.dispatch({type: 'plan', recipe, plan: {kind: 'refused', problem: reply.problem}});
    if (reply.kind === 'lost') this.store.dispatch({type: 'plan', recipe, plan: {kind: 'lost'}});
  }

  /** Whether the daemon took it. */
  async startRun(conditions: Conditions): Promise<boolean> {
    const {recipe, cell, session} = this.store.state;
    const body = startBody(recipe ?? '', conditionsOf(conditions, signedIn(session)), cell?.block ?? null);
    return (recipe !== null || conditions.kind !== undefined) && this.send('start', '/api/v1/runs', body);
  }

  async command(command: Command): Promise<void> {
    const path = commandPath(command, this.store.state.status?.run_id ?? null);
    if (!path) return;
    const told = toldFault(this.store.state.faults);  // by the answer, the daemon may have dropped it already
    const taken = await this.send(command, path, undefined, command === 'stop' ? kStopPatience_ms : undefined);
    if (taken && command === 'acknowledge') this.store.dispatch({type: 'acknowledged', key: told?.key ?? null});
    if (taken) void this.askReadiness();
  }

  private async send(command: Command | 'start', path: string, body: unknown, patience_ms?: number): Promise<boolean> {
    const isStop = command === 'stop';
    this.patch({busy: command, notice: null});
    if (isStop && this.store.state.link === 'lost') this.patch({isStopLost: true});  // till it is known better
    const reply = await post<unknown>(path, patience_ms ? {token: this.token, body, patience_ms} : {token: this.token, body});
    const busy = this.store.state.busy === command ? null : this.store.state.busy;
    if (reply.kind === 'refused' && (reply.status === 401 || reply.status === 403)) void this.pass.refused(reply.status);
    const problem = reply.kind === 'refused' ? reply.problem : null;
    const taken = reply.kind === 'ok';
    const isStopLost = isStop ? !isHeard(reply) : this.store.state.isStopLost;
    this.patch({busy, isStopLost, notice: taken || (isStop && isStopLost) ? null : {command, problem}});
    return taken;
  }

  /** A document of the daemon as a file; false when it was not given. */
  save(path: string, name: string): Promise<boolean> {
    return saveAs(path, name, this.token);
  }

  note(key: string): void {
    this.store.dispatch({type: 'noted', key});
  }

  dropNotice(): void {
    this.patch({notice: null});
  }

  dropStopLost(): void {
    this.patch({isStopLost: false});
  }
}

/** The daemon took the command, or knew it and had nothing to do. */
function isHeard(reply: Reply<unknown>): boolean {
  return reply.kind === 'ok' || (reply.kind === 'refused' && (reply.status === 409 || reply.status === 422));
}
