import type {ComponentType} from 'preact';
import {useEffect, useState} from 'preact/hooks';
import {Symbol} from './symbol.tsx';
import {useSay} from './texts.tsx';

/** Loads a part of the page; what is here already is shown at once. */
export class Part<Props extends object> {
  shown: ComponentType<Props> | null = null;

  constructor(private readonly read: () => Promise<ComponentType<Props>>) {}

  async load(): Promise<void> {
    this.shown ??= await this.read();
  }
}

/** A part of the page whose code is loaded when it is shown first. Without the daemon it does not come. */
export function Later<Props extends object>({part, props}: {part: Part<Props>; props: Props}) {
  const say = useSay();
  const [, setLoaded] = useState(part.shown !== null);
  const [isMissing, setMissing] = useState(false);
  useEffect(() => void part.load().then(() => setLoaded(true), () => setMissing(true)), [part]);
  const {shown: Shown} = part;
  if (Shown) return <Shown {...props} />;
  return <p class="card" role="status">{isMissing ? <><Symbol shape="warning" /> {say('noAnswer')}</> : say('loading')}</p>;
}
