import {useState} from 'preact/hooks';
import type {Desk} from '../model/desk.ts';
import type {FleetView} from './fleet_view.tsx';
import {useSay} from './texts.tsx';

/** The plant's cells: code and documents come when a person asks for them. */
export function FleetFrame({desk}: {desk: Desk}) {
  const say = useSay();
  const [view, setView] = useState<{Shown: typeof FleetView} | null>(null);
  const [isMissing, setMissing] = useState(false);
  const show = (): void => void import('./fleet_view.tsx').then((file) => setView({Shown: file.FleetView}), () => setMissing(true));
  return (
    <section class="fleet">
      <h2>{say('fleet')}</h2>
      {view ? <view.Shown desk={desk} /> : <button type="button" onClick={show}>{say('fleetAsk')}</button>}
      {isMissing ? <p role="status">{say('fleetLost')}</p> : null}
    </section>
  );
}
