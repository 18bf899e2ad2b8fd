import {useState} from 'preact/hooks';
import type {Desk} from '../model/desk.ts';
import {Later, Part} from './later.tsx';
import {useSay} from './texts.tsx';

const fleetView = new Part(() => import('./fleet_view.tsx').then((file) => file.FleetView));

/** The plant's cells: code and documents come when a person asks for them. */
export function FleetFrame({desk}: {desk: Desk}) {
  const say = useSay();
  const [isShown, setShown] = useState(false);
  return (
    <section class="fleet">
      <h2>{say('fleet')}</h2>
      {isShown ? <Later part={fleetView} props={{desk}} /> : <button type="button" onClick={() => setShown(true)}>{say('fleetAsk')}</button>}
    </section>
  );
}
