import {useEffect, useMemo, useRef, useState} from 'preact/hooks';
import type {Action, PageState} from '../model/page_state.ts';
import {touchPoints} from '../model/live_figures.ts';
import {furtherPlace, numberingOf, ownNumber, touchesAt, whereByNumber} from '../model/places.ts';
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
      showBlock(view, store.state);
    };
    follow();
    return store.subscribe(follow);
  }, [view, store]);

  const run_id = state.status?.run_id ?? null;
  const done = useMemo(() => (state.touches?.run_id === run_id ? state.touches?.touches ?? [] : []), [state.touches, run_id]);
  const planned = useMemo(() => (state.runPlan?.run_id === run_id ? state.runPlan?.touches ?? [] : []), [state.runPlan, run_id]);
  const open = useMemo(() => planned.slice(Math.min(done.length, planned.length)), [planned, done]);
  // Those of another place would hang in the air: there is no block.
  const at = state.status?.block_place ?? null;
  const numbering = useMemo(() => numberingOf(state.recipes, state.status?.recipe ?? null), [state.recipes, state.status?.recipe]);
  const points = useMemo(
      () => (cell ? [done, open].map((touches) => touchPoints(cell, touchesAt(touches, at, cell, numbering), numbering)) : []),
      [cell, done, open, at, numbering]);
  useEffect(() => view?.setTouches(points[0] ?? [], points[1] ?? []), [view, points]);

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

/** The block where it stands, or is to be brought, and the face that comes next. */
function showBlock(view: SceneView, {cell, status, recipes}: PageState): void {
  if (!cell) return;
  const plane = status?.plane ?? null;
  view.setBlock(furtherPlace(cell, status?.block_place));
  if (plane === null) {
    view.setPlane(null, null);
    return;
  }
  const whereOf = whereByNumber(cell, numberingOf(recipes, status?.recipe ?? null));
  view.setPlane(ownNumber(cell, plane), furtherPlace(cell, whereOf(plane).place));
}
