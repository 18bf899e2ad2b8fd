import {useEffect, useState} from 'preact/hooks';

/** One value that changes by actions only, and those who are told. */
export class Store<State, Action> {
  private readonly told = new Set<() => void>();

  constructor(private readonly reduce: (state: State, action: Action) => State, private value: State) {}

  get state(): State {
    return this.value;
  }

  dispatch(action: Action): void {
    const next = this.reduce(this.value, action);
    if (next === this.value) return;
    this.value = next;
    for (const tell of this.told) tell();
  }

  subscribe(tell: () => void): () => void {
    this.told.add(tell);
    return () => this.told.delete(tell);
  }
}

/** The state of a store, for a component: drawn anew at each change. */
export function useStore<State, Action>(store: Store<State, Action>): State {
  const [state, setState] = useState(store.state);
  useEffect(() => {
    setState(store.state);
    return store.subscribe(() => setState(store.state));
  }, [store]);
  return state;
}
