import {useEffect, useRef, useState} from 'preact/hooks';
import type {Desk} from '../model/desk.ts';
import type {Language} from '../model/format.ts';
import {kViews, type PageState, type View} from '../model/page_state.ts';
import {mayStop} from '../model/session.ts';
import {mayPause} from '../model/states.ts';
import type {Conditions} from '../model/start_body.ts';
import {isAtWork} from '../model/sticky_faults.ts';
import {useStore} from '../model/store.ts';
import {isLanguage, kLanguageNames, kLanguages, loadLanguage, sayIn, type WordKey} from '../words/words.ts';
import {Banner} from './banner.tsx';
import {CellView} from './cell_view.tsx';
import {FaultPanel} from './fault_panel.tsx';
import {HandPanel} from './hand_panel.tsx';
import {Header} from './header.tsx';
import {HistoryView} from './history_view.tsx';
import {Later, Part} from './later.tsx';
import {LiveView} from './live_view.tsx';
import {RunControls} from './run_controls.tsx';
import {firstLanguage, firstTheme, keepLanguage, keepOperator, keepTheme, keptOperator, type Theme} from './settings.ts';
import {Symbol} from './symbol.tsx';
import {LanguageContext, useSay} from './texts.tsx';
import {HoldPanel, WaitPanel} from './wait_panel.tsx';

const kViewWords: Record<View, WordKey> = {cell: 'viewCell', live: 'viewLive', result: 'viewResult', history: 'viewHistory', setup: 'setUp'};
const kTick_ms = 500;

const accountPanel = new Part(() => import('./account_panel.tsx').then((file) => file.AccountPanel));
const setupView = new Part(() => import('./setup_view.tsx').then((file) => file.SetupView));
const resultView = new Part(() => import('./result_view.tsx').then((file) => file.ResultView));

/** The clock of the shown ages. */
function useNow(): number {
  const [now_ms, setNow] = useState(performance.now());
  useEffect(() => {
    const clock = setInterval(() => setNow(performance.now()), kTick_ms);
    return () => clearInterval(clock);
  }, []);
  return now_ms;
}

function useShortcuts(desk: Desk): void {
  useEffect(() => {
    const act = (event: KeyboardEvent): void => {
      if (!event.altKey || event.ctrlKey || event.metaKey || event.repeat) return;
      const view = kViews[Number(event.code.replace('Digit', '')) - 1];
      const {role, status} = desk.store.state;
      if (view) desk.show(view);
      else if (event.code === 'KeyS' && mayStop(desk.store.state)) void desk.command('stop');
      else if (event.code === 'KeyP' && role === 'operate' && status && mayPause(status.state)) void desk.command('pause');
      else return;
      event.preventDefault();
    };
    addEventListener('keydown', act);
    return () => removeEventListener('keydown', act);
  }, [desk]);
}

