import {useEffect, useState} from 'preact/hooks';
import {isLoopback} from '../model/session.ts';
import type {QrCode} from '../qr/qr_code.ts';
import {Symbol} from './symbol.tsx';
import {useSay} from './texts.tsx';

/** The way to this page for a tablet: its address, without the token. */
export function TabletOffer() {
  const say = useSay();
  const [isOpen, setOpen] = useState(false);
  const address = location.origin + location.pathname;
  return (
    <div class="tablet">
      <button type="button" aria-expanded={isOpen} onClick={() => setOpen(!isOpen)}>{say('tablet')}</button>
      {isOpen && isLoopback(location.hostname) ? <p><Symbol shape="warning" /> {say('tabletLoopback')}</p> : null}
      {isOpen && !isLoopback(location.hostname) ? <Code address={address} /> : null}
      {isOpen ? <p class="outer"><code>{address}</code></p> : null}
    </div>
  );
}

/** Its code is loaded when it is asked for. */
function Code({address}: {address: string}) {
  const say = useSay();
  const [code, setCode] = useState<QrCode | null>(null);
  const [isMissing, setMissing] = useState(false);
  useEffect(() => {
    void import('../qr/qr_code.ts').then(({qrCode}) => setCode(qrCode(address)), () => setMissing(true));
  }, [address]);
  return (
    <>
      <p>{say('tabletWords')}</p>
      {code ? (
        <svg class="qr" viewBox={`0 0 ${code.size} ${code.size}`} shape-rendering="crispEdges" role="img" aria-label={say('tabletCode')}>
          <path d={code.path} />
        </svg>
      ) : null}
      {isMissing ? <p>{say('tabletNoCode')}</p> : null}
    </>
  );
}
