import type {ComponentChildren} from 'preact';
import {useEffect, useRef, useState} from 'preact/hooks';
import {useSay} from './texts.tsx';

export const kHold_ms = 1500;

interface Props {
  class: string;
  children: ComponentChildren;
  note: string;
  disabled: boolean;
  onHeld: () => void;
}

/**
 * A button that acts when it has been held for kHold_ms, by finger, mouse, Space or Enter: what moves the arm is not
 * started by a brush of the sleeve. Let go or moved off earlier, it does nothing.
 */
export function HoldButton({class: kind, children, note, disabled, onHeld}: Props) {
  const say = useSay();
  const [held, setHeld] = useState(0);  // 0 to 1
  const since = useRef<number | null>(null);
  const frame = useRef(0);

  const release = (): void => {
    cancelAnimationFrame(frame.current);
    since.current = null;
    setHeld(0);
  };
  const step = (): void => {
    if (since.current === null) return;
    const part = (performance.now() - since.current) / kHold_ms;
    if (part >= 1) {
      release();
      onHeld();
      return;
    }
    setHeld(part);
    frame.current = requestAnimationFrame(step);
  };
  const press = (): void => {
    if (disabled || since.current !== null) return;
    since.current = performance.now();
    frame.current = requestAnimationFrame(step);
  };
  useEffect(() => release, []);
  useEffect(() => {
    if (disabled) release();
  }, [disabled]);

  const isHoldKey = (event: KeyboardEvent): boolean => event.key === ' ' || event.key === 'Enter';
  return (
    <button
      type="button"
      class={`run ${kind}`}
      disabled={disabled}
      onPointerDown={(event) => {
        if (event.button === 0) press();
      }}
      onPointerUp={release}
      onPointerLeave={release}
      onPointerCancel={release}
      onBlur={release}
      onContextMenu={(event) => event.preventDefault()}
      onKeyDown={(event) => {
        if (!isHoldKey(event)) return;
        event.preventDefault();
        press();
      }}
      onKeyUp={(event) => {
        if (isHoldKey(event)) release();
      }}
    >
      <span class="held" style={{transform: `scaleX(${held})`}} aria-hidden="true" />
      <span class="label">{children}</span>
      <span class="note">{held > 0 ? say('holdOn') : note}</span>
    </button>
  );
}
