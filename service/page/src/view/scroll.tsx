import type {ComponentChildren} from 'preact';

/** A wide table scrolls by itself, by keyboard too. */
export function Scroll({label, children}: {label: string; children: ComponentChildren}) {
  return <div class="scroll" role="region" aria-label={label} tabIndex={0}>{children}</div>;
}
