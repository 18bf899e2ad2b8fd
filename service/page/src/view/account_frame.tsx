import {useEffect, useState} from 'preact/hooks';
import type {AccountPanel, AccountProps} from './account_panel.tsx';
import {Symbol} from './symbol.tsx';
import {useSay} from './texts.tsx';

/** The panel to sign in: its code is loaded when it is asked for first. Without the daemon it does not come, and nobody could sign in. */
export function AccountFrame(props: AccountProps) {
  const say = useSay();
  const [panel, setPanel] = useState<{Shown: typeof AccountPanel} | null>(null);
  const [isMissing, setMissing] = useState(false);
  useEffect(() => {
    void import('./account_panel.tsx').then((file) => setPanel({Shown: file.AccountPanel}), () => setMissing(true));
  }, []);
  if (panel) return <panel.Shown {...props} />;
  return <p class="card" role="status">{isMissing ? <><Symbol shape="warning" /> {say('signInLost')}</> : say('loading')}</p>;
}
