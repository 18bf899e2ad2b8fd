import {useEffect, useMemo, useRef, useState} from 'preact/hooks';
import type {Action, PageState} from '../model/page_state.ts';
import {touchPoints} from '../model/live_figures.ts';
import type {Store} from '../model/store.ts';
import type {SceneView} from '../scene/scene_view.ts';
import {useSay} from './texts.tsx';

/** The three-dimensional view: its code is loaded when it is looked at first. */
export function SceneFrame({state, store}: {state: PageState; store: Store<PageState, Action>}) {
  const say = useSay();
  const canvas = useRef<HTMLCanvasElement>(null);
  const [view, setView] = useState<SceneView | null>(null);
  const [problem, setProblem] = useState<'none' | 'missing'>('none');
  const {cell} = state;

  useEffect(() => {
    if (!cell) return;
    let made: SceneView | null = null;
    let isGone = false;
    void import('../scene/scene_view.ts').then(({openScene}) => {
      if (isGone || !canvas.current) return;
      made = openScene(canvas.current, cell);
      if (made) setView(made);
      else setProblem('missing');
    }, () => setProblem('missing'));
    return () => {
      isGone = true;
      made?.close();
      setView(null);
    };
  }, [cell]);

  // The arm follows the store without the page being drawn anew.
  useEffect(() => {
    if (!view) return;
    const follow = (): void => {
      const {pulse, link} = store.state;
      view.setJoints(link === 'lost' ? null : pulse?.joints.joints_deg ?? null);
      view.setPlane(store.state.status?.plane ?? null);
    };
    follow();
    return store.subscribe(follow);
  }, [view, store]);

  const run_id = state.status?.run_id ?? null;
  const done = useMemo(
      () => (cell && state.touches?.run_id === run_id ? touchPoints(cell, state.touches?.touches ?? []) : []), [cell, state.touches, run_id]);
  const planned = useMemo(
      () => (cell && state.runPlan?.run_id === run_id ? touchPoints(cell, state.runPlan?.touches ?? []) : []), [cell, state.runPlan, run_id]);
  const open = useMemo(() => planned.slice(Math.min(done.length, planned.length)), [planned, done]);
  useEffect(() => view?.setTouches(done, open), [view, done, open]);

  return (
    <figure class="scene">
      <canvas ref={canvas} tabIndex={0} role="img" aria-label={say('scene')} onKeyDown={(event) => {
        if (view?.turnByKey(event.key)) event.preventDefault();
      }} />
      {!view && <p class="over">{problem === 'missing' ? say('sceneNone') : say('sceneLoading')}</p>}
      <figcaption>
        <span>{say('touchesShown', {done: done.length, open: open.length})}</span>
        <button type="button" onClick={() => view?.resetCamera()}>{say('sceneReset')}</button>
      </figcaption>
    </figure>
  );
}
