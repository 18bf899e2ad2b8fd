import {useEffect, useState} from 'preact/hooks';

/** The page's theme, for what is drawn in the colours of the page and cannot be told by the style sheet. */
export function useShownTheme(): string {
  const read = (): string => document.documentElement.dataset.theme ?? '';
  const [theme, setTheme] = useState(read);
  useEffect(() => {
    const watch = new MutationObserver(() => setTheme(read()));
    watch.observe(document.documentElement, {attributeFilter: ['data-theme']});
    setTheme(read());
    return () => watch.disconnect();
  }, []);
  return theme;
}
