import {useEffect, useState} from 'preact/hooks';
import type {SetupProps, SetupView} from './setup_view.tsx';
import {Symbol} from './symbol.tsx';
import {useSay} from './texts.tsx';

/** The form of a new cell: its code is loaded when it is asked for first. */
export function SetupFrame(props: SetupProps) {
  const say = useSay();
  const [view, setView] = useState<{Shown: typeof SetupView} | null>(null);
  const [isMissing, setMissing] = useState(false);
  useEffect(() => {
    void import('./setup_view.tsx').then((file) => setView({Shown: file.SetupView}), () => setMissing(true));
  }, []);
  if (view) return <view.Shown {...props} />;
  return <p class="card" role="status">{isMissing ? <><Symbol shape="warning" /> {say('noAnswer')}</> : say('loading')}</p>;
}