export function App({desk}: {desk: Desk}) {
  const state = useStore(desk.store);
  const now_ms = useNow();
  const [language, setLanguage] = useState<Language>(firstLanguage);
  const [theme, setTheme] = useState<Theme>(firstTheme);
  const [conditions, setConditions] = useState<Conditions>(() => keptOperator());
  useShortcuts(desk);
  // Behind the first picture, so that it is here when the daemon is gone.
  useEffect(() => void resultView.load().catch(() => {}), []);
  useEffect(() => {
    document.documentElement.lang = language;
    keepLanguage(language);
  }, [language]);
  useEffect(() => {
    document.documentElement.dataset.theme = theme;
    keepTheme(theme);
  }, [theme]);
  const startRun = async (): Promise<void> => {
    if (!await desk.startRun(conditions)) return;
    setConditions(({temperature: _, movingMin: __, kind: ___, ...others}) => others);  // they were of this run
    document.querySelector<HTMLElement>('header h1')?.focus();
  };
  /** Words that do not come, as of a daemon that is gone, leave the page in the language that it has. */
  const speak = (name: string): Promise<void> => (isLanguage(name) ? loadLanguage(name).then(() => setLanguage(name), () => {}) : Promise.resolve());
  const place = useRef<HTMLElement>(null);
  useEffect(() => place.current?.scrollTo(0, 0), [state.view, state.shownRun, state.isStopLost, state.isAccountOpen]);
  const say = sayIn(language);
  const isOld = state.link === 'lost' || state.link === 'refused';
  // What is over, and a warning, do not stand before a result.
  const isResultFirst = state.view === 'result' && !state.faults.some(isAtWork) && !state.notice;
  const takeConditions = (given: Conditions): void => {
    setConditions(given);
    keepOperator(given);
  };
  return (
    <LanguageContext.Provider value={language}>
      <Header state={state} now_ms={now_ms} />
      <nav aria-label={say('views')}>
        {kViews.map((view, i) => (
          <button key={view} type="button" aria-current={state.view === view ? 'page' : undefined}
                  aria-keyshortcuts={`Alt+${i + 1}`} onClick={() => desk.show(view)}>
            {say(kViewWords[view])} <kbd>{i + 1}</kbd>
          </button>
        ))}
        <span class="spring" />
        {state.session ? <AccountButton state={state} desk={desk} /> : null}
        <select aria-label={say('language')} value={language} onChange={(event) => void speak(event.currentTarget.value)}>
          {kLanguages.map((name) => <option key={name} value={name} lang={name}>{kLanguageNames[name]}</option>)}
        </select>
        <button type="button" aria-pressed={theme === 'dark'} onClick={() => setTheme(theme === 'dark' ? 'light' : 'dark')}>
          {say(theme === 'dark' ? 'themeLight' : 'themeDark')}
        </button>
      </nav>
      <main class={isOld ? 'old' : ''} ref={place}>
        <StopLost state={state} desk={desk} language={language} />
        {state.isAccountOpen ? <Later part={accountPanel} props={{state, desk, now_ms}} /> : null}
        <Banner state={state} desk={desk} now_ms={now_ms} />
        <WaitPanel state={state} now_ms={now_ms} />
        <HoldPanel state={state} />
        <HandPanel state={state} desk={desk} />
        {isResultFirst ? null : <FaultPanel state={state} desk={desk} />}
        <Shown state={state} desk={desk} conditions={conditions} onConditions={takeConditions} />
        {isResultFirst ? <FaultPanel state={state} desk={desk} /> : null}
        {state.view === 'cell' ? <p class="keys">{say('keysHelp')}</p> : null}
      </main>
      <RunControls state={state} desk={desk} conditions={conditions} onStart={() => void startRun()} />
    </LanguageContext.Provider>
  );
}

function AccountButton({state, desk}: {state: PageState; desk: Desk}) {
  const say = useSay();
  const words = say(state.session?.role === 'none' ? 'signIn' : 'account');
  return (
    <button type="button" class="account-button" aria-label={words} aria-expanded={state.isAccountOpen} onClick={() => desk.showAccount(!state.isAccountOpen)}>
      <Symbol shape="person" /><span class="wide">{words}</span>
    </button>
  );
}

function Shown({state, desk, conditions, onConditions}: {
  state: PageState; desk: Desk; conditions: Conditions; onConditions: (given: Conditions) => void;
}) {
  switch (state.view) {
    case 'cell':
      return <CellView state={state} desk={desk} conditions={conditions} onConditions={onConditions} />;
    case 'live':
      return <LiveView state={state} desk={desk} />;
    case 'result':
      return <Later part={resultView} props={{state, desk}} />;
    case 'history':
      return <HistoryView state={state} desk={desk} />;
    case 'setup':
      return <Later part={setupView} props={{state, desk}} />;
  }
}

/** A stop that nobody heard: it stays in sight whatever is scrolled. */
function StopLost({state, desk, language}: {state: PageState; desk: Desk; language: Language}) {
  const say = sayIn(language);
  if (!state.isStopLost) return null;
  return (
    <section class="card fault stop-lost" role="alert">
      <h2 class="big"><Symbol shape="fault" />{say('stopLostTitle')}</h2>
      <p class="big">{say('stopLostWords')}</p>
      <div class="actions"><button type="button" onClick={() => desk.dropStopLost()}>{say('note')}</button></div>
    </section>
  );
}
